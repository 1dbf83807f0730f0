"""self_awareness: learns how a healthy robot talks to itself.

>>> import self_awareness as sa
>>> model = sa.learn(['monday.bag', 'tuesday.bag'])
>>> for alarm in model.judge('crash.bag'):
...     if alarm.level == 'ERROR':
...         print(alarm.kind, alarm.culprit)
silent /laser

docs/library.md tells more. The method is implemented once, in C++; the other names here are its
parts, which the programs (`self_awareness.commands`) are made of.
"""
from typing import TYPE_CHECKING, Any

from self_awareness._core import *  # noqa: F401,F403

if TYPE_CHECKING:
    from self_awareness.library import Alarms, Model, learn, load  # noqa: F401

_LIBRARY = ('Alarms', 'Model', 'learn', 'load')


def __getattr__(name: str) -> Any:
    """Import the library when it is needed: it brings numpy, which many programs do without."""
    if name not in _LIBRARY:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    from self_awareness import library
    return getattr(library, name)
