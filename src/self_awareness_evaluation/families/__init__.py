"""Simulated robots as different as possible, each drawn by a seed, to evaluate detectors on."""
