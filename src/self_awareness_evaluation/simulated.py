"""The records of one seed of the simulated follow-me robot, in simulated time.

Every record has a seed of its own, derived from the evaluation's seed and the record's name alone:
it stays the same whatever else is evaluated. So does the onset of its fault. Every record is a
start of the robot, hours away from the others: what agrees in all of them could have differed.
"""
from __future__ import annotations

import hashlib
import os
import random
import tempfile
from functools import partial
from typing import Dict, Iterable, List, Optional, Sequence, Set, Tuple

import numpy as np

from self_awareness import EncodingRules, read_events
from self_awareness.stamps import nanoseconds
from self_awareness_evaluation.records import (NORMAL, FaultRecord, Learning, Robot, Subscriptions,
                                               WindowedEvents)
from self_awareness_follow_me.component_spec import ComponentSpec
from self_awareness_follow_me.effects import Change
from self_awareness_follow_me.faults import effect_of
from self_awareness_follow_me.scenario import Scenario, load_scenario
from self_awareness_follow_me.simulation import START_S, InducedFault, simulate

RECORD_S = 100.0  # length of the records of training and of faults [s], as in the paper
NORMAL_TEST_S = 600.0  # of the record of normal operation that false alarms are counted on

# What the records to learn from are called; those of faults are called as the faults.
TRAINING_NAMES = ('training 1', 'training 2')
CALIBRATION_NAME = 'calibration'

# Faults that neither silence nor timing tells, and the time in which they are to be found [s].
WITHIN_S: Dict[str, float] = {
    'stale:slam': 1.4,  # two periods, and a second
    'lossy:motors': 30.0, 'lossy:camera': 30.0, 'empty:player': 5.0, 'freeze:camera': 5.0,
    'unsubscribed:navigation': 65.0,  # it is a finding after a minute
}

# What is learned from: as in the paper, but for the calibration, which has 100 s there.
LEARNING = Learning(len(TRAINING_NAMES), RECORD_S, 1, 600.0)

# For how long records with a fault go on, at least, after its onset [s].
_GOES_ON_S = {'lossy:camera': 150.0,  # of 7.5 images a second, 0.075 are lost
              'unsubscribed:navigation': 70.0}

_HOURS = 1 << 15  # that a record may begin at
_ONSET_S = 50.0
_ONSET_SPREAD_S = 2.0  # the onset must have no fixed phase to the windows and the robot's timers
_IRREGULAR = ('speech_recognition', 'dialog', 'anchoring')  # they send when something happens


def default_faults(scenario: Scenario) -> List[str]:
    """Return the faults that are evaluated: the paper's, further ones, and crashes in turn."""
    crashes = [f'crash:{each.name}' for each in scenario.components if each.name not in _IRREGULAR]
    return ['cc1', 'cc2', 'rs', 'ac', 'lat', 'silence', 'extra', 'half:player',
            'double:gaze_control', 'order', 'unknown', *WITHIN_S, *crashes]


def own(seed: int, faults: Sequence[str]) -> Robot:
    """Return the robot of a seed; faults: kinds of simulation.InducedFault."""
    scenario = load_scenario()
    normal = partial(normal_record, scenario, seed)
    return Robot(
        {f'/{spec.name}' for spec in scenario.components}, graph_of(scenario),
        lambda learning: [normal(name, learning.training_s) for name in TRAINING_NAMES],
        lambda learning: [normal(CALIBRATION_NAME, learning.calibration_s)],
        lambda: [normal(NORMAL, NORMAL_TEST_S)],
        lambda: (fault_record(scenario, seed, kind) for kind in faults))


def graph_of(scenario: Scenario) -> Set[Tuple[str, str, str]]:
    """Return publisher, topic and subscriber of all that components hear of each other."""
    return {(f'/{publisher.name}', f'/{topic}', f'/{listener.name}')
            for publisher in scenario.components for listener in scenario.components
            for topic in set(publisher.outputs()) & set(listener.inputs())}


def normal_record(scenario: Scenario, seed: int, name: str, duration_s: float) -> WindowedEvents:
    """Return a record of normal operation; its name decides, with the seed, what is random."""
    return _recorded(scenario, _derived_seed(seed, name), duration_s, None)


def fault_record(scenario: Scenario, seed: int, kind: str) -> FaultRecord:
    """Return a record with a fault; it is longer than RECORD_S where the fault takes so long."""
    spread = random.Random(f'{seed}/{kind}/onset').uniform(0.0, _ONSET_SPREAD_S)
    fault = InducedFault(kind, _ONSET_S + spread)
    derived = _derived_seed(seed, kind)
    duration_s = max(RECORD_S, fault.onset_s + _GOES_ON_S.get(kind, 0.0))
    recording = _recorded(scenario, derived, duration_s, fault)
    onset = nanoseconds(_start_s(derived) + fault.onset_s)
    return FaultRecord(kind, effect_of(scenario, kind).culprits, recording, onset)


def _recorded(scenario: Scenario, seed: int, duration_s: float,
              fault: Optional[InducedFault]) -> WindowedEvents:
    """Return what is read of the robot's bag, but for what is held ready: that is no message."""
    start_s = _start_s(seed)
    rules = EncodingRules()
    rules.type_fields = dict(scenario.type_fields)
    with tempfile.TemporaryDirectory() as folder:
        bag = os.path.join(folder, 'robot.bag')
        simulate(bag, duration_s, seed, fault, scenario, start_s)
        found = read_events(bag, rules)
    is_message = np.array([kind.is_message for kind in found.event_types])
    heard = is_message[found.ids]
    ids = (np.cumsum(is_message) - 1).astype(np.uint32)[found.ids[heard]]
    return WindowedEvents([kind for kind in found.event_types if kind.is_message],
                          found.stamps[heard], ids, nanoseconds(start_s + duration_s),
                          attributes=found.attributes[heard],
                          subscriptions=_subscriptions(scenario, start_s, fault))


def _subscriptions(scenario: Scenario, start_s: float, fault: Optional[InducedFault]
                   ) -> Sequence[Tuple[int, Subscriptions]]:
    """Return what nodes subscribe to, from the start on, and from the onset of a fault on."""
    def since(begin_s: float, specs: Iterable[ComponentSpec]) -> Tuple[int, Subscriptions]:
        return nanoseconds(begin_s), frozenset((f'/{spec.name}', f'/{topic}') for spec in specs
                                               for topic in spec.inputs())

    found = [since(start_s, scenario.components)]
    if fault is not None:
        effect = effect_of(scenario, fault.kind)
        if isinstance(effect, Change):
            found.append(since(start_s + fault.onset_s, map(effect.changed, scenario.components)))
    return found


def _start_s(seed: int) -> float:
    return START_S + 3600.0 * (seed % _HOURS)


def _derived_seed(seed: int, name: str) -> int:
    return int.from_bytes(hashlib.sha256(f'{seed}/{name}'.encode()).digest()[:4], 'big')
