#!/usr/bin/env python3
"""A bag gives the same clouds, bit for bit: by the node at any rate, and by run_scene with any number of
threads."""
import hashlib
import os
import subprocess
import tempfile

import rosbag
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, TransformStamped
from sensor_msgs.msg import JointState, PointCloud2
from soft_tissue_sim.msg import Result
from soft_tissue_sim.srv import MeshFile

from ball_volume import CENTRE, RADIUS
from deformer_client import DeformerCase

CENTRE_M, RADIUS_M = CENTRE * 1e-3, RADIUS * 1e-3
HERE = os.path.dirname(os.path.abspath(__file__))


def stamp(i, milliseconds):
    return rospy.Time(1000, 0) + rospy.Duration.from_sec(0.02 * i + 0.001 * milliseconds)


def write_bag(path):
    """A finger presses and goes back; forceps close on the side, pull, and are silent for a while."""
    with rosbag.Bag(path, "w") as bag:
        for i in range(60):
            pose = PoseStamped()
            pose.header.frame_id = "patient"
            pose.header.stamp = stamp(i, 0)
            pose.pose.position.x = pose.pose.position.y = CENTRE_M
            pose.pose.position.z = CENTRE_M + RADIUS_M + 0.005 - 0.0002 * min(i, 60 - i)
            pose.pose.orientation.w = 1.0
            bag.write("/finger/measured_cp", pose, pose.header.stamp)
            if 20 <= i < 35:
                continue
            arm = TransformStamped()
            arm.header.frame_id = "/patient"
            arm.header.stamp = stamp(i, 0 if i % 2 else 7)
            arm.transform.translation.x = CENTRE_M + RADIUS_M + 0.0001 * i
            arm.transform.translation.y = arm.transform.translation.z = CENTRE_M
            arm.transform.rotation.w = 1.0
            bag.write("/forceps/measured_cp", arm, arm.header.stamp)
            jaw = JointState(position=[0.05 if 5 <= i < 50 else 0.5])
            jaw.header.stamp = stamp(i, 3)
            bag.write("/forceps/jaw/measured_js", jaw, jaw.header.stamp)


def digest(cloud):
    return cloud.header.stamp.to_nsec(), hashlib.sha256(bytes(cloud.data)).hexdigest()


class Replay(DeformerCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.bag = os.path.join(self.folder, "tools.bag")
        write_bag(self.bag)
        save = rospy.ServiceProxy("mesher_node/save_mesh", MeshFile)
        result = save(path="replay.vtu").result
        self.assertEqual(result.code, Result.OK, result.message)
        self.mesh = os.path.join(rospy.get_param("mesher_node/folder"), "replay.vtu")

    def by_program(self, threads):
        clouds = os.path.join(self.folder, "clouds.bag")
        subprocess.run(["rosrun", "soft_tissue_sim", "run_scene", os.path.join(HERE, "replay_scene.yaml"), "--mesh",
                        self.mesh, "--bag", self.bag, "--cloud-bag", clouds, "--threads", str(threads), "-o",
                        os.path.join(self.folder, "end.vtu")], check=True)
        with rosbag.Bag(clouds) as bag:
            return [digest(cloud) for _, cloud, _ in bag.read_messages()]

    def by_node(self, rate, last):
        """The clouds until the one of that stamp."""
        clouds = []
        subscriber = rospy.Subscriber("deformed_cloud", PointCloud2, lambda cloud: clouds.append(digest(cloud)),
                                      queue_size=1000)
        while subscriber.get_num_connections() == 0:
            rospy.rostime.wallsleep(0.02)
        subprocess.run(["rosbag", "play", "--quiet", "--wait-for-subscribers", "--rate", str(rate), self.bag],
                       check=True, stdout=subprocess.DEVNULL)
        for _ in range(200):
            if clouds and clouds[-1][0] == last:
                break
            rospy.rostime.wallsleep(0.05)
        subscriber.unregister()
        return clouds

    def test_the_same_clouds_however_they_are_made(self):
        wanted = self.by_program(1)
        self.assertGreater(len(wanted), 25)
        self.assertGreater(len(set(bits for _, bits in wanted)), 20)
        self.assertEqual(self.by_program(2), wanted)
        for rate in (1, 5, 5):
            self.assertEqual(self.by_node(rate, wanted[-1][0]), wanted, f"at rate {rate}")


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "replay", Replay)
