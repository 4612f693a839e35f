# The nodes. The ROS adapters are the only code that sees ROS headers.
# PCL's headers are heavy and bring libraries of their own.
find_package(PCL REQUIRED COMPONENTS common io)
add_library(tissue_point_file src/ros/point_file.cpp)
target_include_directories(tissue_point_file PRIVATE src SYSTEM PRIVATE ${PCL_INCLUDE_DIRS})
target_compile_definitions(tissue_point_file PRIVATE ${PCL_DEFINITIONS})
target_link_libraries(tissue_point_file PUBLIC tissue_base PRIVATE ${PCL_LIBRARIES})

# Nodes say for --help what config/parameters.yaml says.
set(parameters ${CMAKE_CURRENT_SOURCE_DIR}/config/parameters.yaml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${parameters})
file(READ ${parameters} TISSUE_PARAMETERS_YAML)
configure_file(src/ros/parameters_text.cpp.in parameters_text.cpp @ONLY)

add_library(tissue_ros
  ${CMAKE_CURRENT_BINARY_DIR}/parameters_text.cpp
  src/ros/bag_run.cpp
  src/ros/colours.cpp
  src/ros/convert.cpp
  src/ros/deformer_node.cpp
  src/ros/device_adapter_node.cpp
  src/ros/device_messages.cpp
  src/ros/display_mesh.cpp
  src/ros/face_corners.cpp
  src/ros/kept_state.cpp
  src/ros/markers.cpp
  src/ros/master_watch.cpp
  src/ros/mesher_node.cpp
  src/ros/mouse_tool_node.cpp
  src/ros/node_main.cpp
  src/ros/scene_worker.cpp
  src/ros/section.cpp
  src/ros/settings.cpp
  src/ros/simulation.cpp
  src/ros/tool_listener.cpp
  src/ros/tool_path_node.cpp
  src/ros/volume_node.cpp)
# Its headers are for the nodes here, and are not installed.
#catkin_lint: ignore_once EXTERNAL_INTERFACE_PATH
target_include_directories(tissue_ros PUBLIC src SYSTEM PUBLIC ${catkin_INCLUDE_DIRS})
target_link_libraries(tissue_ros PUBLIC
  tissue_study tissue_triangle_surface tissue_mesh_file tissue_point_file
  PkgConfig::YAML_CPP ${catkin_LIBRARIES})
add_dependencies(tissue_ros ${${PROJECT_NAME}_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})

# Without ROS it reads no bags.
target_link_libraries(run_scene tissue_ros)
target_include_directories(run_scene PRIVATE src)
target_compile_definitions(run_scene PRIVATE TISSUE_WITH_BAGS)

set(TISSUE_NODES volume_node mesher_node deformer_node tool_path_node mouse_tool_node device_adapter_node)
foreach(node ${TISSUE_NODES})
  add_executable(${node} src/ros/${node}_main.cpp src/tissue/base/memory_meter.cpp)
  target_link_libraries(${node} tissue_ros)
endforeach()

# For one process: loaded by a nodelet manager.
add_library(tissue_nodelets MODULE src/ros/nodelets.cpp)
target_link_libraries(tissue_nodelets tissue_ros)

include(cmake/rviz_display.cmake)

install(TARGETS
    accuracy_study mesh_volume run_scene ${TISSUE_NODES}
  RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(TARGETS
    tissue_base tissue_field tissue_itk tissue_lattice tissue_mesh_file tissue_nodelets tissue_refine tissue_ros
    tissue_point_file tissue_simulate tissue_study tissue_triangle_surface tissue_yaml
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
catkin_install_python(PROGRAMS scripts/plot_bag DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(DIRECTORY include/tissue DESTINATION ${CATKIN_GLOBAL_INCLUDE_DESTINATION})
install(DIRECTORY config data launch rviz DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
