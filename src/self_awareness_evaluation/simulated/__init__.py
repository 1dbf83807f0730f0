"""Detectors on the simulated follow-me robot, in simulated time."""
