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


def moment(stamp: int) -> str:
    """Return a stamp [ns] in UTC and, where it is another, in this machine's local time."""
    return f'{utc(stamp)} UTC{_local(stamp)}'


def to_the_second(stamp: int) -> str:
    """Return a stamp [ns] as moment() does, without milliseconds."""
    return f'{utc(stamp)[:19]} UTC{_local(stamp)}'


def span(begin: int, end: int) -> str:
    """Return two stamps [ns] as moment() does one."""
    return f'{utc(begin)} - {utc(end)} UTC{_local(begin, end)}'


def _local(*stamps: int) -> str:
    moments = [datetime.fromtimestamp(stamp // SECOND_NS, timezone.utc) for stamp in stamps]
    local = [each.astimezone() for each in moments]
    if not any(each.utcoffset() for each in local):
        return ''
    times = [f'{there:%H:%M:%S}' if there.date() == each.date() else f'{there:%Y-%m-%d %H:%M:%S}'
             for there, each in zip(local, moments)]
    return f' ({" - ".join(times)} {local[0]:%Z})'
