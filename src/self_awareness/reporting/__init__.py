"""How models and results are shown: as text, as plain values, and as plots."""
