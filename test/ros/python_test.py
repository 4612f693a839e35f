#!/usr/bin/env python3
"""The Python client: what a researcher writes on the first day, on the shipped brain."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import numpy
import rospy
import rostest
import soft_tissue_sim as sts
from soft_tissue_sim.msg import Result
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from ros_world import tells_why, wait_for

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLOT_BAG = str(ROOT / "devel" / "lib" / "soft_tissue_sim" / "plot_bag")
PALPATE = (ROOT / "config" / "scenes" / "live_palpate.yaml").read_text()


def pressing_path(depth, seconds=0.5):
    """The finger of live_palpate goes down by `depth` [m] and stays."""
    times = numpy.linspace(0.0, seconds, 51)
    path = numpy.zeros((len(times), 8))
    path[:, 0], path[:, 1], path[:, 2], path[:, 7] = times, 0.012, -0.02, 1.0
    path[:, 3] = 0.079 - depth * numpy.clip(2.0 * times / seconds, 0.0, 1.0)
    return path


class Python(unittest.TestCase):
    @classmethod
    @tells_why
    def setUpClass(cls):
        rospy.init_node("python_test")
        cls.organ = sts.Organ()
        cls.mesh = cls.organ.mesh()
        cls.organ.load_scene(PALPATE)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())

    def test_a_mesh_comes_as_arrays_that_belong_together(self):
        mesh = self.mesh
        self.assertLess(mesh.tets.max(), len(mesh.vertices))
        self.assertEqual(len(mesh.levels), len(mesh.tets))
        self.assertEqual(len(mesh.tet_densities), len(mesh.tets))
        self.assertEqual(len(mesh.densities), len(mesh.vertices))
        volumes = mesh.volumes()
        self.assertGreater(volumes.min(), 0.0)
        # Gauss: the volume within the surface.
        a, b, c = (mesh.vertices[mesh.surface[:, i]].astype(float) for i in range(3))
        within = numpy.einsum("ij,ij->i", a, numpy.cross(b, c)).sum() / 6.0
        self.assertAlmostEqual(volumes.sum() / within, 1.0, places=5)

    def test_build_makes_another_mesh_or_says_why_not(self):
        with self.assertRaises(sts.Refused) as refused:
            self.organ.build(iso_value=20.0, initial_tetrahedra=2000, level_sections=0)
        self.assertEqual(refused.exception.code, Result.E_N)
        self.assertIn("level_sections", str(refused.exception))
        with self.assertRaises(TypeError):
            self.organ.build(initial_tetrahedrons=2000)
        mesh = self.organ.build(use_mask=True, iso_value=20.0, initial_tetrahedra=3000)
        self.assertNotEqual(mesh.uuid, self.mesh.uuid)
        type(self).mesh = mesh

    def test_a_moved_finger_moves_tissue_and_feels_it(self):
        wait_for(lambda: len(self.organ.positions()) == len(self.mesh.vertices), 60)
        run = self.organ.move("finger", pressing_path(0.002))
        self.assertEqual(run.positions.shape[1:], self.mesh.vertices.shape)
        self.assertEqual(len(run.positions), len(run.times))
        largest = numpy.linalg.norm(run.positions[-1] - self.mesh.vertices, axis=1).max()
        self.assertAlmostEqual(1e3 * largest, 2.0, places=2)
        # The tissue pushes the finger back up, in proportion to its depth.
        self.assertGreater(run.forces["finger"][-1, 3], 0.01)
        self.assertGreater(numpy.ptp(run.probes["tumour"][:, 3]), 1e-5)

    def test_a_path_that_is_none_or_that_nobody_hears_is_refused(self):
        with self.assertRaises(ValueError):
            self.organ.move("finger", numpy.zeros((3, 7)))
        backwards = pressing_path(0.0)[::-1]
        with self.assertRaises(ValueError):
            self.organ.move("finger", backwards)
        with self.assertRaisesRegex(rospy.ROSException, "nobody listens to /nobody/measured_cp"):
            sts.Organ(timeout=0.5).move("nobody", pressing_path(0.0))

    def test_what_paraview_reads_is_what_there_is(self):
        moved = self.mesh.vertices + numpy.float32(0.001)
        path = self.folder / "mesh.vtu"
        self.mesh.write_vtu(path, moved)
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        grid = reader.GetOutput()
        self.assertTrue((vtk_to_numpy(grid.GetPoints().GetData()) == self.mesh.vertices).all())
        self.assertEqual(grid.GetNumberOfCells(), len(self.mesh.tets))
        self.assertTrue((vtk_to_numpy(grid.GetCellData().GetArray("level")) == self.mesh.levels).all())
        self.assertTrue((vtk_to_numpy(grid.GetCellData().GetArray("density")) == self.mesh.tet_densities).all())
        displacement = vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
        self.assertTrue(numpy.allclose(displacement, 0.001, atol=1e-6))

    def test_a_bag_is_read_as_what_was_heard_and_plotted(self):
        bag = self.folder / "run.bag"
        recorder = subprocess.Popen(["rosbag", "record", "--quiet", "-O", str(bag), "/deformed_cloud",
                                     "/deformer_node/probes", "/finger/servo_cf", "__name:=recorder"])
        wait_for(lambda: "/recorder" in subprocess.run(["rosnode", "info", "/deformer_node"], capture_output=True,
                                                       text=True).stdout, 30)
        self.organ.reset()
        run = self.organ.move("finger", pressing_path(0.001))
        subprocess.run(["rosnode", "kill", "/recorder"], capture_output=True, check=True)
        recorder.wait()
        read = sts.Run.from_bag(bag)
        self.assertEqual(read.positions.shape[1:], self.mesh.vertices.shape)
        last = numpy.linalg.norm(read.probes["tumour"][-1, 1:] - run.probes["tumour"][-1, 1:])
        self.assertLess(last, 1e-6)
        picture = self.folder / "run.png"
        done = subprocess.run([PLOT_BAG, str(bag), "-o", str(picture)], capture_output=True,
                              text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"finger: force at most [\d.]+ N")
        self.assertGreater(picture.stat().st_size, 10000)

    def test_a_bag_without_any_of_it_is_refused_in_a_sentence(self):
        for name in ("press.bag", "no.bag"):
            done = subprocess.run([PLOT_BAG, str(ROOT / "data" / name)], capture_output=True,
                                  text=True)
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.stderr, f"^plot_bag: .*{name}: .+\n$")

    def test_the_example_of_the_first_day_runs(self):
        vtu = self.folder / "first_day.vtu"
        done = subprocess.run([str(ROOT / "docs" / "first_day.py"), "-o", str(vtu)], capture_output=True, text=True,
                              env=dict(os.environ, ROS_LOG_DIR=str(self.folder)))
        self.assertEqual(done.returncode, 0, done.stderr)
        forces = [float(force) for force in re.findall(r"([\d.]+) N at 2 mm", done.stdout)]
        # What the program is for: the tumour is felt.
        self.assertEqual(len(forces), 2, done.stdout)
        self.assertGreater(forces[0], 1.1 * forces[1])
        self.assertGreater(vtu.stat().st_size, 100000)


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "python", Python)
