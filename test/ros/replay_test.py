#!/usr/bin/env python3
"""A bag gives the same clouds, bit for bit: by node and nodelet at any rate, and by run_scene with any number of
threads. `rostest soft_tissue_sim replay.test rates:="1 5 1 5 1 5 1 5 1 5"` plays it ten times."""
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
from ros_world import program, wait_for

CENTRE_M, RADIUS_M = CENTRE * 1e-3, RADIUS * 1e-3
# Namespaces: a node, and a nodelet.
NODES = ("", "nodelet/")
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
        subprocess.run([program("run_scene"), os.path.join(HERE, "replay_scene.yaml"), "--mesh",
                        self.mesh, "--bag", self.bag, "--cloud-bag", clouds, "--threads", str(threads), "-o",
                        os.path.join(self.folder, "end.vtu")], check=True)
        with rosbag.Bag(clouds) as bag:
            return [digest(cloud) for _, cloud, _ in bag.read_messages()]

    def by_nodes(self, rate, last):
        """The clouds of each node, until the one of that stamp."""
        clouds = {name: [] for name in NODES}
        subscribers = [rospy.Subscriber(f"{name}deformed_cloud", PointCloud2,
                                        lambda cloud, name: clouds[name].append(digest(cloud)), name, queue_size=1000)
                       for name in NODES]
        while min(s.get_num_connections() for s in subscribers) == 0:
            rospy.rostime.wallsleep(0.02)
        # Both listen before the first pose comes: a moment for the second to connect, too.
        subprocess.run(["rosbag", "play", "--quiet", "--wait-for-subscribers", "--delay", "0.5", "--rate", str(rate),
                        self.bag], check=True, stdout=subprocess.DEVNULL)
        wait_for(lambda: all(c and c[-1][0] == last for c in clouds.values()), 120)
        for subscriber in subscribers:
            subscriber.unregister()
        return clouds

    def wait_for_listeners(self):
        """Tools are listened to from when there is a mesh."""
        while True:
            _, heard, _ = rospy.get_master().getSystemState()[2]
            if len(dict(heard).get("/finger/measured_cp", [])) == len(NODES):
                return
            rospy.rostime.wallsleep(0.05)

    def test_the_same_clouds_however_they_are_made(self):
        wanted = self.by_program(1)
        self.assertGreater(len(wanted), 25)
        self.assertGreater(len(set(bits for _, bits in wanted)), 20)
        self.assertEqual(self.by_program(2), wanted)
        self.wait_for_listeners()
        for rate in rospy.get_param("~rates").split():
            for name, clouds in self.by_nodes(rate, wanted[-1][0]).items():
                self.assertEqual(clouds, wanted, f"{name}deformer_node at rate {rate}")


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "replay", Replay)
