#!/usr/bin/env python3
"""What happens to nodes, masters, files and clients, and that the nodes live through it."""
import os
import signal
import subprocess
import time
import unittest

import rospkg
import rostest

from ros_world import World, figure, log_of, program, resident_kilobytes, tells_why, wait_for

BUILD = dict(iso_value=20.0, initial_tetrahedra=2000, level_sections=2, smooth_levels=2)
HUGE = {**BUILD, "initial_tetrahedra": 3000000}
OK = 0
E_IO, E_NOMEM = 24, 25
BRAIN = os.path.join(rospkg.RosPack().get_path("soft_tissue_sim"), "data", "ch2bet.nii.gz")


class Faults(unittest.TestCase):
    @classmethod
    @tells_why
    def setUpClass(cls):
        cls.world = World()
        cls.launch = cls.world.launch("demo.launch", "rviz:=false", "play:=false", "initial_tetrahedra:=2000")
        cls.uuid = cls.world.hear("/mesh", "TetMesh", "m.uuid", 120)
        wait_for(lambda: cls.mesh_of_deformer() == cls.uuid, 60)

    @classmethod
    def tearDownClass(cls):
        cls.world.end()

    @classmethod
    def mesh_of_deformer(cls):
        return cls.world.hear("/deformer_node/status", "SimulationStatus", "m.mesh_uuid")

    def kill(self, node):
        """At once; the one that took its place, and after how many seconds."""
        old = self.world.process_of(node)
        os.kill(old, signal.SIGKILL)
        begin = time.monotonic()
        wait_for(lambda: self.world.process_of(node) not in (None, old), 20)
        return self.world.process_of(node), time.monotonic() - begin

    def expect_serving(self):
        self.assertEqual(self.world.call("/mesher_node/build_mesh", "BuildMesh", use_mask=True, **BUILD)[0], OK)
        vertices, finite = self.world.hear(
            "/deformed_cloud", "PointCloud2",
            "[m.width, all(map(__import__('math').isfinite, __import__('struct').unpack('<%df' % (m.width * 6), m.data)))]")
        self.assertGreater(vertices, 1000)
        self.assertTrue(finite)

    def test_1_F10_who_comes_late_is_given_the_last_mesh_and_its_markers(self):
        self.assertEqual(self.world.hear("/mesh", "TetMesh", "m.uuid", 1), self.uuid)
        self.assertGreater(self.world.hear("/mesh_markers", "MarkerArray", "len(m.markers)", 1), 1)

    def test_1_X1_nodes_listen_on_this_machine_alone(self):
        for node in ("/volume_node", "/mesher_node", "/deformer_node"):
            self.assertTrue(self.world.address_of(node).startswith("http://127.0.0.1:"), node)

    def test_2_F1_a_deformer_that_was_killed_has_its_mesh_again_from_disk(self):
        mesher = self.world.process_of("/mesher_node")
        os.kill(mesher, signal.SIGSTOP)  # It cannot send its mesh again.
        try:
            _, seconds = self.kill("/deformer_node")
            self.assertLess(seconds, 3.0)
            self.assertEqual(self.mesh_of_deformer(), self.uuid)
        finally:
            os.kill(mesher, signal.SIGCONT)
        self.expect_serving()

    def test_2_F1_a_mesher_that_was_killed_publishes_the_same_mesh(self):
        before = self.world.hear("/mesh", "TetMesh", "m.uuid")
        _, seconds = self.kill("/mesher_node")
        self.assertLess(seconds, 3.0)
        self.assertEqual(self.world.hear("/mesh", "TetMesh", "m.uuid", 5), before)
        self.expect_serving()

    def test_2_scenes_that_were_loaded_survive_too(self):
        name = "/deformer_node/load_scene"
        code, sentence = self.world.call(name, "LoadScene", yaml="name: mine\nmodel: cheese")
        self.assertNotEqual(code, OK)
        self.assertIn("cheese", sentence)
        self.assertNotEqual(self.world.call(name, "LoadScene", path="../scene.yaml")[0], OK)
        self.assertEqual(self.world.call(name, "LoadScene", yaml="name: mine\nmodel: closed_form\neffects: [recovery]")[0],
                         OK)
        scene = lambda: self.world.hear("/deformer_node/status", "SimulationStatus", "[m.scene, m.mesh_uuid]")
        mesh = self.world.hear("/mesh", "TetMesh", "m.uuid")
        self.assertEqual(scene(), ["mine", mesh])
        self.kill("/deformer_node")
        wait_for(lambda: scene() == ["mine", mesh], 10)
        # What stands still says so, and goes on.
        flags = lambda: self.world.hear("/deformer_node/status", "SimulationStatus", "m.flags")
        self.assertEqual(self.world.call("/deformer_node/pause", "Pause", paused=True)[0], OK)
        self.assertIn("PAUSED", flags())
        self.assertEqual(self.world.call("/deformer_node/reset", "Reset")[0], OK)
        self.assertEqual(self.world.call(name, "LoadScene", yaml="name: other\nmodel: closed_form")[0], OK)
        self.assertIn("PAUSED", flags())
        self.assertEqual(self.world.call("/deformer_node/pause", "Pause", paused=False)[0], OK)
        self.assertNotIn("PAUSED", flags())

    def test_3_P5_a_flood_of_poses_takes_no_memory_and_clouds_still_come(self):
        flood = self.world.node("tool_path_node", "_rate:=10000", "_kind:=line", "_from:=[0,-0.02,0.08]",
                                "_to:=[0,-0.02,0.07]")
        deformer = self.world.process_of("/deformer_node")
        wait_for(lambda: "TOOL_LOST" not in self.world.hear("/deformer_node/status", "SimulationStatus", "m.flags"), 20)
        before = resident_kilobytes(deformer)
        for _ in range(5):
            self.world.hear("/deformed_cloud", "PointCloud2", "m.width", 2)
        grown = resident_kilobytes(deformer) - before
        figure("P5", "memory grown [kB]", grown)
        self.assertLess(grown, 5000)
        flood.terminate()
        self.assertEqual(self.world.process_of("/deformer_node"), deformer)

    def test_3_X2_a_thousand_hostile_messages_cost_no_memory_and_no_mesh(self):
        # The launch files limit the nodes' address space.
        nodes = ("/mesher_node", "/deformer_node")
        self.expect_serving()
        mesh = self.mesh_of_deformer()
        before = {node: (self.world.process_of(node), resident_kilobytes(self.world.process_of(node))) for node in nodes}
        self.assertEqual(self.world.attack(1000), 1000)
        self.assertGreater(self.world.hear("/deformer_node/status", "SimulationStatus", "m.rejected_meshes"), 500)
        self.assertEqual(self.mesh_of_deformer(), mesh)
        for node, (process, memory) in before.items():
            self.assertEqual(self.world.process_of(node), process)
            grown = resident_kilobytes(process) - memory
            figure("X2", f"memory grown by 1,000 hostile messages, {node[1:]} [kB]", grown)
            self.assertLess(grown, 20000, node)
        self.expect_serving()

    def test_4_F9_clients_that_die_while_they_wait_leave_a_mesher_that_serves(self):
        mesher = self.world.process_of("/mesher_node")
        request = "{iso_value: 20, initial_tetrahedra: %d, level_sections: 2}" % HUGE["initial_tetrahedra"]
        for client in (f"rosservice call /mesher_node/build_mesh '{request}'",
                       "rostopic pub /mesher_node/build/goal soft_tissue_sim/BuildMeshActionGoal "
                       f"'{{goal: {request}}}'"):
            watcher = self.world.watcher("/mesher_node")
            wait_for(lambda: "watching" in log_of(watcher))
            waiting = self.world.start("bash", "-c", client)
            self.assertEqual(watcher.wait(30), 0)
            os.killpg(waiting.pid, signal.SIGKILL)
            waiting.wait()
            wait_for(lambda: self.world.call("/mesher_node/build_mesh", "BuildMesh", use_mask=True, **BUILD)[0] == OK, 60)
        self.assertEqual(self.world.process_of("/mesher_node"), mesher)

    def test_5_F5_a_mesher_that_is_told_to_end_while_it_builds_ends_well(self):
        for end in (signal.SIGTERM, signal.SIGINT):
            folder = os.path.join(self.world.folder, f"ending{end}")
            os.mkdir(folder)
            watcher = self.world.watcher("/ending")
            mesher = self.world.node("mesher_node", "__name:=ending", f"_folder:={folder}", "_build_on_volume:=true",
                                     f"_initial_tetrahedra:={HUGE['initial_tetrahedra']}", "mesh:=/other_mesh")
            self.assertEqual(watcher.wait(30), 0)
            begin = time.monotonic()
            os.kill(self.world.process_of("/ending"), end)
            self.assertEqual(mesher.wait(10), 0)
            seconds = time.monotonic() - begin
            figure("F5", "ends after [s]", round(seconds, 2))
            self.assertLess(seconds, 2.0)
            self.assertEqual(os.listdir(folder), [])

    def test_5_F5_a_program_that_is_told_to_end_leaves_the_old_file(self):
        out = os.path.join(self.world.folder, "old.vtu")
        with open(out, "w") as file:
            file.write("old")
        program = self.world.node("mesh_volume", BRAIN, "--iso", "20", "--initial", str(HUGE["initial_tetrahedra"]),
                                  "-o", out)
        wait_for(lambda: os.path.exists(f"/proc/{program.pid}") and resident_kilobytes(program.pid) > 100000, 30)
        program.terminate()
        self.assertNotEqual(program.wait(10), 0)
        with open(out) as file:
            self.assertEqual(file.read(), "old")
        self.assertEqual([f for f in os.listdir(self.world.folder) if f.startswith("old")], ["old.vtu"])

    def test_5_F6_a_full_disk_is_an_error_and_the_old_file_stays(self):
        folder = os.path.join(self.world.folder, "full")
        os.mkdir(folder)
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", folder], capture_output=True).returncode:
            self.skipTest("a small disk cannot be mounted here")
        try:
            with open(os.path.join(folder, "mesh.vtu"), "w") as file:
                file.write("old")
            self.world.node("mesher_node", "__name:=full", f"_folder:={folder}", "mesh:=/other_mesh",
                            "_build_on_volume:=true", "_initial_tetrahedra:=20000")
            self.world.hear("/other_mesh", "TetMesh", "m.uuid", 60)
            for _ in range(2):
                self.assertEqual(self.world.call("/full/save_mesh", "MeshFile", path="mesh.vtu")[0], E_IO)
            with open(os.path.join(folder, "mesh.vtu")) as file:
                self.assertEqual(file.read(), "old")
            self.assertEqual(os.listdir(folder), ["mesh.vtu"])
            os.kill(self.world.process_of("/full"), signal.SIGTERM)
        finally:
            subprocess.run(["umount", "-l", folder])

    def test_5_F7_of_two_nodes_of_one_name_the_first_ends_with_a_sentence(self):
        first = self.world.node("deformer_node", "__name:=twin")
        # While the first still registers, the master takes it for the newer one and ends the second.
        self.world.hear("/twin/status", "SimulationStatus", "m.mesh_uuid")
        second = self.world.node("deformer_node", "__name:=twin")
        self.assertEqual(first.wait(10), 1)
        self.assertIn("somebody else has shut it down", log_of(first))
        second.terminate()
        self.assertEqual(second.wait(10), 0)

    def test_5_F7_a_wrong_master_is_named(self):
        lost = self.world.node("deformer_node", env={"ROS_MASTER_URI": "http://127.0.0.1:1"})
        self.assertEqual(lost.wait(30), 1)
        self.assertIn("no master answers at http://127.0.0.1:1", log_of(lost))

    def test_5_X3_a_parameter_that_makes_no_sense_ends_the_node_with_its_name_and_value(self):
        for argument, sentence in (("_cloud_rate:=.nan", "~cloud_rate: .nan is not finite"),
                                   ("_max_force:=-1", "~max_force: -1 is not between"),
                                   ("_tool_timeout:=soon", "~tool_timeout: soon is not a number"),
                                   ("/nowhere.yaml", "settings: '/nowhere.yaml'")):
            node = self.world.node("deformer_node", "__name:=wrong", argument)
            self.assertEqual(node.wait(20), 1, argument)
            self.assertIn(sentence, log_of(node))
            subprocess.run(["rosparam", "delete", "/wrong"], env=self.world.env, capture_output=True)

    def test_5_F8_X2_where_memory_ends_the_request_fails_and_the_node_serves(self):
        limited = self.world.start("bash", "-c", "ulimit -v 1500000; exec " + program("mesher_node") +
                                   " __name:=limited mesh:=/other_mesh _max_tetrahedra:=1000000000")
        wait_for(lambda: "took a volume" in log_of(limited), 30)
        code, sentence = self.world.call("/limited/build_mesh", "BuildMesh",
                                         **{**HUGE, "initial_tetrahedra": 8000000, "level_sections": 3})
        self.assertEqual(code, E_NOMEM, sentence)
        self.assertEqual(self.world.call("/limited/build_mesh", "BuildMesh", **BUILD)[0], OK)
        limited.terminate()
        self.assertEqual(limited.wait(10), 0)

    def test_7_F2_nodes_find_the_next_master_with_their_settings_and_meshes(self):
        nodes = ("/volume_node", "/mesher_node", "/deformer_node")
        old = {node: self.world.process_of(node) for node in nodes}
        scene = "[m.scene, m.mesh_uuid]"
        before = self.world.hear("/deformer_node/status", "SimulationStatus", scene)
        self.world.kill_core()
        self.world.core = self.world.start_core()
        begin = time.monotonic()
        wait_for(lambda: all(self.world.process_of(n) not in (None, old[n]) for n in nodes), 20)
        seconds = time.monotonic() - begin
        figure("F2", "started again after [s]", round(seconds, 2))
        self.assertLess(seconds, 10.0)
        self.assertEqual(self.world.hear("/mesh", "TetMesh", "m.uuid", 10), before[1])
        wait_for(lambda: self.world.hear("/deformer_node/status", "SimulationStatus", scene) == before, 10)
        self.expect_serving()

    def test_8_who_ends_well_leaves_nothing_behind(self):
        kept = os.path.join(self.world.folder, "soft_tissue_sim")
        self.assertNotEqual(os.listdir(kept), [])
        self.launch.send_signal(signal.SIGINT)
        self.launch.wait(20)
        self.assertEqual(os.listdir(kept), [])


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "faults", Faults)
