"""Files that are written whole or not at all."""
from __future__ import annotations

import os
from contextlib import contextmanager
from typing import Callable, Iterator, Optional, Sequence

from self_awareness import ModelFileError, TrainedModel


@contextmanager
def replacing(path: str) -> Iterator[str]:
    """Hand out the name of a temporary file in the same folder, which replaces `path` at the end.

    The temporary name ends like `path`, for writers that choose the format by the extension. If
    the block raises, the temporary file is removed and `path` stays as it was.
    """
    folder, name = os.path.split(path)
    temporary = os.path.join(folder, f'.part{os.getpid()}.{name}')
    try:
        yield temporary
        os.replace(temporary, path)
    except BaseException:
        if os.path.exists(temporary):
            os.remove(temporary)
        raise


def check_replaces_model(path: str) -> None:
    """Check that a file is a model, if it is there (see check_replaces)."""
    check_replaces(path, 'model', _is_model)


def check_replaces(path: str, kind: str, is_one: Callable[[str], bool]) -> None:
    """Check that no recording is lost where somebody mixed up the arguments.

    Args:
        path: a file to be written.
        kind: of file, in words.
        is_one: says whether a file is of this kind.

    Raises:
        ValueError: the file is there, and of another kind.
    """
    if os.path.exists(path) and not is_one(path):
        raise ValueError(f'{path}: is there already, and no {kind} that could be replaced; remove '
                         'it or choose another name')


def _is_model(path: str) -> bool:
    try:
        TrainedModel.load(path, watched_only=True)
    except ModelFileError:
        return False
    return True


def check_outputs(outputs: Sequence[Optional[str]], inputs: Sequence[Optional[str]]) -> None:
    """Check before long work that its results can be written and overwrite nothing that is read.

    Args:
        outputs: files to be written.
        inputs: files to be read. In both, None stands for an option that was not given.

    Raises:
        ValueError: an output has no folder, is a folder, is an input, or is named twice.
    """
    taken = {os.path.realpath(path): 'is an input, too' for path in inputs if path is not None}
    for path in outputs:
        if path is None:
            continue
        real = os.path.realpath(path)
        folder = os.path.dirname(real)
        if real in taken:
            raise ValueError(f'{path}: {taken[real]}; name another file for the result')
        if os.path.isdir(real):
            raise ValueError(f'{path}: is a folder; name a file in it')
        if not os.path.isdir(folder):
            raise ValueError(f'{path}: there is no folder {folder}; create it first')
        if not os.access(folder, os.W_OK):
            raise ValueError(f'{path}: nothing may be written into {folder}')
        taken[real] = 'is named for another result, too'
