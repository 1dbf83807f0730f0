"""Learns the classes of numeric type fields: a first pass over the bags, for these fields only."""
from __future__ import annotations

import copy
from contextlib import closing
from typing import Dict, List, Sequence, Tuple

import numpy as np

from self_awareness import BagError, EncodingRules, read_numbers
from self_awareness.parts import BagPart
from self_awareness.workers import Workers

_MOST_OF_BAG = 100_000  # values that are kept of a bag: every second, third, ... one of more
_DIGITS = 4  # of a bound, if they are enough


def learned(encoding: EncodingRules, parts: Sequence[BagPart], workers: Workers,
            skip_bad: bool) -> EncodingRules:
    """Return an encoding with bounds of all classes; the same if it has them.

    Each class has about as many of the values as another one; a value that comes very often makes
    them fewer.

    Args:
        parts: recordings of the training.
        workers: who reads them.
        skip_bad: leave out bags that cannot be used: who counts them tells of them.

    Raises:
        ValueError: a bag cannot be used, or is an event log, which holds no values; a field has
            fewer than two values.
    """
    missing = [datatype for datatype, (_, bounds) in encoding.classes.items() if not bounds]
    if not missing:
        return encoding
    wanted = copy.copy(encoding)
    wanted.classes = {datatype: encoding.classes[datatype] for datatype in missing}
    values: Dict[str, List[np.ndarray]] = {datatype: [] for datatype in missing}
    with closing(workers.map(_values, (wanted, skip_bad), parts, 'bags, for classes')) as found:
        for of_part in found:
            for datatype, numbers in of_part.items():
                values[datatype].append(numbers)
    complete = copy.copy(encoding)
    complete.classes = {
        datatype: (number, bounds or _bounds(f'{datatype}: {encoding.type_fields[datatype]}',
                                             number, values[datatype]))
        for datatype, (number, bounds) in encoding.classes.items()}
    return complete


def _values(how: Tuple[EncodingRules, bool], part: BagPart) -> Dict[str, np.ndarray]:
    encoding, skip_bad = how
    if part.recording is not None:
        raise ValueError(f'{part}: an event log holds no values, from which classes are learned; '
                         'train on bags, or leave the classes out')
    try:
        found = read_numbers(part.files, encoding, part.start, part.end)
    except (BagError, ValueError) as error:
        if skip_bad:
            return {}
        raise ValueError(str(error) if isinstance(error, BagError) else f'{part}: {error}'
                         ) from error
    return {datatype: numbers[::max(1, -(-len(numbers) // _MOST_OF_BAG))]
            for datatype, numbers in found.items()}


def _bounds(name: str, number: int, found: Sequence[np.ndarray]) -> List[float]:
    numbers = np.concatenate([np.empty(0), *found])
    numbers = np.sort(numbers[np.isfinite(numbers)])
    if len(numbers) == 0 or numbers[0] == numbers[-1]:
        raise ValueError(f'the type field {name} has no two values in these recordings, and so no '
                         'classes; leave it out')
    ranks = [len(numbers) * place // number for place in range(1, number)]
    # Of a value that comes very often, the next larger one is the bound, if there is none else.
    bounds = {numbers[rank] for rank in ranks if numbers[0] < numbers[rank]} or {
        numbers[np.searchsorted(numbers, numbers[0], 'right')]}
    return sorted({_short(bound, numbers[0], numbers[-1]) for bound in bounds})


def _short(bound: float, least: float, most: float) -> float:
    """Return a bound with few digits, so that its name is short; values lie on both sides."""
    shorter = (float(f'{bound:.{digits}g}') for digits in range(_DIGITS, 18))
    return next(value for value in shorter if least < value <= most)
