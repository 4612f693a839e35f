"""Organs that move, from Python: a mesh from the mesher, a scene for the deformer, poses in, clouds and forces out.

    import soft_tissue_sim as sts
    organ = sts.Organ()                                   # of nodes that run
    mesh = organ.build(iso_value=20.0, initial_tetrahedra=4000)
    organ.load_scene(open("config/scenes/live_palpate.yaml").read())
    run = organ.move("finger", path)                      # (n, 8): t x y z qx qy qz qw
    mesh.write_vtu("pressed.vtu", run.positions[-1])
"""
from .mesh import Mesh
from .organ import Organ, Refused
from .run import Run, displacements_of, positions_of

__all__ = ["Mesh", "Organ", "Refused", "Run", "displacements_of", "positions_of"]
