"""Where scripts find the programs of the core."""
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent


def program(name):
    """Its path: in catkin's folder where there is ROS, else in CMake's; the bare name if it is in neither."""
    folders = (ROOT / "devel" / "lib" / "soft_tissue_sim", ROOT / "build")
    return str(next((folder / name for folder in folders if (folder / name).exists()), name))
