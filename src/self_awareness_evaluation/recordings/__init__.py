"""Detectors on recordings of real robots."""
