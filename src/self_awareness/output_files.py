"""Files that programs write: whole or not at all, and never over a file of another kind."""
from __future__ import annotations

import csv
import itertools
import os
import re
import stat
from contextlib import closing, contextmanager
from dataclasses import dataclass
from typing import Callable, Dict, Hashable, Iterable, Iterator, Optional, Sequence, Tuple

from self_awareness import (FileError, ModelFileError, OutputFile, ResultBag, TrainedModel,
                            recordings_in_event_log, write_problem)

_BEGINNING = 4096  # bytes that say what a file is
_PICTURES = (rb'\x89PNG\r\n\x1a\n', rb'%PDF-', rb'<\?xml[^>]*>\s*<!DOCTYPE svg')


@dataclass(frozen=True)
class Kind:
    """A kind of file: a program replaces files of this kind, and no others."""

    name: str  # in words
    is_one: Callable[[str], bool]  # says whether a file is of this kind


def _is_model(path: str) -> bool:
    try:
        TrainedModel.load(path, watched_only=True)
    except ModelFileError:
        return False
    return True


def _begins(*patterns: bytes) -> Callable[[str], bool]:
    def is_one(path: str) -> bool:
        with open(path, 'rb') as file:
            beginning = file.read(_BEGINNING)
        return any(re.match(pattern, beginning) for pattern in patterns)
    return is_one


MODEL = Kind('model', _is_model)
EVENT_LOG = Kind('event log', lambda path: recordings_in_event_log(path) is not None)
RESULT_BAG = Kind('result bag', ResultBag.is_one)
VALUES = Kind('JSON file', _begins(rb'\s*\{'))
TABLE = Kind('table', _begins(rb'\w+(,\w+)+\r?\n'))
PICTURE = Kind('picture', _begins(*_PICTURES))
PAGE = Kind('page for a browser', _begins(rb'\s*(?i:<!doctype html)'))

Output = Tuple[Optional[str], Kind]
"""A file to be written, and what it will be; None: an option that was not given."""


@contextmanager
def replacing(path: str) -> Iterator[str]:
    """Hand out the name of a temporary file in the same folder, which replaces `path` at the end.

    The temporary name ends like `path`, for writers that choose the format by the extension. If
    the block raises, the temporary file is removed and `path` stays as it was. A symbolic link
    stays one; a device or a pipe is written directly.

    Raises:
        OSError: the file cannot be written; the message names it.
    """
    with closing(OutputFile(path)) as file:
        try:
            yield file.temporary
        except OSError as error:
            # Python names no file where a disk is full, and nobody knows the temporary one.
            if error.errno is None or error.filename not in (None, file.temporary):
                raise
            raise FileError(write_problem(path, error.errno, file.temporary)) from error
        file.complete()


def save_table(path: str, columns: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table, as CSV.

    Raises:
        OSError: the file cannot be written.
    """
    with replacing(path) as temporary, open(temporary, 'w', encoding='utf-8', newline='') as file:
        csv.writer(file, lineterminator='\n').writerows(itertools.chain([columns], rows))


def check_outputs(outputs: Sequence[Output], inputs: Sequence[Optional[str]]) -> None:
    """Check before long work that its results can be written, and that nothing is lost by it.

    Args:
        outputs: files to be written.
        inputs: files to be read, which may not be replaced; None: an option that was not given.

    Raises:
        ValueError: an output has no folder, is a folder, is an input, is named twice, or is there
            already and of another kind.
    """
    taken: Dict[Hashable, str] = {_identity(path): 'is an input, too'
                                  for path in inputs if path is not None}
    for path, kind in outputs:
        if path is None:
            continue
        if os.path.isdir(path):
            raise ValueError(f'{path}: is a folder; name a file in it')
        if _is_written_directly(path):
            _check_stream(path, kind)
            continue
        identity = _identity(path)
        if identity in taken:
            raise ValueError(f'{path}: {taken[identity]}; name another file for the result')
        folder = os.path.dirname(os.path.realpath(path))
        if not os.path.isdir(folder):
            raise ValueError(f'{path}: there is no folder {folder}; create it first')
        if not os.access(folder, os.W_OK):
            raise ValueError(f'{path}: nothing may be written into {folder}')
        _check_replaces(path, kind)
        taken[identity] = 'is named for another result, too'


def _identity(path: str) -> Hashable:
    """Return what two names of one file have in common: links, hard links, other ways to it."""
    try:
        status = os.stat(path)
    except OSError:  # not there yet
        return os.path.realpath(path)
    return status.st_dev, status.st_ino


def _is_written_directly(path: str) -> bool:
    try:
        return not stat.S_ISREG(os.stat(path).st_mode)
    except OSError:
        return False


def _check_stream(path: str, kind: Kind) -> None:
    if kind in (MODEL, EVENT_LOG, RESULT_BAG):
        raise ValueError(f'{path}: is no file; a {kind.name} is written in more than one pass, so '
                         'name a file for it')
    if not os.access(path, os.W_OK):
        raise ValueError(f'{path}: may not be written')


def _check_replaces(path: str, kind: Kind) -> None:
    if not os.path.exists(path):
        return
    if not os.access(path, os.W_OK):
        raise ValueError(f'{path}: is there already, and may not be written')
    if os.path.getsize(path) > 0 and not kind.is_one(path):
        raise ValueError(f'{path}: is there already, and no {kind.name} that could be replaced; '
                         'remove it or choose another name')
