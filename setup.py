# Called by catkin, not by hand.
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["soft_tissue_sim"], package_dir={"": "src"}))
