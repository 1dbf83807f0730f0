"""Times and statuses as people read them."""
from __future__ import annotations

import doctest
import time
from typing import Iterator

import pytest

from self_awareness import status_names
from self_awareness.stamps import SECOND_NS, moment, span, to_the_second, utc
from self_awareness.status_names import status_name, task_of

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


def test_the_examples_of_docstrings_do_what_they_say() -> None:
    result = doctest.testmod(status_names)
    assert result.attempted > 2 and result.failed == 0


@pytest.mark.parametrize('node', ['/self_awareness', '/steps/self_awareness', '/a/b/watch'])
@pytest.mark.parametrize('task', ['communication', '/arm/driver'])
def test_each_node_knows_its_own(node: str, task: str) -> None:
    name = status_name(node, task)
    assert task_of(node, name) == task
    for other in ('/self_awareness', '/steps/self_awareness', '/a/b/watch', '/watch', '/other'):
        assert (task_of(other, name) is None) == (other != node)
