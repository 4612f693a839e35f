# The nodes. The ROS adapters are the only code that sees ROS headers.
add_library(tissue_ros
  src/ros/convert.cpp
  src/ros/deformer_node.cpp
  src/ros/display_mesh.cpp
  src/ros/markers.cpp
  src/ros/mesher_node.cpp
  src/ros/pose_input.cpp
  src/ros/volume_node.cpp)
target_include_directories(tissue_ros PUBLIC src SYSTEM PUBLIC ${catkin_INCLUDE_DIRS})
target_link_libraries(tissue_ros PUBLIC tissue_refine tissue_simulate ${catkin_LIBRARIES})
add_dependencies(tissue_ros ${${PROJECT_NAME}_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})

foreach(node volume_node mesher_node deformer_node)
  add_executable(${node} src/ros/${node}_main.cpp src/tissue/base/memory_meter.cpp)
  target_link_libraries(${node} tissue_ros)
endforeach()

install(TARGETS
    mesh_volume volume_node mesher_node deformer_node
  RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(TARGETS
    tissue_base tissue_field tissue_itk tissue_lattice tissue_mesh_file tissue_refine tissue_ros
    tissue_simulate
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
install(DIRECTORY include/tissue DESTINATION ${CATKIN_GLOBAL_INCLUDE_DESTINATION})
install(DIRECTORY config data launch rviz DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
