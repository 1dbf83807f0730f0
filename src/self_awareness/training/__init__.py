"""Learning from recordings of normal operation: counts of many bags, and who listens to whom."""
