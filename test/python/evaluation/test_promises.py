"""What a model promises of deaths and late answers is kept in recordings that it never saw."""
from __future__ import annotations

from dataclasses import replace
from typing import Dict, Iterator, Tuple

import pytest

from self_awareness.calibration.fault_injection import InjectedFault, inject
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.families.protocol import Records
from self_awareness_evaluation.records import Learning, WindowedEvents
from self_awareness_evaluation.systems import Evidence

LATER = 1.1
"""Times the least delay that is promised to be found: it counts delays by bins."""
CLOSES_S = 0.2  # a window is judged at its end, and a silence in two of them

Watching = Tuple[Evidence, WindowedEvents]


@pytest.fixture(scope='module', params=['timers_drift', 'wireless'])
def watching(request: pytest.FixtureRequest) -> Watching:
    """Return what has learned from four starts of a robot, and a recording of another one."""
    records = Records(request.param, 61)
    learning = Learning.of(4, 150.0, 150.0)
    system = Evidence(records.robot.graph)
    system.train(records.training(learning))
    system.calibrate(records.calibration(learning))
    return system, next(records.watched(0.05))


def found_after(watching: Watching, kind: str, amounts: Dict[str, float]
                ) -> Iterator[Tuple[str, float]]:
    """Yield after how many seconds there is an alarm for a fault of each component; inf: never.

    What is injected comes late alone, and what follows it does not: either may be named.
    """
    system, normal = watching
    onset = int(normal.stamps[0]) + 60 * SECOND_NS
    for component, amount in amounts.items():
        stamps, ids = inject(InjectedFault(kind, component, amount), normal.event_types,
                             normal.stamps, normal.ids, onset, normal.end - 1)
        judged = system.judge(replace(normal, stamps=stamps, ids=ids, attributes=None))
        yield component, min(((alarm.start - onset) / SECOND_NS for alarm in judged.alarms
                              if alarm.start >= onset), default=float('inf'))


def test_deaths_are_found_in_the_time_that_is_promised(watching: Watching) -> None:
    promised = {each.component: each.death_found_after for each in watching[0].coverage()
                if each.death_found_after is not None and each.death_found_after < 60.0}
    assert len(promised) > 10
    late = [component for component, after_s in
            found_after(watching, 'crash', dict.fromkeys(promised, 0.0))
            if after_s > promised[component] + CLOSES_S]
    assert len(late) <= len(promised) // 20, late


def test_answers_as_late_as_is_promised_are_found(watching: Watching) -> None:
    promised = {each.component: LATER * each.late_answers for each in watching[0].coverage()
                if each.late_answers is not None}
    assert len(promised) > 5
    missed = [component for component, after_s in found_after(watching, 'late', promised)
              if after_s > 60.0]
    assert len(missed) <= len(promised) // 20, missed
