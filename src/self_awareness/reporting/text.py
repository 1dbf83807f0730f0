"""Numbers, names and tables as people read them."""
from __future__ import annotations

import math
from typing import Iterable, List, Optional, Sequence

from self_awareness import Recording
from self_awareness.stamps import SECOND_NS

_FORMULA = ('=', '+', '-', '@')


def rounded(value: float, digits: int) -> str:
    """Return a number with so many significant digits; without an exponent from 0.0001 to 999999.

    As `{value:.2g}`, which makes 1200 s to `1.2e+03 s`.
    """
    return f'{float(f"{value:.{digits}g}"):g}'


def or_dash(value: Optional[float]) -> str:
    """Return a number with three significant digits; '-': it is not known."""
    return '-' if value is None else rounded(value, 3)


def duration(seconds: float) -> str:
    """Return how long something lasts as people say it: 0.38 s, 12 s, 4 min, 2 h 10 min."""
    if seconds < 100.0:
        return f'{rounded(seconds, 2)} s'
    minutes = round(seconds / 60.0)
    if minutes < 100:
        return f'{minutes} min'
    hours, minutes = divmod(minutes, 60)
    return f'{hours} h' + (f' {minutes:02d} min' if minutes else '')


def delay(seconds: float) -> str:
    """Return a short time with three significant digits, in ms or s: 60 ms, 1.25 s."""
    is_short = seconds < 1.0
    return f'{rounded(1000.0 * seconds, 3)} ms' if is_short else f'{rounded(seconds, 3)} s'


def seconds_of(recordings: Iterable[Recording]) -> float:
    """Return how long recordings last together [s]."""
    return sum(each.end - each.start for each in recordings) / SECOND_NS


def number_of(number: int, what: str) -> str:
    """Return how many there are: '1 start', '2 starts'."""
    return f'{number} {what}{"" if number == 1 else "s"}'


def percent(share: float) -> str:
    """Return a share as people read it: '110 %'."""
    return f'{100.0 * share + 0.0:.0f} %'  # never -0


def of_limit(lowest: float, threshold: Optional[float]) -> str:
    """Return how far a score went: '110 % of the limit', which only the evidence detector has.

    Args:
        lowest: the score; NaN: there is none.
        threshold: of the score, below 0 of the evidence detector; None: not calibrated.
    """
    if threshold is not None and threshold < 0.0:
        return f'{percent(lowest / threshold)} of the limit'
    score = 'none' if math.isnan(lowest) else f'{lowest:.4g}'
    return f'lowest score {score}' + ('' if threshold is None else f', threshold {threshold:.4g}')


def first_of(names: Sequence[str], most: int, joint: str = ' ') -> str:
    """Return names, of many the first ones: '/a, /b and 3 more', with a joint before the `and`."""
    more = len(names) - most
    return ', '.join(names[:most]) + (f'{joint}and {more} more' if more > 0 else '')


def first_lines(lines: Sequence[str], most: int, others: str = '', indent: str = '') -> List[str]:
    """Return lines, of many the first ones, and one that says how many more there are."""
    more = len(lines) - most
    return [*lines[:most], *([f'{indent}and {more} more{others}'] if more > 0 else [])]


def cell(text: str) -> str:
    """Return a text that a spreadsheet shows and does not compute: a bag may be called `=1+1`."""
    return f"'{text}" if text.startswith(_FORMULA) else text


def aligned(rows: Sequence[Sequence[str]]) -> List[str]:
    """Return a line for each row, its cells in columns; all rows have as many, there is one."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    return ['  '.join(text.ljust(width) for text, width in zip(row, widths)).rstrip()
            for row in rows]
