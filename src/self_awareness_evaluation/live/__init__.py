"""Detectors on the running follow-me robot: the monitor live, others on its recording."""
