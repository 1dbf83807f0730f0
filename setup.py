from setuptools import setup
from catkin_pkg.python_setup import generate_distutils_setup

# Without self_awareness_evaluation: it serves the checkout that it lies in, not a robot.
setup(**generate_distutils_setup(
    packages=['self_awareness', 'self_awareness.calibration', 'self_awareness.commands',
              'self_awareness.comparison', 'self_awareness.learning', 'self_awareness.live_view',
              'self_awareness.recovery', 'self_awareness.reporting',
              'self_awareness.reporting.report', 'self_awareness.training',
              'self_awareness_follow_me'],
    package_data={'self_awareness': ['py.typed', '*.pyi'],
                  'self_awareness.reporting.report': ['*.html', '*.css', '*.js', '*.xml']},
    package_dir={'': 'src'},
))
