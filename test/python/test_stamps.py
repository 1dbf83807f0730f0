"""Times as people read them: in UTC, and as the clock on their wall shows them."""
from __future__ import annotations

import time
from typing import Iterator

import pytest

from self_awareness.stamps import SECOND_NS, moment, span, to_the_second, utc

NOON = 1_795_348_800 * SECOND_NS + 123_456_789  # 2026-11-22 12:00 UTC


@pytest.fixture(params=['UTC', 'CET-1', 'JST-9', 'XYZ+3:30'])
def zone(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    monkeypatch.setenv('TZ', request.param)
    time.tzset()
    yield request.param
    monkeypatch.undo()
    time.tzset()


def test_local_time_stands_beside_utc_where_it_is_another(zone: str) -> None:
    local = {'UTC': '', 'CET-1': ' (13:00:00 CET)', 'JST-9': ' (21:00:00 JST)',
             'XYZ+3:30': ' (08:30:00 XYZ)'}
    assert moment(NOON) == f'{utc(NOON)} UTC{local[zone]}' == (
        f'2026-11-22 12:00:00.123 UTC{local[zone]}')
    assert to_the_second(NOON) == f'2026-11-22 12:00:00 UTC{local[zone]}'


def test_of_another_day_the_date_is_told(zone: str) -> None:
    begin, end = NOON + 10 * 3600 * SECOND_NS, NOON + 15 * 3600 * SECOND_NS
    local = {'UTC': '', 'CET-1': ' (23:00:00 - 04:00:00 CET)',
             'JST-9': ' (2026-11-23 07:00:00 - 12:00:00 JST)',
             'XYZ+3:30': ' (18:30:00 - 2026-11-22 23:30:00 XYZ)'}
    assert span(begin, end) == f'{utc(begin)} - {utc(end)} UTC{local[zone]}'
