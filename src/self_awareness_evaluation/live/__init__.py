"""Sessions with a running robot and the monitor: one session, and a plan for each question."""
