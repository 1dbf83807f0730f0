"""The follow-me robot in quick motion: all that takes its time takes less of it.

Its components do the same as otherwise, only more often. The machine that they run on stays as
fast as it is: a message travels as long, and a timer fires as late.
"""
from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from typing import Any

from self_awareness_follow_me.component_spec import Duration, Hypothesis, Need, Task
from self_awareness_follow_me.effects import ClockDrift, Starvation
from self_awareness_follow_me.scenario import Scenario

# What is a number of seconds, beside durations. A drifting clock stays in proportion to the stamps
# that it makes.
_SECONDS = {
    Task: ('jitter',),
    Need: ('within', 'stamps_within'),
    Hypothesis: ('discard_after',),
    Starvation: ('ramp',),
    ClockDrift: ('drift', 'settle', 'wobble', 'periods'),
}


def sped_up(scenario: Scenario, speed: float) -> Scenario:
    """Return a robot that does everything `speed` times as fast.

    Args:
        scenario: the robot.
        speed: > 0; 1: as it is.
    """
    faults = _scaled(scenario.faults, 1.0 / speed)
    lat = replace(faults.lat, settings={'delay': faults.lat.settings['delay'] / speed})
    return replace(scenario, components=_scaled(scenario.components, 1.0 / speed),
                   faults=replace(faults, lat=lat))


def _scaled(part: Any, factor: float) -> Any:
    """Return a part of a scenario with all its times multiplied by the factor."""
    if isinstance(part, Duration):
        return part.times(factor)
    if isinstance(part, tuple):
        return tuple(_scaled(element, factor) for element in part)
    if not is_dataclass(part) or isinstance(part, type):
        return part
    changed = {field.name: _scaled(getattr(part, field.name), factor) for field in fields(part)}
    for name in _SECONDS.get(type(part), ()):
        value = getattr(part, name)
        if isinstance(value, tuple):
            changed[name] = tuple(number * factor for number in value)
        elif value is not None:
            changed[name] = value * factor
    return replace(part, **changed)
