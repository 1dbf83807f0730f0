"""Says by name what nodes published in training that nobody subscribed to: it is not watched."""
from __future__ import annotations

from typing import Iterable, List, Tuple

_MOST_NAMED = 20


def summarise(unheard: Iterable[Tuple[str, str]]) -> List[str]:
    """Return the names of publications, as TrainedModel.unheard has them, in order."""
    return [f'{topic} on {source}' if source else topic
            for source, topic in sorted(unheard, key=lambda each: (each[1], each[0]))]


def lines(names: List[str]) -> List[str]:
    """Return lines below the table of who is watched: a topic in each, and how many more."""
    more = len(names) - _MOST_NAMED
    return [f'{name}: not watched, nobody subscribed in training' for name in names[:_MOST_NAMED]
            ] + ([f'and {more} more topics that nobody subscribed to'] if more > 0 else [])
