#!/usr/bin/env python3
"""Every node survives bad volumes, requests and poses, keeps what it had, and serves on."""
import math
import os
import struct
import threading
import time
import unittest
import xmlrpc.client

import actionlib
import rosgraph
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, TransformStamped
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2
from soft_tissue_sim import displacements_of
from soft_tissue_sim.msg import (BuildMeshAction, BuildMeshActionFeedback, BuildMeshGoal, Result,
                                 SimulationStatus, TetMesh, Volume)
from soft_tissue_sim.srv import BuildMesh, MeshFile
from tf2_msgs.msg import TFMessage

from ball_volume import CENTRE, RADIUS, SIZE, ball, request
from ros_world import tells_why, wait_for


def with_fields(**fields):
    volume = ball()
    for name, value in fields.items():
        target = volume
        *path, last = name.split("__")
        for part in path:
            target = getattr(target, part)
        setattr(target, last, value)
    return volume


class BadInput(unittest.TestCase):
    @classmethod
    @tells_why
    def setUpClass(cls):
        rospy.init_node("bad_input_test")
        cls.volume = rospy.Publisher("volume", Volume, queue_size=1)
        cls.pose = rospy.Publisher("tool/measured_cp", PoseStamped, queue_size=1)
        cls.tf = rospy.Publisher("tf_static", TFMessage, queue_size=1, latch=True)
        cls.mesh = rospy.Publisher("mesh", TetMesh, queue_size=1)
        cls.rejected = {}
        rospy.Subscriber("/diagnostics", DiagnosticArray, cls.take_diagnostics)
        cls.statuses = []
        rospy.Subscriber("deformer_node/status", SimulationStatus, cls.statuses.append)
        cls.build = rospy.ServiceProxy("mesher_node/build_mesh", BuildMesh)
        cls.build.wait_for_service(30)
        cls.pids = cls.node_pids()
        while cls.volume.get_num_connections() < 1 or cls.pose.get_num_connections() < 1:
            rospy.rostime.wallsleep(0.05)

    @classmethod
    def node_pids(cls):
        master = rosgraph.Master("/bad_input_test")
        return {name: xmlrpc.client.ServerProxy(master.lookupNode(name)).getPid("/bad_input_test")[2]
                for name in ("/mesher_node", "/deformer_node")}

    @classmethod
    def take_diagnostics(cls, message):
        for status in message.status:
            for value in status.values:
                if "rejected" in value.key:
                    cls.rejected[status.name + value.key] = int(value.value)

    def count(self, part):
        return sum(n for key, n in self.rejected.items() if part in key)

    def settled_count(self, part):
        """The count once two diagnostics in a row agree on it."""
        last = None
        while last != self.count(part):
            last = self.count(part)
            rospy.wait_for_message("/diagnostics", DiagnosticArray, timeout=10)
            rospy.wait_for_message("/diagnostics", DiagnosticArray, timeout=10)
            rospy.wait_for_message("/diagnostics", DiagnosticArray, timeout=10)
        return last

    def good_mesh(self):
        response = self.build(request())
        self.assertEqual(response.result.code, Result.OK, response.result.message)
        return rospy.wait_for_message("mesh", TetMesh, timeout=10)

    def test_1_P11_poses_before_the_first_mesh_are_ignored(self):
        for i in range(20):
            self.send_pose(i + 1.0)
        self.assertEqual(self.build(request()).result.code, Result.E_NO_VOLUME)

    def test_2_V1_to_V17_volumes_are_refused_and_the_last_good_one_stays(self):
        self.volume.publish(ball())
        wait_for(lambda: self.build(request()).result.code == Result.OK)
        good = self.good_mesh()
        good_data = ball().data
        floats = struct.pack("<%df" % SIZE**3, *([1.0] * (SIZE**3 - 1)), math.nan)
        bad = [
            ("V1", with_fields(data=good_data[:-1])),
            ("V1", with_fields(data=good_data + b"x")),
            ("V2", with_fields(width=0)),
            ("V2", with_fields(width=65536, height=65536, depth=65536)),
            ("V2", with_fields(width=0xffffffff, height=0xffffffff, depth=0xffffffff)),
            ("V3", with_fields(spacing__x=0.0)),
            ("V3", with_fields(spacing__y=math.nan)),
            ("V3", with_fields(spacing__z=1e3)),
            ("V5", with_fields(encoding="rgb8")),
            ("V5", with_fields(encoding="16UC1")),
            ("V6", with_fields(encoding="32FC1", data=floats)),
            ("V11", with_fields(origin__orientation__w=0.0)),
            ("V14", with_fields(header__frame_id="")),
        ]
        for name, volume in bad:
            before = self.settled_count("volumes rejected")
            self.volume.publish(volume)
            wait_for(lambda: self.count("volumes rejected") == before + 1)
        self.assertEqual(self.good_mesh().uuid, good.uuid)
        # What is only odd is meshed: big-endian data, and Hounsfield units far below zero.
        swapped = b"".join(struct.pack(">h", v) for v in good_data)
        self.volume.publish(with_fields(encoding="16SC1", is_bigendian=1, data=swapped))
        wait_for(lambda: self.good_mesh().header.stamp > good.header.stamp)
        self.assertEqual(self.good_mesh().uuid, good.uuid)
        hounsfield = b"".join(struct.pack("<h", 10 * v - 1024) for v in good_data)
        self.volume.publish(with_fields(encoding="16SC1", quantity="hounsfield", data=hounsfield))
        wait_for(lambda: self.build(request(iso_value=-24.0)).result.code == Result.OK)
        self.volume.publish(ball())
        wait_for(lambda: self.good_mesh().uuid == good.uuid)

    def test_3_V7_V8_V9_volumes_without_a_surface_or_with_too_little_of_one(self):
        def built_from(volume, expected):
            # The volume takes its time to arrive: until then the one before it answers.
            self.volume.publish(volume)
            wait_for(lambda: expected(self.build(request())))
            return self.build(request())
        air = built_from(with_fields(data=bytes([3]) * SIZE**3),
                         lambda r: r.result.code == Result.E_EMPTY_SURFACE)
        self.assertIn("from 3 to 3", air.result.message)
        built_from(with_fields(data=bytes([200]) * SIZE**3),
                   lambda r: r.result.code == Result.OK and r.statistics.border_touched)
        voxel = with_fields(width=1, height=1, depth=1, data=bytes([200]))
        small = built_from(voxel, lambda r: r.result.code == Result.E_TOO_SMALL)
        self.assertIn("would do", small.result.message)
        self.assertEqual(self.build(request(spacing=0.0004)).result.code, Result.OK)
        self.volume.publish(ball())
        wait_for(lambda: self.build(request()).result.code == Result.OK)

    def test_4_M1_to_M7_requests_are_refused_with_field_and_value(self):
        good = self.good_mesh()
        bad = [
            (Result.E_N, "level_sections: 0", dict(level_sections=0)),
            (Result.E_TOO_MANY_TETS, "level_sections: 20", dict(level_sections=20)),
            (Result.E_N, "level_sections: 256", dict(level_sections=256)),
            (Result.E_NTINIT, "initial_tetrahedra: 0", dict(spacing=0.0)),
            (Result.E_NTINIT, "initial_tetrahedra: 1", dict(spacing=0.0, initial_tetrahedra=1)),
            (Result.E_TOO_MANY_TETS, "initial_tetrahedra: 1000000000",
             dict(spacing=0.0, initial_tetrahedra=10**9)),
            (Result.E_TOO_MANY_TETS, "initial_tetrahedra: 4294967295",
             dict(spacing=0.0, initial_tetrahedra=0xffffffff)),
            (Result.E_PARAM, "iso_value: nan", dict(iso_value=math.nan)),
            (Result.E_PARAM, "iso_value: inf", dict(iso_value=math.inf)),
            (Result.E_PARAM, "spacing: -1", dict(spacing=-1.0)),
            (Result.E_PARAM, "spacing: nan", dict(spacing=math.nan)),
            (Result.E_PARAM, "window: nan", dict(window_low=math.nan)),
            (Result.E_PARAM, "d_max: -5", dict(d_max=-5.0)),
            (Result.E_PARAM, "method: 'magic'", dict(method="magic")),
            (Result.E_NO_VOLUME, "use_mask", dict(use_mask=True)),
        ]
        for code, sentence, fields in bad:
            result = self.build(request(**fields)).result
            self.assertEqual(result.code, code, result.message)
            self.assertIn(sentence, result.message)
        self.assertEqual(self.good_mesh().uuid, good.uuid)  # M10 too
        # M5, M6: fewer values than sections are no error.
        self.volume.publish(with_fields(data=bytes(200 if v > 100 else 0 for v in ball().data)))
        wait_for(lambda: self.build(request(level_sections=9)).result.code == Result.OK)
        self.volume.publish(ball())
        wait_for(lambda: self.good_mesh().uuid == good.uuid)

    def test_5_M8_a_second_request_is_answered_busy_while_the_first_runs(self):
        # Whichever of the two comes second must be told so; one that slips in before the slow one
        # does no harm.
        answers = []
        def slow():
            answers.append(self.build(request(spacing=0.0007, level_sections=1)).result)
        for _ in range(10):
            thread = threading.Thread(target=slow)
            thread.start()
            while thread.is_alive():
                answers.append(rospy.ServiceProxy("mesher_node/build_mesh", BuildMesh)(request()).result)
            thread.join()
            if any(a.code == Result.E_BUSY for a in answers):
                break
        self.assertLessEqual({a.code for a in answers}, {Result.OK, Result.E_BUSY})
        busy = next(a for a in answers if a.code == Result.E_BUSY)
        self.assertEqual(busy.message, "build_mesh: a build is running")
        self.good_mesh()

    def test_5b_M8_M9_the_action_reports_its_progress_is_busy_for_others_and_can_be_cancelled(self):
        good = self.good_mesh()
        client = actionlib.SimpleActionClient("mesher_node/build", BuildMeshAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(10)))
        # The client passes on no feedback that overtakes the news that the goal is active, nor any that
        # the result overtakes: they come by separate connections.
        stages = []
        feedback = rospy.Subscriber(
            "mesher_node/build/feedback", BuildMeshActionFeedback,
            lambda m: stages.append((m.feedback.stage, m.feedback.fraction, m.feedback.tetrahedra)))
        wait_for(lambda: feedback.get_num_connections() > 0)
        goal = BuildMeshGoal(iso_value=100.0, spacing=0.006, level_sections=2)
        client.send_goal(goal)
        self.assertTrue(client.wait_for_result(rospy.Duration(60)))
        self.assertEqual(client.get_state(), GoalStatus.SUCCEEDED)
        self.assertEqual(client.get_result().result.code, Result.OK)
        self.assertEqual(client.get_result().statistics.tetrahedra, len(good.tetrahedra) // 4)
        wait_for(lambda: stages and stages[-1][1] == 1.0)
        feedback.unregister()
        self.assertEqual({s[0] for s in stages},
                         {"lattice", "levels", "refinement", "projection", "densities"})
        self.assertEqual([s[1] for s in stages], sorted(s[1] for s in stages))
        self.assertEqual(stages[-1][2], len(good.tetrahedra) // 4)
        # A slow one, which a second goal finds running, and which is then cancelled; another try where
        # it was faster than both.
        slow = BuildMeshGoal(iso_value=100.0, spacing=0.0003, level_sections=1, project_boundary=True)
        other = actionlib.SimpleActionClient("mesher_node/build", BuildMeshAction)
        self.assertTrue(other.wait_for_server(rospy.Duration(10)))
        for _ in range(5):
            started = []
            client.send_goal(slow, feedback_cb=lambda f: started.append(f.stage))
            wait_for(lambda: started)
            other.send_goal_and_wait(goal, rospy.Duration(60))
            client.cancel_goal()
            cancelled_at = time.monotonic()
            self.assertTrue(client.wait_for_result(rospy.Duration(60)))
            took = time.monotonic() - cancelled_at
            if client.get_state() == GoalStatus.PREEMPTED:
                break
        self.assertEqual(other.get_result().result.code, Result.E_BUSY)
        self.assertEqual(client.get_state(), GoalStatus.PREEMPTED)
        self.assertEqual(client.get_result().result.code, Result.E_CANCELLED)
        self.assertLess(took, 2.0)
        self.assertEqual(self.good_mesh().uuid, good.uuid)

    def test_5c_M11_M12_meshes_are_saved_and_loaded_below_the_folder_and_nowhere_else(self):
        good = self.good_mesh()
        save = rospy.ServiceProxy("mesher_node/save_mesh", MeshFile)
        load = rospy.ServiceProxy("mesher_node/load_mesh", MeshFile)
        folder = rospy.get_param("mesher_node/folder")
        answer = save("ball.vtu")
        self.assertEqual((answer.result.code, answer.uuid), (Result.OK, good.uuid), answer.result.message)
        self.assertEqual(save("ball.pcd").result.code, Result.OK)
        with open(os.path.join(folder, "ball.pcd"), "rb") as file:
            head = file.read(400)
        self.assertIn(b"POINTS %d\n" % len(good.densities), head)
        for path in ("../ball.vtu", "/tmp/ball.vtu", "", "x" * 5000, "nowhere/ball.vtu", "a\0b"):
            for service in (save, load):
                self.assertEqual(service(path).result.code, Result.E_PATH, path[:30])
        # Another mesh, then back again.
        self.assertEqual(self.build(request(spacing=0.008)).result.code, Result.OK)
        self.assertNotEqual(rospy.wait_for_message("mesh", TetMesh, timeout=10).uuid, good.uuid)
        answer = load("ball.vtu")
        self.assertEqual((answer.result.code, answer.uuid), (Result.OK, good.uuid), answer.result.message)
        wait_for(lambda: rospy.wait_for_message("mesh", TetMesh, timeout=10).uuid == good.uuid)
        path = os.path.join(folder, "ball.vtu")
        with open(path, "rb") as file:
            content = bytearray(file.read())
        content[len(content) // 2] ^= 4
        with open(os.path.join(folder, "broken.vtu"), "wb") as file:
            file.write(content)
        self.assertEqual(load("broken.vtu").result.code, Result.E_FILE)
        self.assertEqual(rospy.wait_for_message("mesh", TetMesh, timeout=10).uuid, good.uuid)

    def test_5d_meshes_are_sized_by_the_strain_of_a_scene_below_the_folder(self):
        good = self.good_mesh()
        folder = rospy.get_param("mesher_node/folder")
        with open(os.path.join(folder, "push.yaml"), "w") as file:
            file.write("model: linear\nanchors: [{plane: {axis: z, below: 30%, stiffness: 1e6}}]\n"
                       "tools: [{name: finger, shape: {pad: {radius: 0.006}}, mode: grasp}]\n")
        with open(os.path.join(folder, "push.csv"), "w") as file:
            for i, z in enumerate((0.0275, 0.0265)):
                file.write("%d,0.0155,0.0155,%g,0,0,0,1\n" % (i, z))
        strain = dict(method="strain", spacing=0.0, target_tetrahedra=3000, level_sections=3)
        for code, sentence, fields in (
                (Result.E_PARAM, "scene_file: is empty", {}),
                (Result.E_PATH, "push.yaml", dict(scene_file="../push.yaml")),
                (Result.E_PARAM, "no tool 'hand'", dict(scene_file="push.yaml", path_files=["hand=push.csv"])),
                (Result.E_SCENE, "strains nothing", dict(scene_file="push.yaml"))):
            result = self.build(request(**strain, **fields)).result
            self.assertEqual(result.code, code, result.message)
            self.assertIn(sentence, result.message)
        answer = self.build(request(**strain, scene_file="push.yaml", path_files=["finger=push.csv"]))
        self.assertEqual(answer.result.code, Result.OK, answer.result.message)
        self.assertAlmostEqual(answer.statistics.tetrahedra, 3000, delta=60)
        self.assertEqual(self.good_mesh().uuid, good.uuid)

    def send_pose(self, stamp, place=(CENTRE, CENTRE, 100.0), frame="patient", w=1.0):
        pose = PoseStamped()
        pose.header.stamp = rospy.Time.from_sec(stamp)
        pose.header.frame_id = frame
        pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = (1e-3 * c for c in place)
        pose.pose.orientation.w = w
        self.pose.publish(pose)

    def displacement(self):
        cloud = rospy.wait_for_message("deformed_cloud", PointCloud2, timeout=10)
        values = [c for p in point_cloud2.read_points(cloud) for c in p]
        self.assertTrue(all(math.isfinite(v) for v in values))
        return displacements_of(cloud).max()

    def dropped(self):
        return self.statuses[-1].dropped_poses if self.statuses else 0

    def test_6_P1_P2_P6_P8_poses_that_make_no_sense_are_dropped_and_counted(self):
        self.good_mesh()
        top = (CENTRE, CENTRE, CENTRE + RADIUS + 1.0)
        time = 1000.0
        wait_for(lambda: len(self.statuses) > 0)
        for bad in (dict(place=(math.nan, 0, 0)), dict(place=(0, math.inf, 0)), dict(w=0.0), dict(w=1.2),
                    dict(w=math.nan), dict(stamp=0.0), dict(frame="nowhere"), dict(frame="")):
            before = self.dropped()
            fields = {"stamp": time, **bad}
            wait_for(lambda: self.send_pose(**fields) or self.dropped() > before)
        # P8: touching without moving leaves every vertex at rest.
        for i in range(10):
            self.send_pose(time + 0.01 * i, top)
            rospy.rostime.wallsleep(0.01)
        wait_for(lambda: self.send_pose(time + 0.2, top) or self.statuses[-1].moved_vertices > 0)
        self.assertEqual(self.displacement(), 0.0)
        # P2: a quaternion that is nearly one is used.
        pressed = (CENTRE, CENTRE, CENTRE + RADIUS - 1.0)
        def press():
            self.send_pose(time + 1.0, top, w=0.95)
            rospy.rostime.wallsleep(0.02)
            self.send_pose(time + 1.1, pressed, w=0.95)
            return self.displacement() > 0.0015
        wait_for(press)
        # P6: a frame that becomes known is used from then on, a driver's leading slash and all.
        transform = TransformStamped()
        transform.header.frame_id = "patient"
        transform.child_frame_id = "tracker"
        transform.transform.translation.z = 0.05
        transform.transform.rotation.w = 1.0
        self.tf.publish(TFMessage([transform]))
        def press_in_tracker():
            self.send_pose(time + 2.0, (top[0], top[1], top[2] - 50.0), frame="/tracker")
            rospy.rostime.wallsleep(0.02)
            self.send_pose(time + 2.1, (top[0], top[1], top[2] - 53.0), frame="/tracker")
            return abs(self.displacement() - 0.003) < 1e-4
        wait_for(lambda: self.displacement() == 0.0)
        wait_for(press_in_tracker)

    def test_7_a_bad_mesh_leaves_the_last_one(self):
        good = self.good_mesh()
        wait_for(lambda: self.statuses[-1].mesh_uuid == good.uuid)
        wait_for(lambda: self.mesh.get_num_connections() > 0)
        for spoil in (lambda m: m.levels[:-1], lambda m: None):
            bad = rospy.wait_for_message("mesh", TetMesh, timeout=10)
            shorter = spoil(bad)
            if shorter is not None:
                bad.levels = shorter
            else:
                bad.tetrahedra = (len(bad.densities),) + bad.tetrahedra[1:]
            bad.uuid = "bad"
            before = self.statuses[-1].rejected_meshes
            self.mesh.publish(bad)
            wait_for(lambda: self.statuses[-1].rejected_meshes > before)
        self.assertEqual(self.statuses[-1].mesh_uuid, good.uuid)

    def test_8_both_nodes_are_the_ones_that_were_started(self):
        self.assertEqual(self.node_pids(), self.pids)


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "bad_input", BadInput)
