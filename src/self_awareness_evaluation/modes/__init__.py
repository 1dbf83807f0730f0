"""Robots that do something only at times: one model for all they do, and one for each mode."""
