"""Two versions of the detectors side by side, by what the same commands measured of each."""
