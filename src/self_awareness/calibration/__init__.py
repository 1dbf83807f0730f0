"""From when on a model calls windows abnormal: limits, thresholds, and how well they do."""
