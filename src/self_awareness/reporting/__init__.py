"""Shows models and results: as text, as plain values, and as plots."""
