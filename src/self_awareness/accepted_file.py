"""What operators have accepted as normal (docs/live.md), in the file beside a model."""
from __future__ import annotations

import os
from typing import List, Sequence, Tuple

from self_awareness import Acceptance, TrainedModel, read_accepted, write_accepted

_MOST = 1000
_NOT_SUBSCRIBED = 'not subscribed'


def path_of(model: str) -> str:
    """Return the path of the file that belongs to a model."""
    return f'{model}.accepted'


def beside(model: str) -> List[Acceptance]:
    """Return what is accepted beside a model; nothing where there is no file.

    Raises:
        BagError: the file is damaged, or another one.
    """
    return read_accepted(path_of(model)) or []


def in_words(accepted: Acceptance) -> str:
    """Return what is accepted, as the monitor says it."""
    names = [name for name in (accepted.component, accepted.topic) if name]
    what = ' '.join(accepted.together) or ' on '.join(dict.fromkeys(names))
    return what + (f' ({accepted.kind})' if accepted.kind else '')


def keep(accepted: Sequence[Acceptance], model: str) -> None:
    """Write what is accepted beside a model. Where it is nothing, no new file is made.

    Raises:
        FileError: it cannot be written.
    """
    path = path_of(model)
    if (accepted or os.path.exists(path)) and (read_accepted(path) or []) != list(accepted):
        write_accepted(list(accepted), path)


def of_either(source: str, output: str) -> List[Acceptance]:
    """Return what is accepted beside a model and beside the file that takes its place.

    Of the same component, topic and kind, it is what is beside the output.

    Raises:
        BagError: one of the files is damaged, or another one.
        ValueError: together they are too many.
    """
    kept = beside(output)
    if os.path.realpath(source) != os.path.realpath(output):
        kept += [each for each in beside(source)
                 if not any(_key(each) == _key(other) for other in kept)]
    if len(kept) > _MOST:
        raise ValueError(f'{len(kept)} are accepted beside {source} and {output} together, and '
                         f'{_MOST} is the most: take some back (~accept, undo)')
    return kept


def learned(accepted: Sequence[Acceptance],
            model: TrainedModel) -> Tuple[List[Acceptance], List[Acceptance]]:
    """Divide what is accepted into what a model has learned, and what is accepted on.

    It is learned where the model knows an event type that it names from a recording that ended
    after it was accepted; that somebody does not subscribe, where he is so known, and the model
    does not expect it; a mode, where it is so of all who are off. A pattern names others, too,
    that may yet come: it stays.
    """
    known: List[Acceptance] = []
    left: List[Acceptance] = []
    for each in accepted:
        is_pattern = any('*' in name for name in (each.component, each.topic))
        (left if is_pattern or not _is_learned(each, model) else known).append(each)
    return known, left


def keep_what_is_left(accepted: Sequence[Acceptance], model: TrainedModel, path: str) -> List[str]:
    """Write beside a model what it has not learned; return what became of each, in words.

    Raises:
        FileError: it cannot be written.
    """
    known, left = learned(accepted, model)
    keep(left, path)
    return [*(f'accepted before, and learned now, so it is judged again: {in_words(each)}'
              for each in known),
            *(f'accepted, and not learned: {in_words(each)}' for each in left)]


def _is_learned(accepted: Acceptance, model: TrainedModel) -> bool:
    if accepted.together:
        return all(_is_learned(Acceptance(each, at=accepted.at), model)
                   for each in accepted.together)
    named = accepted
    if accepted.kind == _NOT_SUBSCRIBED:
        if any(accepted.component in ('', node) and accepted.topic in ('', topic)
               for node, topic in model.subscriptions):
            return False
        named = Acceptance(accepted.component)  # the topic is none that it sends
    return any(end >= accepted.at and any(map(named.is_about, event_types))
               for _, _, end, event_types in model.heard_in)


def _key(accepted: Acceptance) -> Tuple[str, ...]:
    return accepted.component, accepted.topic, accepted.kind, *accepted.together
