"""What tests of deformer_node share: a mesh of a ball, tools that send poses, and what comes out."""
import unittest

import rospy
from geometry_msgs.msg import PoseStamped
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2
from soft_tissue_sim import displacements_of
from soft_tissue_sim.msg import Result, SimulationStatus, Volume
from soft_tissue_sim.srv import BuildMesh

from ball_volume import ball, request
from ros_world import tells_why, wait_for


class DeformerCase(unittest.TestCase):
    """Tools send their poses fifty times a second as long as `places` has them."""
    TOOLS = ()

    @classmethod
    @tells_why
    def setUpClass(cls):
        rospy.init_node("deformer_client")
        cls.publishers = {name: rospy.Publisher(name + "/measured_cp", PoseStamped, queue_size=1)
                          for name in cls.TOOLS}
        # Where each tool is [m]; a tool that is not in it is silent.
        cls.places = {}
        # Tools' clocks are so far behind.
        cls.behind = rospy.Duration(0)
        cls.timer = rospy.Timer(rospy.Duration(0.02), cls.send_poses)
        cls.volume = rospy.Publisher("volume", Volume, queue_size=1, latch=True)
        cls.volume.publish(ball())
        build = rospy.ServiceProxy("mesher_node/build_mesh", BuildMesh)
        build.wait_for_service(30)
        while True:
            result = build(request()).result
            if result.code != Result.E_NO_VOLUME:
                break
            rospy.rostime.wallsleep(0.05)
        assert result.code == Result.OK, result.message

    @classmethod
    def send_poses(cls, _):
        try:
            for name, place in list(cls.places.items()):
                cls.send(name, place)
        except rospy.ROSException:
            pass  # The test is over.

    @classmethod
    def send(cls, name, place):
        pose = PoseStamped()
        pose.header.frame_id = "patient"
        pose.header.stamp = rospy.Time.now() - cls.behind
        pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = place
        pose.pose.orientation.w = 1.0
        cls.publishers[name].publish(pose)

    def cloud(self):
        message = rospy.wait_for_message("deformed_cloud", PointCloud2, timeout=30)
        return list(point_cloud2.read_points(message, ["x", "y", "z", "displacement"]))

    def status(self):
        return rospy.wait_for_message("deformer_node/status", SimulationStatus, timeout=30)

    def largest(self):
        """Displacement [m]."""
        return displacements_of(rospy.wait_for_message("deformed_cloud", PointCloud2, timeout=30)).max()

    def reach(self, condition):
        wait_for(condition, 60)
