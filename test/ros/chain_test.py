#!/usr/bin/env python3
"""From the shipped volume to an organ that moves, through the nodes."""
import subprocess
import unittest

import rospkg
import rospy
import rostest
from ros_world import tells_why
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2
from soft_tissue_sim import displacements_of
from soft_tissue_sim.msg import SimulationStatus, TetMesh, Volume
from visualization_msgs.msg import MarkerArray

SHARE = rospkg.RosPack().get_path("soft_tissue_sim")


class Chain(unittest.TestCase):
    @classmethod
    @tells_why
    def setUpClass(cls):
        rospy.init_node("chain_test")
        cls.mesh = rospy.wait_for_message("mesh", TetMesh, timeout=120)

    def test_1_volume_and_mask_are_latched(self):
        volume = rospy.wait_for_message("volume", Volume, timeout=30)
        mask = rospy.wait_for_message("mask", Volume, timeout=30)
        self.assertEqual((volume.width, volume.height, volume.depth), (181, 217, 181))
        self.assertEqual(volume.header.frame_id, "patient")
        self.assertAlmostEqual(volume.spacing.x, 1e-3)
        self.assertEqual(max(volume.data), 255)  # the tumour
        self.assertEqual(mask.width * mask.height * mask.depth, len(mask.data))

    def test_2_arrays_of_the_mesh_agree(self):
        mesh = self.mesh
        self.assertEqual(len(mesh.levels), len(mesh.tetrahedra) // 4)
        self.assertEqual(len(mesh.densities), len(mesh.vertices) // 3)
        self.assertEqual(len(mesh.parents) // 2, len(mesh.densities) - mesh.lattice_vertices)
        self.assertEqual(mesh.statistics.tetrahedra, len(mesh.levels))
        self.assertEqual(sorted(set(mesh.levels)), [0, 1, 2])
        self.assertNotEqual(mesh.uuid, "")

    def test_3_markers_have_a_namespace_per_level_in_the_papers_colours(self):
        markers = rospy.wait_for_message("mesh_markers", MarkerArray, timeout=30).markers
        by_name = {m.ns: m for m in markers}
        for name, strongest in (("level_0", "r"), ("level_1", "g"), ("level_2", "b")):
            colour = by_name[name].color
            self.assertEqual(max("rgb", key=lambda c: getattr(colour, c)), strongest)
        triangles = sum(len(m.points) // 3 for n, m in by_name.items() if n.startswith("level_"))
        self.assertGreater(triangles, 1000)
        self.assertLessEqual(triangles, 20000)
        density = rospy.wait_for_message("mesh_density_markers", MarkerArray, timeout=30).markers[-1]
        self.assertEqual(len(density.colors), len(density.points))

    def test_4_the_bag_moves_the_organ_and_lets_it_go_again(self):
        clouds = []
        rospy.Subscriber("deformed_cloud", PointCloud2, clouds.append, queue_size=10)
        play = subprocess.Popen(["rosbag", "play", "--quiet", "--rate", "2", "--wait-for-subscribers",
                                 SHARE + "/data/press.bag"], stdout=subprocess.DEVNULL)
        self.assertEqual(play.wait(timeout=60), 0)
        deepest = max(displacements_of(cloud).max() for cloud in clouds[::5])
        self.assertGreater(deepest, 0.010)
        self.assertLess(deepest, 0.030)
        self.assertEqual([f.name for f in clouds[0].fields],
                         ["x", "y", "z", "density", "level", "displacement"])
        self.assertEqual(clouds[0].width, len(self.mesh.densities))
        self.assertGreater(clouds[-1].header.stamp.to_sec(), 12.0)  # the stamp of the pose used
        # The tool falls silent: the tissue goes back to rest, to the last bit.
        for _ in range(200):
            cloud = rospy.wait_for_message("deformed_cloud", PointCloud2, timeout=10)
            if displacements_of(cloud).max() == 0.0:
                break
        places = [c for p in point_cloud2.read_points(cloud, ["x", "y", "z"]) for c in p]
        self.assertEqual(places, list(self.mesh.vertices))
        status = rospy.wait_for_message("deformer_node/status", SimulationStatus, timeout=10)
        self.assertEqual(status.mesh_uuid, self.mesh.uuid)
        self.assertEqual(status.inverted, 0)
        self.assertEqual([e.name for e in status.effects], ["density_response", "recovery", "fold_guard"])

    def test_5_build_mesh_answers_through_rosservice(self):
        def call(request):
            return subprocess.run(["rosservice", "call", "/mesher_node/build_mesh", request],
                                  capture_output=True, text=True, timeout=120).stdout
        good = call("{iso_value: 20, spacing: 0.02, level_sections: 2}")
        self.assertIn("code: 0", good)
        self.assertIn("tetrahedra:", good)
        bad = call("{iso_value: 20, spacing: 0.02, level_sections: 0}")
        self.assertIn("level_sections: 0 is not within 1 to 255", bad)
        bad = call("{iso_value: 5000, spacing: 0.02, level_sections: 2}")
        self.assertIn("iso_value: 5000 leaves nothing inside", bad)


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "chain", Chain)
