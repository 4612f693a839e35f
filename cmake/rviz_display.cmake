# The display for rviz, where rviz can be extended: librviz-dev and Qt 5.
find_package(rviz QUIET)
find_package(Qt5 QUIET COMPONENTS Widgets)
pkg_check_modules(OGRE_OVERLAY QUIET OGRE-Overlay)
if(NOT rviz_FOUND OR NOT Qt5_FOUND)
  message(STATUS "No display for rviz: librviz-dev or Qt 5 is missing")
  return()
endif()

qt5_wrap_cpp(TISSUE_MOC src/ros/rviz/tet_mesh_display.h)
add_library(tissue_rviz MODULE
  src/ros/rviz/face_renderable.cpp
  src/ros/rviz/legend.cpp
  src/ros/rviz/tet_mesh_display.cpp
  ${TISSUE_MOC})
target_include_directories(tissue_rviz SYSTEM PRIVATE ${rviz_INCLUDE_DIRS} ${OGRE_OVERLAY_INCLUDE_DIRS})
target_link_libraries(tissue_rviz tissue_ros ${rviz_LIBRARIES} Qt5::Widgets)
install(TARGETS tissue_rviz
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
