"""Numbers and channels of the method that an evaluation changes: --set and --without."""
from __future__ import annotations

import argparse
from typing import Tuple

from self_awareness import Tuning
from self_awareness.commands import cli

WITHOUT, BETWEEN = 'without ', '; '

OFF = 'off'  # as a value: the one that switches the rule off

Change = Tuple[str, float]  # name and value of a number


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options that change the method."""
    parser.add_argument('--without', type=_channel, nargs='+', action='extend', default=[],
                        metavar='CHANNEL', help='let evidence judge without these channels: '
                        f'{", ".join(Tuning.channels())}')
    parser.add_argument('--set', type=_change, nargs='+', action='extend', default=[],
                        metavar='NAME=VALUE', help='change these numbers of the evidence method, '
                        f'as `info --tuning` lists them; {OFF} as a value switches a rule off')


def of(arguments: argparse.Namespace) -> str:
    """Return what the arguments of add() change."""
    return BETWEEN.join([*(told(name, value) for name, value in arguments.set),
                         *(f'{WITHOUT}{channel}' for channel in arguments.without)])


def told(name: str, value: float) -> str:
    """Return how a changed number is written."""
    return f'{name}={value:.10g}'


def tuning_of(change: str) -> Tuning:
    """Return the method with a change.

    Args:
        change: `NAME=VALUE` and `without CHANNEL`, several with BETWEEN between; empty: none.
    """
    tuning = Tuning()
    for each in change.split(BETWEEN) if change else []:
        if each.startswith(WITHOUT):
            tuning.leave_out(each[len(WITHOUT):])
        else:
            name, _, value = each.partition('=')
            tuning.set(name, float(value))
    return tuning


@cli.checked
def _channel(text: str) -> str:
    if text not in Tuning.channels():
        raise ValueError(f'{text}: no channel of the method; there are '
                         f'{", ".join(Tuning.channels())}')
    return text


@cli.checked
def _change(text: str) -> Change:
    name, is_one, value = text.partition('=')
    if not is_one:
        raise ValueError(f'expected NAME=VALUE, not {text}')
    tuning = Tuning()
    tuning.get(name)  # says so if there is none of this name
    change = (name, _value(name, value))
    tuning.set(*change)
    return change


def _value(name: str, text: str) -> float:
    if text == OFF:
        off = next(number.off for number in Tuning.numbers() if number.name == name)
        if off is None:
            raise ValueError(f'{name}: no value of it switches a rule off')
        return float(off)
    try:
        return float(text)
    except ValueError:
        raise ValueError(f'{name}: expected a number, not {text!r}') from None
