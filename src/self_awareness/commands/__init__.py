"""The logic of the programs: each module has a `main(argv=None)` that returns the exit code."""
