"""The simulated robot for its tests: each of its recordings is made once."""
from __future__ import annotations

from collections import Counter
from functools import lru_cache
from pathlib import Path
from typing import Any, List

from self_awareness_follow_me.component_spec import Duration, Output
from self_awareness_follow_me.scenario import Scenario, load_scenario
from self_awareness_follow_me.simulation import START_S, Event, InducedFault, events

SCENARIO = Path(__file__).resolve().parents[3] / 'config' / 'follow_me.yaml'
DURATION_S = 100.0
ONSET_S = 50.0
LEFT_S = DURATION_S - ONSET_S
ONSET_NS = int((START_S + ONSET_S) * 1e9)
MS = 1_000_000
S = 1000 * MS

Run = List[Event]


@lru_cache(maxsize=None)
def robot() -> Scenario:
    return load_scenario(SCENARIO)


@lru_cache(maxsize=None)
def run(kind: str = '', seed: int = 5) -> Run:
    """A recording with a fault, or without one."""
    fault = InducedFault(kind, ONSET_S) if kind else None
    return list(events(DURATION_S, seed, fault, robot()))


def times(of: Run, topic: str, value: Any = None, source: str = '') -> List[float]:
    """Seconds since the onset at which a topic (with a value, of a source) was seen after it."""
    return [(e.stamp_ns - ONSET_NS) / 1e9 for e in of
            if e.stamp_ns >= ONSET_NS and e.topic == topic and value in (None, e.message.value)
            and source in ('', e.source)]


def last(of: Run, topic: str, value: Any = None) -> float:
    """Seconds since the onset at which a topic (with a value) was seen last; 0: before."""
    return max(times(of, topic, value), default=0.0)


def counts(of: Run) -> Counter:
    """How many messages of each source came on each topic after the onset."""
    return Counter((e.source, e.topic) for e in of if e.stamp_ns >= ONSET_NS)


def output(topic: str, takes_s: float = 0.01, **options: Any) -> Output:
    return Output(topic, 'std_msgs/String', Duration(takes_s), Duration(0.0), **options)
