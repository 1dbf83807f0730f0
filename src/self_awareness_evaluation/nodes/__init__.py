"""A system of ROS nodes that nobody here wrote, all of Debian packages, and the monitor live."""
