"""`rosrun self_awareness train`: learns a model from bags of normal operation."""
from __future__ import annotations

import argparse
import os
from contextlib import closing
from dataclasses import replace
from functools import partial
from typing import Callable, Dict, List, Optional, Sequence, Tuple

from self_awareness import (SHORTEST_WINDOW, BagError, EncodingRules, TrainedModel, accepted_file,
                            encoding_file, progress)
from self_awareness.calibration import heads_and_tails, holes
from self_awareness.calibration.heads_and_tails import Silences
from self_awareness.calibration.limits import TooLittleError
from self_awareness.commands import cli
from self_awareness.judging import BOTH, EVIDENCE, PAPER
from self_awareness.output_files import MODEL, check_outputs
from self_awareness.parts import BagPart, by_folder, look
from self_awareness.reporting import model_text, verdict
from self_awareness.stamps import SECOND_NS
from self_awareness.training import many_bags, robot_graph
from self_awareness.training.many_bags import Counting, Trained
from self_awareness.training.robot_graph import RobotGraph
from self_awareness.workers import Cluster, Workers, on_this_machine

_OF_THE_MODEL = ('detector', 'bin', 'window', 'horizon', 'encoding', 'rename')

_EPILOG = """\
Record all that is normal, after several starts of the robot. A recording is used from where all
have come that come all the time, within 30 s; --start leaves out more, or nothing (0).
Name a part of a recording as BAG@START-END, in s from its first message.
The model is the same with any --jobs, and with --scheduler.
examples:
  train monday.bag tuesday.bag -o robot.model
  train run.bag --start 20 -o robot.model      from 20 s after the recording's first message on
  train run.bag@20-600 run.bag@660 -o robot.model
  train --add-to robot.model friday.bag -o robot.model
  train r1/*.bag r2/*.bag --robots-by-folder --rename '/r[0-9]+/(.*)' '/\\1' \\
        -o fleet.model
  train /nfs/bags/*.bag --scheduler 10.0.0.1:8786 --skip-bad -o fleet.model
"""


def _train(arguments: argparse.Namespace) -> None:
    named = look(arguments.bags)
    cli.say_found(named, arguments.skip_bad)
    parts = _parts(arguments, named.parts)
    bags = [file for part in parts for file in part.files]
    check_outputs([(arguments.output, MODEL)], bags + [arguments.encoding])
    base = None if arguments.add_to is None else TrainedModel.load(arguments.add_to)
    # A damaged file is found before hours of work; it is read again at the end.
    accepted_file.of_either(arguments.add_to or arguments.output, arguments.output)
    counting = _counting(arguments, base)
    _check_distinct(parts)
    graph = _live_graph(base) if arguments.graph else RobotGraph()  # first: counting takes long
    if arguments.scheduler:  # the workers of a cluster have working directories of their own
        parts = [replace(part, path=os.path.abspath(part.path),
                         more=tuple(map(os.path.abspath, part.more))) for part in parts]
    with closing(_workers(arguments, len(parts))) as workers:
        trained = many_bags.train(parts, counting, workers, base, arguments.skip_bad,
                                  _say(arguments.details))
        found = holes.find(_silences(trained))
        if found and arguments.leave_out_holes:
            parts = holes.without([each.part for each in trained.trained_on], found)
            base = None if arguments.add_to is None else TrainedModel.load(arguments.add_to)
            trained = many_bags.train(parts, counting, workers, base, arguments.skip_bad)
        model = trained.model
        if counting.encoding is None and model.encoding.source == 'none':
            print('no bag names the senders of its messages: sources are not told apart '
                  '(source: none)')
        graph.add_to(model, model.encoding)
        try:
            if model.detectors != PAPER:
                many_bags.preliminary_limits(trained, workers)
        except TooLittleError as error:
            cli.warn('train', f'no limits: {error}')
        except (BagError, ValueError) as error:  # the counts are not lost
            model.save(arguments.output)
            raise ValueError(f'{error}; {arguments.output} is written, without limits') from error
    accepted = accepted_file.of_either(arguments.add_to or arguments.output, arguments.output)
    model.save(arguments.output)
    cli.print_lines([*trained.numbered,
                     *accepted_file.keep_what_is_left(accepted, model, arguments.output),
                     *verdict.lines(model)])
    if arguments.details:
        cli.print_lines([
            *model_text.lines(model_text.summarise(model)),
            *heads_and_tails.lines(_silences(trained), '--start', '--end')])
    left_out = arguments.leave_out_holes
    for line in holes.lines(found, [] if left_out else model.coverage(),
                            left_out or arguments.details, '--leave-out-holes trains on what came '
                            'before and after it'):
        cli.warn('train', f'left out: {line}' if left_out else line)
    cli.say_skipped('train', named.bad + trained.bad)
    cli.print_lines([f'written: {arguments.output}',
                     *verdict.next_steps(model, arguments.output)])


def _say(details: bool) -> Callable[[str], None]:
    """Return what says how the training goes: if no details are wanted, only what is wrong."""
    def say(line: str) -> None:
        if details or ': warning: ' in line or line.startswith('skipped: '):
            progress.say(line)
    return say


def _silences(trained: Trained) -> List[Tuple[BagPart, Silences]]:
    return [(each.part, each.silences) for each in trained.trained_on]


def _live_graph(base: Optional[TrainedModel]) -> RobotGraph:
    """Return the running robot's graph, whose edges take the place of those that the base has."""
    try:
        graph = robot_graph.fetch()
    except ValueError as error:
        raise ValueError(f'--graph: {error}') from error
    if base is not None:
        base.graph = set()
    return graph


def _counting(arguments: argparse.Namespace, base: Optional[TrainedModel]) -> Counting:
    if base is not None:
        for option in _OF_THE_MODEL:
            if getattr(arguments, option) is not None:
                raise ValueError(f'--{option}: leave it out; with --add-to, it is that of '
                                 f'{arguments.add_to}')
        return Counting.of(base)
    bin_size = Counting.bin_size if arguments.bin is None else arguments.bin
    window = Counting.window if arguments.window is None else arguments.window
    horizon = 0 if arguments.horizon is None else arguments.horizon
    if horizon % bin_size:
        raise ValueError(f'--horizon {horizon / SECOND_NS:g} is not a multiple of the bin size '
                         f'{bin_size / SECOND_NS:g} (--bin); give a multiple')
    encoding = None if arguments.encoding is None else encoding_file.load(arguments.encoding)
    counting = Counting(encoding, bin_size, window, horizon // bin_size,
                        arguments.detector or Counting.detector,
                        rename=tuple(arguments.rename or ()))
    try:
        counting.renamed(EncodingRules()).validate()
    except ValueError as error:
        raise ValueError(f'--rename: {error}') from error
    return counting


def _parts(arguments: argparse.Namespace, named: Sequence[BagPart]) -> List[BagPart]:
    """Return what is named; --start and --end are for bags that are named without a part."""
    parts = [replace(part, start=arguments.start, end=arguments.end)
             if part.start is None else part for part in named]
    return by_folder(parts) if arguments.robots_by_folder else parts


def _workers(arguments: argparse.Namespace, recordings: int) -> Workers:
    if arguments.scheduler is not None:
        return Cluster(arguments.scheduler)
    cores = len(os.sched_getaffinity(0))
    return on_this_machine(min(arguments.jobs or cores, recordings))


def _check_distinct(parts: Sequence[BagPart]) -> None:
    known: Dict[str, List[BagPart]] = {}
    for part in parts:
        for file in part.files:
            others = known.setdefault(os.path.realpath(file), [])
            for other in others:
                if part.meets(other):
                    raise ValueError(f'{part}: the same recording as {other}; name it once')
            others.append(part)


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('bags', type=BagPart.parse, nargs='+', metavar='BAG',
                        help='a recording of normal operation, or a folder of them; delays never '
                             'cross from one to the next')
    parser.add_argument('-o', '--output', required=True, metavar='MODEL', help='file to write')
    parser.add_argument('--graph', action='store_true',
                        help='ask the master of the running robot who subscribes to what: it '
                             'tells the root of a fault from its victims. What record.launch '
                             'writes beside the bags is used without this option, too')
    parser.add_argument('--encoding', metavar='FILE',
                        help='how messages become events (example: config/encoding.yaml)')
    parser.add_argument('--rename', nargs=2, action='append', metavar=('PATTERN', 'NAME'),
                        help='rename the nodes and topics whose whole name matches the regular '
                             'expression, after what the encoding renames; \\1 to \\9 stand for '
                             'its groups. The model remembers it. May be given several times')
    parser.add_argument('--start', type=cli.offset, metavar='S',
                        help='use each recording that is named without a part from this time '
                             'on, in s from its first message (default: from where all have come '
                             f'that come all the time, at most {heads_and_tails.START_UP_S:g})')
    parser.add_argument('--end', type=cli.offset, metavar='S', help='use it up to this time')
    cli.add_robots_by_folder(parser)
    parser.add_argument('--add-to', metavar='MODEL',
                        help='add to what this model learned, in its encoding, bins and windows; '
                             'it may be the file to write. Its calibrations are dropped')
    parser.add_argument('--leave-out-holes', action='store_true',
                        help='leave out the times in which a component is silent for much longer '
                             'than in all other recordings. Only needed where train says that '
                             'such a silence delays finding a death')
    cli.add_skip_bad(parser)
    cli.add_details(parser)
    where = parser.add_argument_group('many bags').add_mutually_exclusive_group()
    where.add_argument('--jobs', type=cli.count, metavar='N',
                       help='processes to work in (default: one for each core, and never more '
                            'than bags)')
    where.add_argument('--scheduler', metavar='ADDRESS',
                       help='work on the cluster of this scheduler of dask.distributed (package '
                            'python3-distributed); its workers must have self_awareness, and find '
                            'the bags under the same names')
    group = cli.for_researchers(parser)
    group.add_argument('--detector', choices=(EVIDENCE, PAPER, BOTH),
                       help='train for this detector; no other one can judge by the model '
                            f'(default: {Counting.detector})')
    group.add_argument('--bin', type=partial(cli.seconds, low=1e-9), metavar='S',
                       help="size of the bins of the paper's delays in s (default: "
                            f'{Counting.bin_size / SECOND_NS:g})')
    group.add_argument('--window', metavar='S',
                       type=partial(cli.seconds, low=SHORTEST_WINDOW / SECOND_NS),
                       help='length of the windows that are scored, in s (default: '
                            f'{Counting.window / SECOND_NS:g})')
    group.add_argument('--horizon', type=cli.seconds, metavar='S',
                       help='delays of this many s or more share one bin (default: no horizon)')


main = cli.Program('train', __doc__, _EPILOG, _arguments, _train)
