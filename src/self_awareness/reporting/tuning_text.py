"""The numbers of the method that a model was trained with, as text."""
from __future__ import annotations

from typing import List

from self_awareness import Tuning


def lines(tuning: Tuning) -> List[str]:
    """Return a line for each number: name, value, unit, range, and what it means.

    A number that is not the default is marked, with the default.
    """
    text = []
    for number in Tuning.numbers():
        value = tuning.get(number.name)
        changed = '' if value == number.default else f' (default: {number.default:g})'
        unit = f' {number.unit}' if number.unit else ''
        span = f'{number.least:g} to {number.most:g}'
        text.append(f'{number.name:<26} {f"{value:g}{unit}":<18} {span:<16} '
                    f'{number.meaning}{changed}')
    for channel in tuning.without:
        text.append(f'without the channel {channel}')
    return text
