"""What operators have accepted as normal (docs/accept.md), in the file beside a model."""
from __future__ import annotations

import os
from typing import List, Sequence, Tuple

from self_awareness import Acceptance, TrainedModel, read_accepted, write_accepted

_BESIDE = '.accepted'


def path_of(model: str) -> str:
    """Return the path of the file that belongs to a model."""
    return model + _BESIDE


def beside(model: str) -> List[Acceptance]:
    """Return what is accepted beside a model; nothing where there is no file.

    Raises:
        BagError: the file is damaged, or another one.
    """
    return read_accepted(path_of(model)) or []


def in_words(accepted: Acceptance) -> str:
    """Return what is accepted, as the monitor says it."""
    names = [name for name in (accepted.component, accepted.topic) if name]
    return ' on '.join(dict.fromkeys(names)) + (f' ({accepted.kind})' if accepted.kind else '')


def keep(accepted: Sequence[Acceptance], model: str) -> None:
    """Write what is accepted beside a model. Where it is nothing, no new file is made.

    Raises:
        FileError: it cannot be written.
    """
    path = path_of(model)
    if (accepted or os.path.exists(path)) and (read_accepted(path) or []) != list(accepted):
        write_accepted(list(accepted), path)


def learned(accepted: Sequence[Acceptance],
            model: TrainedModel) -> Tuple[List[Acceptance], List[Acceptance]]:
    """Divide what is accepted into what a model has learned, and what is accepted on.

    It is learned where the model knows an event type that it names, from a recording that ended
    after it was accepted. A pattern names others, too, that may yet come: it stays.
    """
    known: List[Acceptance] = []
    left: List[Acceptance] = []
    last = max((recording.end for recording in model.recordings), default=0)
    for each in accepted:
        heard = any(each.is_about(event_type) for event_type in model.event_types)
        is_pattern = any('*' in name for name in (each.component, each.topic))
        (known if heard and last >= each.at and not is_pattern else left).append(each)
    return known, left
