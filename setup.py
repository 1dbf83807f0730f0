from setuptools import setup
from catkin_pkg.python_setup import generate_distutils_setup

setup(**generate_distutils_setup(
    packages=['self_awareness', 'self_awareness.calibration', 'self_awareness.commands',
              'self_awareness.evaluation', 'self_awareness.evaluation.live',
              'self_awareness.evaluation.peers', 'self_awareness.evaluation.recordings',
              'self_awareness.evaluation.simulated', 'self_awareness.follow_me',
              'self_awareness.reporting', 'self_awareness.training'],
    package_dir={'': 'src'},
))
