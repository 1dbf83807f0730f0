"""From nothing to a monitor: records a robot, learns from it, and goes on as the monitor."""
