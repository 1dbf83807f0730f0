"""`rosrun self_awareness train`: learns a model from bags of normal operation."""
from __future__ import annotations

import argparse
import os
from typing import Dict, List, Optional, Sequence, Tuple

from self_awareness import (FEWEST_GAPS, BagSummary, DetectorParameters, EncodingRules,
                            ModelFileError, Recording, TrainedModel, Training, encoding_file,
                            evidence_limits, live_graph, progress, recordings, summarise_bag)
from self_awareness.commands import cli
from self_awareness.output_files import check_outputs
from self_awareness.recordings import BagPart
from self_awareness.stamps import SECOND_NS


_EPILOG = """\
The recordings should show all that is normal, start-up aside: leave it out with --start.
examples:
  train monday.bag tuesday.bag -o robot.model
  train run.bag --start 20 -o robot.model      from 20 s after the recording's first message on
"""


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program; return its exit code (see cli.run)."""
    return cli.run(_parser(), _train, argv)


def _train(arguments: argparse.Namespace) -> None:
    check_outputs([arguments.output], arguments.bags + [arguments.encoding])
    _check_replaces_model(arguments.output)
    horizon_bins = _horizon_bins(arguments.horizon, arguments.bin)
    summaries = [summarise_bag(path) for path in progress.each(arguments.bags, 'indexes')]
    _check_distinct(summaries)
    rules = _rules(arguments.encoding, summaries)
    training = Training(rules, arguments.bin, arguments.window, horizon_bins)
    alone = len(arguments.bags) == 1
    for path in arguments.bags:
        recording = _add(training, path, arguments.start, arguments.end, alone)
        seconds = (recording.end - recording.start) / SECOND_NS
        print(f'{path}: {seconds:.1f} s, {recording.events} events')
    model = training.model()
    if arguments.graph:
        model.graph = live_graph.fetch()
    limits = _cross_fit(model, arguments)
    model.save(arguments.output)
    _print_summary(model)
    print(limits)
    print(f'written: {arguments.output}; next, find limits on recordings that it was not trained '
          'on (rosrun self_awareness calibrate)')


def _cross_fit(model: TrainedModel, arguments: argparse.Namespace) -> str:
    """Give the model preliminary limits where there is enough to find them; say how."""
    parts = [BagPart(path, arguments.start, arguments.end) for path in arguments.bags]

    try:
        model.evidence_calibration = evidence_limits.cross_fit(
            model, lambda: (recordings.read(model, part) for part in parts),
            DetectorParameters().settle_time, evidence_limits.BUDGET)
    except ValueError as error:
        return f'limits       none: {error}'
    return ('limits       preliminary, by what one half of the training says of the other '
            f'({model.evidence_calibration.windows} windows)')


def _add(training: Training, path: str, start: Optional[float], end: Optional[float],
         alone: bool) -> Recording:
    with progress.messages(os.path.basename(path)) as update:
        try:
            recording = training.add_bag(path, start, end, alone, update)
        except ValueError as error:
            raise ValueError(f'{path}: {error}') from error
    if recording.events == 0:
        raise ValueError(f'{path}: no message is an event by the encoding; a recording of "rosbag '
                         'play" needs "source: none" (--encoding), and a part that is too short '
                         'another --start or --end')
    if recording.events == 1:
        raise ValueError(f'{path}: one event only, there is no delay to learn; leave it out or '
                         'record for longer')
    return recording


def _rules(encoding: Optional[str], summaries: Sequence[BagSummary]) -> EncodingRules:
    """Return the encoding of a file, or the defaults where the bags name no senders: without."""
    rules = EncodingRules.defaults() if encoding is None else encoding_file.load(encoding)
    nameless = [summary.path for summary in summaries if not summary.has_sources]
    if rules.source == 'none' or not nameless:
        return rules
    if encoding is None and len(nameless) == len(summaries):
        print('no bag names the senders of its messages: sources are not told apart '
              '(source: none)')
        rules.source = 'none'
        return rules
    raise ValueError(f'{nameless[0]}: no connection of this bag names its sender, and sources are '
                     'to be told apart; leave the bag out, or use "source: none" for all '
                     '(--encoding)')


def _check_distinct(summaries: Sequence[BagSummary]) -> None:
    paths: Dict[int, str] = {}
    for summary in summaries:
        if summary.fingerprint in paths:
            raise ValueError(f'{summary.path}: the same recording as '
                             f'{paths[summary.fingerprint]}; name it once')
        paths[summary.fingerprint] = summary.path


def _check_replaces_model(path: str) -> None:
    """Check that no recording is lost where somebody mixed up the arguments."""
    if not os.path.exists(path):
        return
    try:
        TrainedModel.load(path)
    except ModelFileError as error:
        raise ValueError(f'{path}: is there already, and no model that could be replaced; remove '
                         'it or choose another name') from error


def _horizon_bins(horizon: int, bin_size: int) -> int:
    if horizon % bin_size:
        raise ValueError(f'--horizon {horizon / SECOND_NS:g} is no multiple of the bin size '
                         f'{bin_size / SECOND_NS:g}; choose one')
    return horizon // bin_size


def _print_summary(model: TrainedModel) -> None:
    types = model.event_types
    seconds = sum(recording.end - recording.start for recording in model.recordings) / SECOND_NS
    sources = {event_type.source for event_type in types} - {''}
    print(f'recordings   {len(model.recordings)}')
    print(f'duration     {seconds:.1f} s')
    print(f'events       {model.events}')
    print(f'event types  {len(types)}')
    print(f'sources      {len(sources) if sources else "not told apart"}')
    print(f'pairs        {model.pairs} of {len(types) ** 2} with delays')
    rare = _too_rare(model)
    print(f'too rare to judge (fewer than {FEWEST_GAPS} gaps between two of a kind)  {len(rare)}')
    for name, gaps in rare:
        print(f'  {name}: {gaps} {"gap" if gaps == 1 else "gaps"}')


def _too_rare(model: TrainedModel) -> List[Tuple[str, int]]:
    gaps = [sum(model.histogram(i, i).values()) for i in range(len(model.event_types))]
    return [(str(event_type), count) for event_type, count in zip(model.event_types, gaps)
            if count < FEWEST_GAPS]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog='train', description=__doc__.split(': ', 1)[1], epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('bags', nargs='+', metavar='BAG',
                        help='a recording of normal operation; delays never cross from one to the '
                             'next')
    parser.add_argument('-o', '--output', required=True, metavar='MODEL', help='file to write')
    parser.add_argument('--bin', type=cli.duration, default='0.01', metavar='S',
                        help='size of the bins of delays in s (default: 0.01)')
    parser.add_argument('--window', type=cli.duration, default='0.1', metavar='S',
                        help='length of the windows that are scored, in s (default: 0.1)')
    parser.add_argument('--horizon', type=cli.seconds, default=0, metavar='S',
                        help='delays of this many s or more share one bin (default: no horizon)')
    parser.add_argument('--graph', action='store_true',
                        help='ask the master of the running robot who subscribes to what, and '
                             'keep it: the root of a fault is told from its victims by it')
    parser.add_argument('--encoding', metavar='FILE',
                        help='how messages become events (example: config/encoding.yaml)')
    parser.add_argument('--start', type=cli.offset, metavar='S',
                        help='use each recording from this time on, in s from its first message')
    parser.add_argument('--end', type=cli.offset, metavar='S', help='and up to this one')
    return parser
