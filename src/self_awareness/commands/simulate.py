"""`rosrun self_awareness simulate`: writes recordings of the simulated follow-me robot to bags."""
from __future__ import annotations

import argparse
from pathlib import Path
from typing import List, Optional, Tuple

from self_awareness import progress
from self_awareness.commands import cli
from self_awareness.training.robot_graph import RobotGraph, graph_file
from self_awareness_follow_me.effects import Change
from self_awareness_follow_me.faults import described, effect_of, in_short
from self_awareness_follow_me.scenario import Scenario, load_scenario
from self_awareness_follow_me.simulation import InducedFault, simulate, start_of

_EPILOG = f"""\
faults:
{described()}

Each seed is another start of the robot, on another day. A file beside each bag says who subscribes
to what, as record.launch writes it down; train reads it.
examples:
  simulate -o normal.bag                     one recording of 100 s
  simulate -o bags --runs 4                  bags/normal_1.bag to bags/normal_4.bag
  simulate -o bags --fault cc1@30 --seed 7   bags/cc1_7.bag, the laser's driver dies after 30 s
  simulate -o bags --fault half:camera       bags/half_camera_1.bag
"""


def _simulate(arguments: argparse.Namespace) -> None:
    scenario = load_scenario(arguments.scenario)
    fault = _fault(arguments.fault, arguments.duration)
    graph = _graph(scenario, fault)
    bags = _bags(arguments.output, arguments.runs, arguments.seed, fault)
    with progress.items(int(arguments.duration) * arguments.runs, 'simulating') as seconds_done:
        for seed, bag in bags:
            bag.parent.mkdir(parents=True, exist_ok=True)
            simulate(bag, arguments.duration, seed, fault, scenario, start_of(seed), seconds_done)
            graph.save(graph_file(str(bag)))
            progress.say(str(bag))


def _graph(scenario: Scenario, fault: Optional[InducedFault]) -> RobotGraph:
    """Return who publishes and subscribes to what, once the fault is there."""
    effect = None if fault is None else effect_of(scenario, fault.kind)
    graph = RobotGraph()
    for normal in scenario.components:
        spec = effect.changed(normal) if isinstance(effect, Change) else normal
        for topics, nodes in ((spec.outputs(), graph.publishers),
                              (spec.inputs(), graph.subscribers)):
            for topic in topics:
                nodes.setdefault(f'/{topic}', set()).add(f'/{spec.name}')
    return graph


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('-o', '--output', type=Path, required=True, metavar='DIR_OR_BAG',
                        help='a name that ends in .bag, or a folder')
    parser.add_argument('--duration', type=cli.above_zero('a length in s'), default=100.0,
                        metavar='S', help='length of a recording in s (default: 100)')
    parser.add_argument('--runs', type=int, default=1, metavar='N',
                        help='number of recordings, each with the next seed (default: 1)')
    parser.add_argument('--seed', type=int, default=1, help='of the first recording (default: 1)')
    parser.add_argument('--fault', metavar='KIND[@S]',
                        help='fault to induce, one of those below, and its onset in s '
                             '(default: in the middle)')
    parser.add_argument('--scenario', type=Path, metavar='FILE',
                        help='the robot (default: config/follow_me.yaml of the package)')


def _fault(text: Optional[str], duration_s: float) -> Optional[InducedFault]:
    """Read KIND or KIND@SECONDS.

    Raises:
        ValueError: an unknown kind, or an onset that is no number or not within the recording.
    """
    if text is None:
        return None
    kind, at, onset = in_short(text).partition('@')
    try:
        fault = InducedFault(kind, float(onset) if at else duration_s / 2.0)
    except ValueError as error:
        raise ValueError(f'--fault {text}: {error}') from error
    if fault.onset_s >= duration_s:
        raise ValueError(f'--fault {text}: the onset lies beyond the {duration_s:g} s '
                         'of the recording')
    return fault


def _bags(output: Path, runs: int, seed: int,
          fault: Optional[InducedFault]) -> List[Tuple[int, Path]]:
    """Return the seeds with their bags.

    Raises:
        ValueError: no runs, or several runs for one bag.
        FileExistsError: a bag is there already; none is overwritten.
    """
    if runs < 1:
        raise ValueError(f'--runs must be at least 1, not {runs}')
    if output.suffix == '.bag':
        if runs > 1:
            raise ValueError(f'--output {output}: {runs} runs need a folder')
        bags = [(seed, output)]
    else:
        label = 'normal' if fault is None else fault.kind.replace(':', '_')
        bags = [(seed + i, output / f'{label}_{seed + i}.bag') for i in range(runs)]
    for _, bag in bags:
        if bag.exists():
            raise FileExistsError(f'{bag} exists already: remove it, or choose another --output '
                                  'or --seed')
    return bags


main = cli.Program('simulate', __doc__, _EPILOG, _arguments, _simulate)
