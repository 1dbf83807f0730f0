"""Simulated robots of one make, each in a namespace of its own."""
from __future__ import annotations

from dataclasses import replace
from typing import Set, Tuple

import numpy as np

from self_awareness import EncodingRules, EventType
from self_awareness_evaluation.families.emissions import Timer
from self_awareness_evaluation.families.kinds import RATES_HZ, Draft, add_timers_and_chains
from self_awareness_evaluation.families.robot import Output, Robot
from self_awareness_evaluation.windowed_events import WindowedEvents

RENAME = ('/r[0-9]+/(.*)', r'/\1')
"""What takes the robots' namespaces away."""

MOST_ROBOTS = 90
"""A make has no more robots."""

_PPM = 50.0
_ARM_HZ = 50.0


def draw(make: int, number: int) -> Robot:
    """Return a robot of a make.

    All have the same timers and chains of answers. Each has clocks of its own, which are off by
    up to 50 ppm, and a sensor that no other one has; every second one has an arm, and what
    answers to it.

    Args:
        make: seed of what all have in common.
        number: of the robot, from 0.
    """
    draft = Draft(np.random.default_rng(make), namespace=f'/r{number}')
    add_timers_and_chains(draft)
    if number % 2 == 0:
        draft.add_chain('gripper', draft.add_timer('arm', _ARM_HZ), _ARM_HZ, 2)
    own = np.random.default_rng((make, number))
    draft.add(f'sensor{number}', 'data', 'sensor_msgs/Temperature',
              Timer(1.0 / float(own.choice(RATES_HZ))))
    robot = draft.robot((make + 1) * (MOST_ROBOTS + 10) + number)
    return replace(robot, outputs=tuple(_with_clock(output, own) for output in robot.outputs))


def renamed(recording: WindowedEvents, robot: str) -> WindowedEvents:
    """Return a recording as the encoding of the make gives it, of a robot of this name."""
    rules = _rules()
    sources = rules.sources_of({kind.source for kind in recording.event_types})
    scopes = rules.scopes_of({kind.scope for kind in recording.event_types})
    kinds = [EventType(sources[kind.source], scopes[kind.scope], kind.type)
             for kind in recording.event_types]
    return replace(recording, event_types=kinds, robot=robot)


def renamed_graph(robot: Robot) -> Set[Tuple[str, str, str]]:
    """Return publisher, topic and subscriber of a robot, likewise."""
    rules = _rules()
    sources = rules.sources_of({name for edge in robot.graph for name in (edge[0], edge[2])})
    scopes = rules.scopes_of({topic for _, topic, _ in robot.graph})
    return {(sources[one], scopes[topic], sources[other]) for one, topic, other in robot.graph}


def renamed_source(source: str) -> str:
    """Return what events call a component."""
    return _rules().sources_of({source})[source]


def _rules() -> EncodingRules:
    rules = EncodingRules()
    rules.rename = [RENAME]
    return rules


def _with_clock(output: Output, own: np.random.Generator) -> Output:
    ppm = float(own.uniform(-_PPM, _PPM))
    emission = output.emission
    return (replace(output, emission=replace(emission, ppm=ppm))
            if isinstance(emission, Timer) else output)
