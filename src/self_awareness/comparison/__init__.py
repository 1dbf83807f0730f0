"""Compares two models, or a model and a recording: what is new, gone or changed (docs/diff.md)."""
