"""Detectors on the running follow-me robot, with the monitor beside it."""
