from setuptools import setup
from catkin_pkg.python_setup import generate_distutils_setup

setup(**generate_distutils_setup(
    packages=['self_awareness', 'self_awareness.commands', 'self_awareness.evaluation',
              'self_awareness.evaluation.peers', 'self_awareness.follow_me'],
    package_dir={'': 'src'},
))
