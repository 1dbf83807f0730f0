"""How old a model is, in words and as plain values for JSON."""
from __future__ import annotations

from typing import Any, Dict, List

from self_awareness.learning.age import Age
from self_awareness.reporting.text import (aligned, duration, first_lines, number_of, percent,
                                           seconds_of)
from self_awareness.stamps import SECOND_NS, to_the_second

_DAY_S = 86_400.0
_MOST_LINES = 10


def summarise(age: Age) -> Dict[str, Any]:
    """Return what is known of a model's age as plain values."""
    return {
        'learned_until_ns': age.learned_until,
        'heard_until_ns': _heard_until(age),
        'samples': age.samples,
        'hours': _heard_s(age) / 3600.0,
        'recordings': len(age.counted),
        'left_out': [{'recording': str(each.part), 'reason': each.left_out, 'why': each.why}
                     for each in age.heard if each.left_out],
        'evidence_needed': age.needed,
        'drifting': age.drifting,
        'components': [{'component': name, 'usual_share': drift.usual, 'last_share': drift.last,
                        'evidence': drift.evidence, 'told_by_sample': drift.told_by or None}
                       for name, drift in age.drift.items()],
    }


def lines(age: Age, details: bool = False) -> List[str]:
    """Return how old a model is, as text: the verdict first, then what drifts, or all components.

    Args:
        age: what recordings say of it.
        details: list the components that do not drift, too.
    """
    text = [f'learned until {to_the_second(age.learned_until)}; {_verdict(age)}']
    shown = sorted(age.drift.items(), key=lambda item: -item[1].evidence)
    if not details:
        shown = [item for item in shown if item[1].told_by]
    rows = [(name, percent(drift.usual), percent(drift.last),
             *([f'{drift.evidence:.3g} of {age.needed:g}'] if details else []))
            for name, drift in shown]
    if rows:
        head = ['component', 'usual', 'last, of the limit', *(['evidence'] if details else [])]
        table = aligned([head, *rows])
        text += [f'  {line}' for line in (table if details else first_lines(
            table, _MOST_LINES + 1, ' (--details)'))]
    for reason, number in age.left_out.items():
        text.append(f'left out, {reason}: {number_of(number, "recording")}')
    return text + [f'  {each.part}: {each.why}' for each in age.heard if each.why]


def _verdict(age: Age) -> str:
    until = _heard_until(age)
    if until is None:
        return 'nothing was heard since that could tell a drift'
    days = round(max(0.0, (until - age.learned_until) / SECOND_NS / _DAY_S))
    return (f'heard since for {duration(_heard_s(age))} in '
            f'{number_of(age.samples, "start")} of the robot or days of one, the last '
            f'{number_of(days, "day")} later: '
            + (f'drifting: {", ".join(age.drifting)}' if age.drifting else 'nothing drifts'))


def _heard_until(age: Age) -> Any:
    return max((each.recording.end for each in age.counted), default=None)


def _heard_s(age: Age) -> float:
    return seconds_of(each.recording for each in age.counted)
