"""What judges the records: a system, or the method with numbers or channels changed."""
from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from typing import AbstractSet, Callable, Dict, Iterator, List, Optional, Sequence, Tuple

from self_awareness import Tuning, TuningNumber
from self_awareness.calibration import limits
from self_awareness.commands import cli
from self_awareness_evaluation.records import Learning, System
from self_awareness_evaluation.systems import Evidence, FrequencyMonitor, GapMonitor, Paper

EVIDENCE = ('evidence', 'evidence_no_graph')  # with the graph of the robot, and without
_OTHERS: Dict[str, Callable[[], System]] = {
    'paper': Paper, 'gaps': GapMonitor, 'frequency_learned': FrequencyMonitor}

SYSTEMS = (*EVIDENCE, *_OTHERS)  # the names of all systems
_WITHOUT, _BETWEEN = 'without ', '; '
_OFF = 'off'  # as a value: the one that switches the rule off


def add_changes(parser: argparse.ArgumentParser) -> None:
    """Add the options that change the method."""
    parser.add_argument('--without', choices=Tuning.channels(), nargs='+', action='extend',
                        default=[], metavar='CHANNEL', help='let evidence judge without these '
                        f'channels: {", ".join(Tuning.channels())}')
    parser.add_argument('--set', type=_change, nargs='+', action='extend', default=[],
                        metavar='NAME=VALUE', help='change these numbers of the evidence method, '
                        f'as `info --tuning` lists them; {_OFF} as a value switches a rule off')


def change_of(arguments: argparse.Namespace) -> str:
    """Return what the arguments of add_changes() change."""
    return _BETWEEN.join([*arguments.set, *(_WITHOUT + channel for channel in arguments.without)])


def number_set(name: str, value: float) -> str:
    """Return how a changed number is written."""
    return f'{name}={value:.10g}'


def tuning_of(change: str) -> Tuning:
    """Return the method with a change: `NAME=VALUE` or `without CHANNEL`, several with `; `
    between; empty: none."""
    tuning = Tuning()
    for each in change.split(_BETWEEN) if change else []:
        if each.startswith(_WITHOUT):
            tuning.leave_out(each[len(_WITHOUT):])
        else:
            name, _, value = each.partition('=')
            tuning.set(name, float(value))
    return tuning


@cli.checked
def _change(text: str) -> str:
    name, is_one, value = text.partition('=')
    if not is_one:
        raise ValueError(f'expected NAME=VALUE, not {text}')
    tuning = Tuning()
    tuning.get(name)  # says so if there is none of this name
    if value == _OFF:
        off = next(number.off for number in Tuning.numbers() if number.name == name)
        if off is None:
            raise ValueError(f'{name}: no value of it switches a rule off')
        return number_set(name, off)
    try:
        number = float(value)
    except ValueError:
        raise ValueError(f'{name}: expected a number, not {value!r}') from None
    tuning.set(name, number)
    return number_set(name, number)


@dataclass(frozen=True)
class Variant:
    """A system, with what is changed of it."""

    system: str  # one of SYSTEMS
    learning: Optional[Learning] = None  # what it learns from; None: the records say themselves
    change: str = ''  # of the method, as tuning_of() reads it; empty: none
    # False alarms an hour that limits are made for; None: the usual ones, or the system has none.
    budget: Optional[float] = None
    faults: bool = True  # whether it judges records with a fault, too
    is_number: bool = False  # whether a number is halved or doubled, one by one

    def make(self, graph: AbstractSet[Tuple[str, str, str]]) -> System:
        """Return the system, new; graph: of the robot."""
        if self.system in _OTHERS:
            return _OTHERS[self.system]()
        return Evidence(set(graph) if self.system == EVIDENCE[0] else set(),
                        tuning=tuning_of(self.change),
                        budget=limits.BUDGET if self.budget is None else self.budget)


def side_by_side(systems: Sequence[str], learnings: Sequence[Optional[Learning]],
                 change: str = '', budgets: Sequence[Optional[float]] = (None,)
                 ) -> List[Variant]:
    """Return systems as they are, but for one change of the method; learnings and budgets come in
    turn, and faults are judged with the first budget."""
    return [Variant(name, learning, change, budget, budget == budgets[0]) if name in EVIDENCE
            else Variant(name, learning) for learning in learnings for name in systems
            for budget in budgets[:None if name in EVIDENCE else 1]]


def one_by_one(channels: Optional[Sequence[str]] = None, numbers: Optional[Sequence[str]] = None
               ) -> List[Variant]:
    """Return the method as it is, and with one thing changed after the other: channels left out,
    numbers switched off, halved and doubled; None: all of them. Raise ValueError if there is no
    such channel or number."""
    for name in channels or ():
        Tuning().leave_out(name)
    for name in numbers or ():
        Tuning().get(name)
    known = [number for number in Tuning.numbers() if numbers is None or number.name in numbers]
    changes = [f'{_WITHOUT}{name}' for name in
               (Tuning.channels() if channels is None else channels)]
    changes += [number_set(number.name, number.off) for number in known
                if number.off is not None and number.off != number.default]
    method = EVIDENCE[0]
    return [Variant(method), *(Variant(method, change=change) for change in changes),
            *(Variant(method, change=number_set(number.name, value), is_number=True)
              for number in known for value in _values(number))]


def _values(number: TuningNumber) -> Iterator[float]:
    """Yield half of a number and twice that, within its range, unless that is known already. A
    pure number that is whole stays whole: it counts something."""
    default = float(number.default)
    seen = {default, number.off}
    for factor in (0.5, 2.0):
        value = min(max(factor * default, number.least), number.most)
        if not number.unit and default.is_integer():
            value = float(math.floor(value + 0.5))
        if value not in seen:
            seen.add(value)
            yield value
