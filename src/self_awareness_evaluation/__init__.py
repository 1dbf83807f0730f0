"""Measures detectors on recordings whose faults are known, side by side and by the same rules."""
