"""Compares two models, or a model and a recording: what is new, gone, changed (docs/learn.md)."""
