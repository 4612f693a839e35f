# Messages and services. Comes before any target, because catkin sets where targets go.
set(TISSUE_ROS_PACKAGES
  actionlib actionlib_msgs diagnostic_msgs diagnostic_updater geometry_msgs interactive_markers nodelet pluginlib rosbag roscpp sensor_msgs std_msgs tf2
  tf2_geometry_msgs tf2_ros topic_tools visualization_msgs)
find_package(catkin REQUIRED COMPONENTS ${TISSUE_ROS_PACKAGES} message_generation)

catkin_python_setup()
add_message_files(FILES
  EffectCost.msg MeshStatistics.msg Probes.msg Result.msg SimulationStatus.msg StageCost.msg TetMesh.msg
  Volume.msg)
add_service_files(FILES BuildMesh.srv LoadScene.srv MeshFile.srv Pause.srv Reset.srv)
add_action_files(FILES BuildMesh.action)
generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs std_msgs)

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES tissue_base tissue_field tissue_lattice tissue_refine tissue_simulate
  CATKIN_DEPENDS ${TISSUE_ROS_PACKAGES} message_runtime
  DEPENDS EIGEN3)
