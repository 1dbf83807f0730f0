"""The simulated follow-me robot: its scenario, its faults, in simulated time and as ROS nodes."""
