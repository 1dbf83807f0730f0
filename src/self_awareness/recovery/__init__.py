"""Does something about what the monitor blames, by rules of a file: `recovery.py`."""
