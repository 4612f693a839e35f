"""A volume that nodes can be asked to mesh, and how to ask."""
import math

from soft_tissue_sim.msg import Volume
from soft_tissue_sim.srv import BuildMeshRequest

SIZE = 32
CENTRE = (SIZE - 1) / 2
RADIUS = 12.0


def ball():
    """A ball of 12 mm, dense in the middle."""
    volume = Volume()
    volume.header.frame_id = "patient"
    volume.width = volume.height = volume.depth = SIZE
    volume.spacing.x = volume.spacing.y = volume.spacing.z = 1e-3
    volume.origin.orientation.w = 1.0
    volume.encoding = "8UC1"
    volume.quantity = "density"
    data = bytearray()
    for z in range(SIZE):
        for y in range(SIZE):
            for x in range(SIZE):
                d = math.dist((x, y, z), (CENTRE,) * 3)
                data.append(max(0, min(255, int(100 + 10 * (RADIUS - d)))))
    volume.data = bytes(data)
    return volume


def request(**fields):
    defaults = dict(iso_value=100.0, spacing=0.006, level_sections=2)
    return BuildMeshRequest(**{**defaults, **fields})
