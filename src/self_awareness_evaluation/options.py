"""Options that several parts of `evaluate` have, and what their arguments may be."""
from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Iterable, Sequence

from self_awareness.commands import cli
from self_awareness_evaluation.families.protocol import MOST_STARTS


def add_output(parser: argparse.ArgumentParser, written: str) -> None:
    """Add the option that says where results go; written: what they are."""
    parser.add_argument('-o', '--output', type=Path, default=Path('docs/evaluation'),
                        metavar='DIR', help=f'where {written} go (default: docs/evaluation)')


def add_families(parser: argparse.ArgumentParser, names: Iterable[str],
                 default: Sequence[str]) -> None:
    """Add the option that says of which families there are robots."""
    parser.add_argument('--families', nargs='+', choices=list(names), default=default,
                        metavar='FAMILY', help=f'robots of these: {", ".join(names)} '
                        f'(default: {" ".join(default)})')


def add_learning(parser: argparse.ArgumentParser, default: Sequence[int], told: str = '') -> None:
    """Add the options that say what is learned from; told: how starts take turns."""
    parser.add_argument('--starts', type=starts, nargs='+', default=default, metavar='N',
                        help=f'starts to train on, in turn{told}; half as many, but one at least, '
                        f'are calibrated on (default: {" ".join(map(str, default))})')
    for option, what in (('--training', 'train'), ('--calibration', 'calibrate')):
        parser.add_argument(option, type=calibration_s, default=150.0, metavar='S',
                            help=f'length of a recording to {what} on [s] (default: 150)')


def add_jobs(parser: argparse.ArgumentParser, what: str) -> None:
    """Add the option that says how many processes work; what: they do."""
    parser.add_argument('--jobs', type=cli.count, default=os.cpu_count(), metavar='N',
                        help=f'{what} (default: as many as there are cores)')


@cli.checked
def calibration_s(text: str) -> float:
    """Argument type: length of a recording [s]."""
    value = float(text)
    if not 10.0 <= value <= 86400.0:
        raise ValueError(f'expected seconds from 10 to 86400, not {text}')
    return value


@cli.checked
def starts(text: str) -> int:
    """Argument type: starts to train on."""
    value = int(text)
    if not 1 <= value <= MOST_STARTS:
        raise ValueError(f'expected starts from 1 to {MOST_STARTS}, not {text}')
    return value


def _lasting(text: str, unit: str, hour: float) -> float:
    """Return how long something is watched, in units of which an hour has so many."""
    value = float(text)
    if not 0.02 * hour <= value <= 1000.0 * hour:
        raise ValueError(f'expected {unit} from {0.02 * hour:g} to {1000.0 * hour:g}, not {text}')
    return value


@cli.checked
def hours(text: str) -> float:
    """Argument type: how long something is watched [h]."""
    return _lasting(text, 'hours', 1.0)


@cli.checked
def minutes(text: str) -> float:
    """Argument type: how long something is watched [min]."""
    return _lasting(text, 'minutes', 60.0)


@cli.checked
def budget(text: str) -> float:
    """Argument type: false alarms an hour that limits are made for."""
    value = float(text)
    if not 0.001 <= value <= 1000.0:
        raise ValueError(f'expected false alarms an hour from 0.001 to 1000, not {text}')
    return value
