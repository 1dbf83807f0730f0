"""When a model calls windows abnormal: limits, the threshold, and how well they do."""
