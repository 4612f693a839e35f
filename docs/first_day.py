#!/usr/bin/env python3
"""How stiff does the tissue feel over the tumour, and beside it? The organ's nodes have to run:
roslaunch soft_tissue_sim demo.launch rviz:=false play:=false

usage: docs/first_day.py [-o OUT.vtu]
"""
import argparse
import pathlib

import numpy
import soft_tissue_sim as sts

ROOT = pathlib.Path(__file__).resolve().parent.parent
parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("-o", default="first_day.vtu", metavar="OUT.vtu")
out = parser.parse_args().o

organ = sts.Organ()
mesh = organ.build(use_mask=True, iso_value=20.0, initial_tetrahedra=6000)
print(f"{len(mesh.tets)} tets, {1e6 * mesh.volumes().sum():.0f} ml")
organ.load_scene((ROOT / "config" / "scenes" / "live_palpate.yaml").read_text())

# A finger on the cortex goes 2 mm into it within a second, and stays for another.
times = numpy.linspace(0.0, 2.0, 201)
depths = 0.002 * numpy.clip(times, 0.0, 1.0)
for where, x in (("over the tumour", 0.002), ("beside it", 0.040)):
    top = mesh.vertices[mesh.surface.ravel()]
    near = top[numpy.hypot(top[:, 0] - x, top[:, 1] + 0.020) < 0.004]
    path = numpy.zeros((len(times), 8))
    path[:, 0], path[:, 1], path[:, 2] = times, x, -0.020
    path[:, 3] = near[:, 2].max() - depths
    path[:, 7] = 1.0
    organ.reset()
    run = organ.move("finger", path)
    force = numpy.linalg.norm(run.forces["finger"][-1, 1:])
    tumour = 1e3 * numpy.linalg.norm(run.probes["tumour"][-1, 1:] - run.probes["tumour"][0, 1:])
    print(f"{where}: {force:.2f} N at 2 mm; the tumour moved by {tumour:.2f} mm")

mesh.write_vtu(out, run.positions[-1])
print(f"{out}: open it in ParaView, and warp it by its displacement")
