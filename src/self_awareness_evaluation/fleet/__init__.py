"""Robots of one make: what was learned on some watches another."""
