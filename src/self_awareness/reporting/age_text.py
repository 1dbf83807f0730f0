"""How old a model is, in words and as plain values for JSON."""
from __future__ import annotations

from typing import Any, Dict, List

from self_awareness.learning.age import Age
from self_awareness.reporting.text import percent
from self_awareness.stamps import SECOND_NS, moment

_DAY_S = 86_400.0
_MOST_LINES = 10


def summarise(age: Age) -> Dict[str, Any]:
    """Return what is known of a model's age as plain values."""
    return {
        'learned_until_ns': age.learned_until,
        'heard_until_ns': _heard_until(age),
        'samples': age.samples,
        'hours': _hours(age),
        'recordings': len(age.counted),
        'left_out': [{'recording': str(each.part), 'reason': each.left_out, 'why': each.why}
                     for each in age.heard if each.left_out],
        'evidence_needed': age.needed,
        'drifting': age.drifting,
        'components': [{'component': name, 'usual_share': drift.usual, 'last_share': drift.last,
                        'evidence': drift.evidence, 'told_by_sample': drift.told_by or None}
                       for name, drift in age.drift.items()],
    }


def lines(age: Age) -> List[str]:
    """Return how old a model is, as text."""
    text = [f'learned      until {moment(age.learned_until)}']
    until = _heard_until(age)
    if until is None:
        text.append('heard since  nothing that could tell a drift')
    else:
        days = max(0.0, (until - age.learned_until) / SECOND_NS / _DAY_S)
        text.append(f'heard since  until {moment(until)}, {days:.1f} days later: '
                    f'{_hours(age):.1f} h in {len(age.counted)} recordings, {age.samples} starts '
                    'of the robot or days of one')
    for reason, number in age.left_out.items():
        text.append(f'left out     {number} recordings: {reason}')
    text += [f'  {each.part}: {each.why}' for each in age.heard if each.why]
    if age.drift:
        text += _drift(age)
    return text


def _drift(age: Age) -> List[str]:
    text = ['drift        ' + (', '.join(age.drifting) or 'none is told')
            + f' (told where the evidence is {age.needed:g} or more)',
            '     usual      last  evidence  [share of the limit]']
    ranked = sorted(age.drift.items(), key=lambda item: -item[1].evidence)
    for name, drift in ranked[:_MOST_LINES]:
        told = f', since sample {drift.told_by}' if drift.told_by else ''
        text.append(f'  {percent(drift.usual):>8}  {percent(drift.last):>8}  '
                    f'{drift.evidence:8.3g}  {name}{told}')
    if len(ranked) > _MOST_LINES:
        text.append(f'  and {len(ranked) - _MOST_LINES} components with less evidence')
    return text


def _heard_until(age: Age) -> Any:
    return max((each.recording.end for each in age.counted), default=None)


def _hours(age: Age) -> float:
    return sum(each.recording.end - each.recording.start
               for each in age.counted) / SECOND_NS / 3600.0
