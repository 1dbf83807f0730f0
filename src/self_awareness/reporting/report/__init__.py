"""The report: one self-contained HTML file that says who failed, when and why (docs/alarm.md)."""
