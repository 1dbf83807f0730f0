"""The measurements without a master: records, variants and faults by the arguments, to rows."""
from __future__ import annotations

import argparse
import os
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Callable, Iterable, List, Optional, Sequence, Tuple

from self_awareness import Tuning
from self_awareness.calibration.limits import BUDGET
from self_awareness.commands import cli
from self_awareness_evaluation import experiment, options, outages, pages, sections, simulated
from self_awareness_evaluation.experiment import Unit
from self_awareness_evaluation.families.kinds import FAMILIES
from self_awareness_evaluation.families.protocol import (AFTER_DEATH_S, KINDS, MOST_STARTS,
                                                         check_hours, recorded)
from self_awareness_evaluation.pages import FULL, Section
from self_awareness_evaluation.records import OWN, REAL, Learning
from self_awareness_evaluation.records import FAMILIES as OF_FAMILIES
from self_awareness_evaluation.rows import Row
from self_awareness_evaluation.variants import (EVIDENCE, SYSTEMS, Variant, add_changes, change_of,
                                                one_by_one, side_by_side)
from self_awareness_follow_me.faults import effect_of
from self_awareness_follow_me.scenario import load_scenario

_FAULTS = tuple(kind.split()[0] for kind in KINDS)
_OF_FAMILIES = ('evidence', 'evidence_no_graph', 'gaps', 'frequency_learned')
_OF_ABLATION = ('timers', 'wireless', 'jittery', 'wander', 'day_night', 'stalled_loops',
                'driving_docked', 'events_only', 'bursty')
_WARNED_ONLY = ('extra', 'unknown', 'unsubscribed')  # a suspicion, no alarm
_AFTER_DEATH_S = 600.0  # of the ablation, which judges many times

_Work = Callable[[argparse.Namespace, str], None]


def add(parts: Any) -> None:
    parser = parts.add_parser(
        'simulated', help='the simulated follow-me robot, in simulated time',
        description='Every system learns from the same records of the simulated robot, and judges '
        'the same normal operation and the same faults, once for every seed.')
    _add_common(parser, _simulated, 'seeds')
    options.add(parser, '--seeds', cli.count, 20, 'N',
                'number of repetitions, each with the next seed')
    options.add(parser, '--seed', int, 1, 'N', 'the first seed')
    _add_systems(parser, SYSTEMS)
    parser.add_argument('--faults', nargs='+', metavar='FAULT',
                        help='kinds of faults (default: all, and every regular component crashed '
                        'in turn)')

    parser = parts.add_parser(
        'families', help='simulated robots as different as possible, drawn by seed',
        description='Every system learns from few starts of each robot and from many, watches '
        'hours of normal operation in others, and judges every component\'s faults.')
    _add_robots(parser, _families, tuple(FAMILIES), '--robots', 3, 2.0)
    options.add(parser, '--budgets', cli.budget, [BUDGET], 'B', 'false alarms an hour that '
                'limits are made for, in turn; faults are judged with the first')
    _add_systems(parser, _OF_FAMILIES)
    parser.add_argument('--faults', nargs='*', choices=_FAULTS, default=_FAULTS, metavar='FAULT',
                        help=f'kinds of faults: {", ".join(_FAULTS)}; none at all if no name '
                        'follows (default: all)')
    parser.add_argument('--most', type=cli.count, metavar='N', help='faults of every kind, for '
                        'each robot (default: of every component)')

    parser = parts.add_parser(
        'recordings', help='recordings of real robots that others made',
        description='The outages in recordings of real robots, and false alarms on them.')
    _add_common(parser, _recordings, 'recordings')
    parser.add_argument('--data', type=Path, required=True, metavar='DIR',
                        help='the folder of the recordings')
    add_changes(parser)

    parser = parts.add_parser(
        'ablation', help='what each part of the evidence detector buys',
        description='Leaves out channel after channel, switches off rule after rule, halves and '
        'doubles number after number, and judges the same robots and recordings each time.')
    _add_robots(parser, _ablation, _OF_ABLATION, '--seeds', 1, 1.0, ', for one robot after the '
                'other')
    options.add(parser, '--own-seeds', cli.count, 3, 'N', 'records of the own robot, likewise')
    options.add(parser, '--faults', cli.count, 4, 'N', 'faults of every kind, for each of them')
    parser.add_argument('--data', type=Path, metavar='DIR', help='the folder of the recordings of '
                        'real robots (default: without them)')
    parser.add_argument('--channels', nargs='*', metavar='CHANNEL',
                        help='leave out these in turn, none if no name follows: '
                        f'{", ".join(Tuning.channels())} (default: all)')
    parser.add_argument('--numbers', nargs='*', metavar='NAME',
                        help='change these in turn, none if no name follows; `info --tuning` '
                        'lists them (default: all)')


def _add_common(parser: argparse.ArgumentParser, work: _Work, at_a_time: str) -> None:
    parser.set_defaults(work=work)
    options.add_output(parser, 'the sections of the pages, the figures and, in the folder '
                       f'{FULL}, the rows, from which an interrupted run goes on,')
    parser.add_argument('--jobs', type=cli.count, default=os.cpu_count(), metavar='N',
                        help=f'{at_a_time} at a time (default: as many as there are cores)')


def _add_robots(parser: argparse.ArgumentParser, work: _Work, names: Sequence[str], number: str,
                robots_each: int, hours: float, in_turn: str = '') -> None:
    """Add the options of robots of families; number: the option that says how many of each."""
    _add_common(parser, work, 'robots')
    parser.add_argument('--families', nargs='+', choices=list(FAMILIES), default=names,
                        metavar='FAMILY', help=f'robots of these: {", ".join(FAMILIES)} '
                        f'(default: {" ".join(names)})')
    options.add(parser, number, cli.count, robots_each, 'N',
                'robots of each family, each with the next seed')
    options.add(parser, '--seed', cli.count, 1, 'N', 'the first seed')
    options.add(parser, '--starts', partial(cli.count, most=MOST_STARTS), [2, 4], 'N', 'starts to '
                f'train on, in turn{in_turn}; half as many, but one at least, are calibrated on')
    for name, what in (('--training', 'train'), ('--calibration', 'calibrate')):
        options.add(parser, name, options.within(10.0, 86400.0, 'seconds'), 150.0, 'S',
                    f'length of a recording to {what} on [s]')
    options.add(parser, '--hours', options.within(0.02, 1000.0, 'hours'), hours, 'H',
                'normal operation that is watched, for each robot')


def _add_systems(parser: argparse.ArgumentParser, default: Sequence[str]) -> None:
    parser.add_argument('--systems', nargs='+', choices=SYSTEMS, default=default,
                        metavar='SYSTEM', help='evaluate these only, the first one in most '
                        f'tables: {", ".join(SYSTEMS)} (default: {" ".join(default)})')
    add_changes(parser)


def _simulated(arguments: argparse.Namespace, command: str) -> None:
    scenario = load_scenario()
    faults = tuple(arguments.faults or simulated.default_faults(scenario))
    for kind in faults:
        effect_of(scenario, kind)
    seeds = range(arguments.seed, arguments.seed + arguments.seeds)
    units = _own(seeds, faults, _variants(arguments, [simulated.LEARNING]))
    _measure('simulated', units, f'faults {faults}', arguments, command, sections.simulated)


def _families(arguments: argparse.Namespace, command: str) -> None:
    check_hours(arguments.families, arguments.hours)
    faults = tuple(kind for kind in KINDS if kind.split()[0] in arguments.faults)
    amount = arguments.hours, faults, arguments.most, AFTER_DEATH_S
    variants = _variants(arguments, _learnings(arguments), arguments.budgets)
    units = [_robot(family, seed, amount, variants) for family in arguments.families
             for seed in range(arguments.seed, arguments.seed + arguments.robots)]
    _measure('families', units, str(amount), arguments, command, sections.families)


def _recordings(arguments: argparse.Namespace, command: str) -> None:
    variants = side_by_side(list(outages.SYSTEMS), [None], change_of(arguments))
    _measure('recordings', _real(arguments.data, variants), '', arguments, command,
             sections.recordings)


def _ablation(arguments: argparse.Namespace, command: str) -> None:
    variants = one_by_one(arguments.channels, arguments.numbers)
    check_hours(arguments.families, arguments.hours)
    amount = arguments.hours, KINDS, arguments.faults, _AFTER_DEATH_S
    own_faults = tuple(kind for kind in simulated.default_faults(load_scenario())
                       if kind.split(':')[0] not in _WARNED_ONLY)
    units = _own(range(arguments.seed, arguments.seed + arguments.own_seeds), own_faults,
                 _learned(variants, simulated.LEARNING))
    learnings = _learnings(arguments)
    units += [_robot(family, arguments.seed + shift, amount,
                     _learned(variants, learnings[(turn + shift) % len(learnings)]))
              for shift in range(arguments.seeds)
              for turn, family in enumerate(arguments.families)]
    if arguments.data is not None:
        units += _real(arguments.data, variants)
    _measure('ablation', units, f'{amount}, own robot {own_faults}', arguments, command,
             partial(sections.ablation, variants=variants))


def _measure(name: str, units: Sequence[Unit], plan: str, arguments: argparse.Namespace,
             command: str, section: Callable[[Sequence[Row]], Section]) -> None:
    """Measure units, and write what they came to."""
    path = pages.rows_path(arguments.output, name)
    path.parent.mkdir(parents=True, exist_ok=True)
    rows = experiment.run(units, path, plan, arguments.jobs)
    for written in pages.write(arguments.output, section(rows), rows, command):
        print(f'written: {written}')


def _variants(arguments: argparse.Namespace, learnings: Sequence[Learning],
              budgets: Sequence[Optional[float]] = (None,)) -> List[Variant]:
    """Return the systems that the arguments ask for, with what they change of the method."""
    change = change_of(arguments)
    if change and not set(EVIDENCE) & set(arguments.systems):
        raise ValueError(f'--set, --without: they change {" and ".join(EVIDENCE)} only, and none '
                         'of them is evaluated; add one to --systems')
    return side_by_side(arguments.systems, learnings, change, budgets)


def _learned(variants: Sequence[Variant], learning: Learning) -> List[Variant]:
    return [replace(variant, learning=learning) for variant in variants]


def _learnings(arguments: argparse.Namespace) -> List[Learning]:
    return [Learning.of(starts, arguments.training, arguments.calibration)
            for starts in arguments.starts]


def _own(seeds: Iterable[int], faults: Tuple[str, ...], variants: Sequence[Variant]) -> List[Unit]:
    return [Unit(partial(experiment.measure, partial(simulated.own, seed, faults)), OWN,
                 f'{OWN} {seed}', tuple(variants)) for seed in seeds]


def _robot(family: str, seed: int, amount: Tuple[Any, ...], variants: Sequence[Variant]) -> Unit:
    return Unit(partial(experiment.measure, partial(recorded, family, seed, *amount)),
                OF_FAMILIES, f'{family} {seed}', tuple(variants))


def _real(data: Path, variants: Sequence[Variant]) -> List[Unit]:
    outages.check_data(data)
    return [Unit(partial(outages.rows, case, data), REAL, case.name, tuple(variants))
            for case in outages.CASES]
