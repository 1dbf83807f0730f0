"""Stamps are integers of nanoseconds since 1970: makes them from seconds, and shows them."""
from __future__ import annotations

from datetime import datetime, timezone

SECOND_NS = 1_000_000_000


def nanoseconds(seconds: float) -> int:
    """Return `seconds` as int nanoseconds, rounded to the nearest."""
    return round(seconds * SECOND_NS)


def utc(stamp: int) -> str:
    """Return a stamp [ns] as date and time with milliseconds, in UTC."""
    # Whole seconds and milliseconds are kept apart: a float of seconds since 1970 rounds.
    seconds, rest = divmod(stamp, SECOND_NS)
    time = datetime.fromtimestamp(seconds, timezone.utc)
    return f'{time:%Y-%m-%d %H:%M:%S}.{rest // 1_000_000:03d}'
