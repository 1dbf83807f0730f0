"""The monitor beside a fast robot for an hour: what it finds, misses and makes up."""
