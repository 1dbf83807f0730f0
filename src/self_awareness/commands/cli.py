"""What the command lines have in common: arguments, error messages and exit codes."""
from __future__ import annotations

import argparse
import json
import math
import os
import re
import signal
import sys
from dataclasses import dataclass
from types import FrameType
from typing import Any, Callable, Iterable, List, NoReturn, Optional, Sequence, TypeVar

import rosgraph

from self_awareness import (VERSION, BagError, DetectorParameters, ModelFileError, TrainedModel,
                            UnknownEvents, printable, recordings)
from self_awareness.parts import BadRecordingsError, BagPart, Named
from self_awareness.recordings import RecordingEvents
from self_awareness.stamps import SECOND_NS, nanoseconds

_Value = TypeVar('_Value')

Work = Callable[[argparse.Namespace], Optional[int]]
"""What a program does with its arguments; it may return an exit code."""

_INTERRUPTED = 130
_LONGEST_S = 86400.0
_UNKNOWN = {'ignore': UnknownEvents.IGNORE, 'warn': UnknownEvents.WARN,
            'error': UnknownEvents.ERROR}


class _Parser(argparse.ArgumentParser):
    """A parser that says in one line what is wrong with the arguments."""

    def error(self, message: str) -> NoReturn:
        """End the program."""
        self.exit(2, f'{self.prog}: error: {message} ({self.prog} --help says more)\n')


@dataclass(frozen=True)
class Program:
    """A program: it runs when it is called, with its arguments or those of the command line."""

    name: str
    about: Optional[str]  # docstring of its module: how it is started, a colon, and what it does
    epilog: str  # of its help, whose lines stay as they are
    add_arguments: Callable[[argparse.ArgumentParser], None]
    work: Work
    is_node: bool = False  # under roslaunch, its name and remappings come with the arguments

    def __call__(self, argv: Optional[Sequence[str]] = None) -> int:
        """Run it; return its exit code (see run)."""
        parser = _Parser(
            prog=self.name, description=(self.about or '').split(': ', 1)[1].strip(),
            epilog=self.epilog, formatter_class=argparse.RawDescriptionHelpFormatter)
        self.add_arguments(parser)
        if self.is_node:
            argv = rosgraph.myargv(sys.argv if argv is None else ['', *argv])[1:]
        return run(parser, self.work, argv)


def run(parser: argparse.ArgumentParser, work: Work, argv: Optional[Sequence[str]]) -> int:
    """Parse the arguments, do the work, and turn what goes wrong into one line.

    The parser gets the option --version. Without `argv`, this is the whole program: its
    arguments are those of the command line, and Ctrl-C ends it without a word.

    Returns:
        0 on success, or what the work returns; 1 after an error, 2 after wrong usage, 130 after
        Ctrl-C.
    """
    parser.add_argument('--version', action='version', version=f'self_awareness {VERSION}')
    if argv is not None:
        return _run(parser, work, argv)
    _say_nothing_of_ctrl_c()
    code = _run(parser, work, argv)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # nothing is left to be ended
    return code


def _run(parser: argparse.ArgumentParser, work: Work, argv: Optional[Sequence[str]]) -> int:
    try:
        _check_texts(sys.argv[1:] if argv is None else argv)
        code = work(parser.parse_args(argv))
        sys.stdout.flush()
    except SystemExit as stop:  # after --help or wrong usage, or of the work, with its code
        return int(stop.code or 0)
    except KeyboardInterrupt:
        return _INTERRUPTED
    except BrokenPipeError:  # the reader has seen enough, as `head` has
        _drop_output()
        return 1
    except MemoryError:
        return _fail(parser.prog, 'there is too little memory')
    except BadRecordingsError as error:
        return max(_fail(parser.prog, line) for line in error.lines)
    except (BagError, ModelFileError, ValueError) as error:
        return _fail(parser.prog, str(error))
    except OSError as error:
        file = f'{error.filename}: ' if error.filename else ''
        return _fail(parser.prog, _output_problem() or f'{file}{error.strerror or error}')
    return code or 0


def _say_nothing_of_ctrl_c() -> None:
    """Let Ctrl-C end the program without a word even where an object is destroyed.

    There, Python would print the KeyboardInterrupt, drop it and go on; so it does with what an
    object lacks that was interrupted while it was made.
    """
    came: List[int] = []

    def interrupt(number: int, frame: Optional[FrameType]) -> None:
        came.append(number)
        signal.default_int_handler(number, frame)

    def drop(dropped: sys.UnraisableHookArgs) -> None:
        if not came:
            sys.__unraisablehook__(dropped)
        elif issubclass(dropped.exc_type, KeyboardInterrupt):
            os._exit(_INTERRUPTED)  # as if it were killed: what it writes has a temporary name

    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, interrupt)
        sys.unraisablehook = drop


def _check_texts(argv: Sequence[str]) -> None:
    for argument in argv:
        try:
            argument.encode()
        except UnicodeEncodeError:  # bytes that Python could not decode
            raise ValueError(f'{ascii(argument)}: not in UTF-8; rename the file') from None
        if printable(argument) != argument:
            raise ValueError(f'{ascii(argument)}: has control characters; rename the file')


def _output_problem() -> str:
    """Return why standard output takes no more; empty: it does."""
    try:
        sys.stdout.flush()
    except OSError as error:
        _drop_output()
        return f'standard output: {error.strerror}'
    return ''


def _drop_output() -> None:
    """Let Python's own attempt to write what is left, at the end, not fail again."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def stand_back() -> None:
    """Let the other processes of this machine go first: they may be those of a running robot."""
    os.nice(10)


def warn(program: str, text: str) -> None:
    """Say something on standard error that does not stop the program."""
    print(f'{program}: warning: {text}', file=sys.stderr)


def seconds(text: str, low: float = 0.0) -> int:
    """Argument type: a time in seconds, from `low` to a day, as nanoseconds."""
    value = _number(text)
    if not low <= value <= _LONGEST_S:  # false for NaN as well
        raise argparse.ArgumentTypeError(f'expected seconds from {low:g} to {_LONGEST_S:g}, '
                                         f'not {text!r}')
    return nanoseconds(value)


def offset(text: str) -> float:
    """Argument type: seconds from the beginning of a recording, 0 or more."""
    # A recording may be longer than a day, and the clock of one may have begun at 0.
    if not re.fullmatch(r'\d+(\.\d*)?|\.\d+', text):
        raise argparse.ArgumentTypeError('expected seconds from the recording\'s first message, '
                                         f'not {text!r}')
    return float(text)


def count(text: str, most: int = 10_000) -> int:
    """Argument type: how many of something, 1 or more."""
    if not text.isdecimal() or not 1 <= int(text) <= most:
        raise argparse.ArgumentTypeError(f'expected a number from 1 to {most}, not {text!r}')
    return int(text)


def above_zero(what: str) -> Callable[[str], float]:
    """Return an argument type: a number above 0 of something."""
    def convert(text: str) -> float:
        value = _number(text)
        if not 0.0 < value < math.inf:
            raise argparse.ArgumentTypeError(f'expected {what}, more than 0, not {text!r}')
        return value
    return convert


def _number(text: str) -> float:
    """Return a number; NaN: it is none."""
    try:
        return float(text)
    except ValueError:
        return math.nan


budget = above_zero('false alarms an hour')  # argument type: how many false alarms limits allow


def checked(parse: Callable[[str], _Value]) -> Callable[[str], _Value]:
    """Return an argument type whose ValueErrors reach the user with their text."""
    def convert(text: str) -> _Value:
        try:
            return parse(text)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from error
    return convert


def ends_in(*endings: str) -> Callable[[str], str]:
    """Return an argument type: the name of a file whose ending says what it is."""
    def check(text: str) -> str:
        if not text.lower().endswith(endings):
            raise argparse.ArgumentTypeError(
                f'expected a name that ends in {", ".join(endings)}, not {text!r}')
        return text
    return check


plot_file = ends_in('.png', '.pdf', '.svg')  # argument type: the name of a picture
page_file = ends_in('.html')
"""Argument type: the name of a page; no browser would open another one."""


def add_details(parser: argparse._ActionsContainer) -> None:
    """Add the option that prints more than needs to be known."""
    parser.add_argument('--details', action='store_true', help='print all that is known')


def for_researchers(parser: argparse.ArgumentParser) -> argparse._ArgumentGroup:
    """Return the group of the options that a robot's user does not need."""
    return parser.add_argument_group('for researchers')


def add_detector_argument(parser: argparse._ActionsContainer) -> None:
    """Add the option that says what judges the windows."""
    parser.add_argument('--detector', choices=['evidence', 'paper'], default='evidence',
                        help='evidence: several pieces of evidence, each with its limit; paper: '
                             'the score of Golombek et al. (default: evidence)')


def add_robots_by_folder(parser: argparse.ArgumentParser) -> None:
    """Add the option that says of which robot recordings are."""
    parser.add_argument('--robots-by-folder', action='store_true',
                        help='the recordings are of several robots: one that does not name its '
                             'robot has the name of its folder')


def add_skip_bad(parser: argparse.ArgumentParser) -> None:
    """Add the option that leaves out recordings that cannot be used."""
    parser.add_argument('--skip-bad', action='store_true',
                        help='leave out recordings that cannot be used, and name them; without '
                             'this option, all of them are named and the exit code is 1')


def say_found(named: Named, skip_bad: bool) -> None:
    """Say before the work which bags are one recording, and which ones are skipped.

    Raises:
        BadRecordingsError: one cannot be used and is not to be skipped, or none can.
    """
    named.check(skip_bad)
    print_lines([*named.told, *(f'skipped: {line}' for line in named.bad)])


def print_lines(lines: Iterable[str]) -> None:
    """Print lines of text."""
    for line in lines:
        print(line)


def print_values(values: Any) -> None:
    """Print plain values as JSON."""
    print(json.dumps(values, indent=2, allow_nan=False))


def show(as_json: bool, values: Any, lines: Iterable[str]) -> None:
    """Print plain values as JSON, or else the same in words."""
    if as_json:
        print_values(values)
    else:
        print_lines(lines)


def say_skipped(program: str, bad: Iterable[str]) -> None:
    """Say at the end which recordings were left out."""
    for line in bad:
        warn(program, f'skipped: {line}')


def end_with(program: str, named: Named, skip_bad: bool) -> None:
    """End a program that says something of each recording by itself: name the bad ones.

    Raises:
        BadRecordingsError: there are some, and they are not to be skipped.
    """
    if not skip_bad:
        named.check()
    say_skipped(program, named.bad)


def read_recording(program: str, model: TrainedModel, part: BagPart) -> RecordingEvents:
    """Return the events of a bag, or of a part of it.

    Warns if the clock was set, a copy has lost senders, or the model knows little of it.

    Raises:
        BagError, ValueError: as recordings.read().
    """
    recording = recordings.read(model, part)
    told = (recordings.clock_steps(recording), recordings.merged_senders(model, recording),
            recordings.few_known(model, recording),
            *(f'{reason}; it is left out' for reason in recording.left_out))
    for warning in filter(None, told):
        warn(program, f'{part}: {warning}')
    return recording


def add_unknown(parser: argparse.ArgumentParser) -> None:
    """Add the option that says what becomes of events that training never saw."""
    parser.add_argument('--unknown', choices=sorted(_UNKNOWN), default='warn',
                        help='events never seen in training: nothing, a suspicion, or an alarm at '
                             'once (default: warn)')


def add_settle_time(group: argparse._ActionsContainer) -> None:
    """Add the option that says when a recording is judged."""
    default = DetectorParameters().settle_time
    group.add_argument('--settle-time', type=seconds, default=default, metavar='S',
                       help='no alarm in the first seconds of a recording '
                            f'(default: {default / SECOND_NS:g})')


def detector_parameters(arguments: argparse.Namespace) -> DetectorParameters:
    """Return the parameters of the options that add_settle_time() and add_unknown() added."""
    parameters = DetectorParameters()
    parameters.settle_time = arguments.settle_time
    parameters.unknown = _UNKNOWN[arguments.unknown]
    return parameters


def _fail(program: str, text: str) -> int:
    print(f'{program}: error: {" ".join(text.split())}', file=sys.stderr)
    return 1
