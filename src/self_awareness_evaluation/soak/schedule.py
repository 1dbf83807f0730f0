"""Which faults hit the robot of a soak, and when: drawn by a seed."""
from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Dict, Iterator, List, Tuple

from self_awareness_evaluation.simulated.records import default_faults
from self_awareness_follow_me.faults import effect_of
from self_awareness_follow_me.scenario import Scenario

CRASH, HANG, HALF, DOUBLE = 'crash', 'hang', 'half', 'double'

SHORT_S = (0.2, 1.5)
"""Shortest and longest of the short hangs [s], which need not be found."""

LONG_S = (4.0, 12.0)
"""Shortest and longest of all other faults [s]."""

PAUSE_S = (5.0, 20.0)
"""Least and most of normal operation between two faults [s]."""

_SHARE_OF_SHORT = 0.15


@dataclass(frozen=True)
class Fault:
    """A fault to come.

    Args:
        kind: crash (the node is killed, and started again at the end), hang (its process is
            stopped, and goes on at the end), half or double (it works at that rate).
        component: that it hits.
        after_s: time of normal operation before it [s].
        lasts_s: from its onset to when it is undone [s].
    """

    kind: str
    component: str
    after_s: float
    lasts_s: float

    @property
    def name(self) -> str:
        """Kind and component."""
        return f'{self.kind}:{self.component}'


def faults(scenario: Scenario, seed: int) -> Iterator[Fault]:
    """Yield faults without an end; the same for the same seed.

    Args:
        scenario: the robot.
        seed: any.
    """
    chance = random.Random(f'{seed}/faults')
    kinds = possible(scenario)
    while True:
        after_s = round(chance.uniform(*PAUSE_S), 1)
        if chance.random() < _SHARE_OF_SHORT:
            hangs = [(kind, component) for kind, component in kinds if kind == HANG]
            yield Fault(*chance.choice(hangs), after_s, round(chance.uniform(*SHORT_S), 1))
        else:
            yield Fault(*chance.choice(kinds), after_s, round(chance.uniform(*LONG_S), 1))


def possible(scenario: Scenario) -> List[Tuple[str, str]]:
    """Return all faults: every regular component crashes and hangs, and changes its rate.

    Components that only speak now and then are left out: they may be silent for seconds.
    """
    return [(kind, component) for component in regular(scenario)
            for kind in (CRASH, HANG, HALF, DOUBLE)
            if kind == HANG or _can_be(scenario, f'{kind}:{component}')]


def regular(scenario: Scenario) -> Dict[str, str]:
    """Return a topic of each component that publishes all the time."""
    crashing = [name.partition(':')[2] for name in default_faults(scenario)
                if name.startswith(f'{CRASH}:')]
    return {name: next(iter(scenario.component(name).outputs())) for name in crashing}


def _can_be(scenario: Scenario, name: str) -> bool:
    try:
        effect_of(scenario, name)
    except ValueError:  # too busy to do as much twice as often
        return False
    return True
