"""`rosrun self_awareness convert`: makes a small event log of bags."""
from __future__ import annotations

import argparse
import os
from typing import Optional, Sequence

from self_awareness import (EncodingRules, EventLogWriter, encoding_file, progress,
                            recordings_in_event_log, summarise_bag)
from self_awareness.commands import cli
from self_awareness.output_files import EVENT_LOG, check_outputs, replacing
from self_awareness.recordings import files
from self_awareness.training.robot_graph import RobotGraph, graph_file

_EPILOG = """\
An event log holds when each message came, from whom, and of which type: 4 to 6 bytes a message,
whatever its size. train, calibrate and score read it like the bags, and give the same results.
Each bag is a recording of its own: LOG#1, LOG#2 and so on. Keep the file NAME.graph.yaml, which
record.launch writes, beside the bag: it says who subscribes to what.
example:
  convert /nfs/bags/*.bag -o robot.events.bag
"""


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program; return its exit code (see cli.run)."""
    return cli.run(_parser(), _convert, argv)


def _convert(arguments: argparse.Namespace) -> None:
    bags = [bag for path in arguments.bags for bag in files(path)]
    check_outputs([(arguments.output, EVENT_LOG)], [*bags, arguments.encoding])
    encoding = None if arguments.encoding is None else encoding_file.load(arguments.encoding)
    with replacing(arguments.output) as temporary:
        log = EventLogWriter(temporary, arguments.output)
        for bag in bags:
            _add(log, bag, encoding)
        log.close()
    of_bags = sum(os.path.getsize(bag) for bag in bags)
    size = os.path.getsize(arguments.output)
    print(f'written: {arguments.output}, {size / 1e6:.1f} MB of {of_bags / 1e6:.1f} MB')


def _add(log: EventLogWriter, bag: str, encoding: Optional[EncodingRules]) -> None:
    if recordings_in_event_log(bag) is not None:
        raise ValueError(f'{bag}: is an event log already')
    rules = EncodingRules.defaults() if encoding is None else encoding
    if encoding is None and not summarise_bag(bag).has_sources:
        rules.source = 'none'
        print(f'{bag}: names no senders: sources are not told apart (source: none)')
    path = graph_file(bag)
    graph = RobotGraph.load(path) if os.path.exists(path) else RobotGraph()
    with progress.messages(os.path.basename(bag)) as update:
        try:
            summary = log.add_bag(bag, rules, graph.publishers, graph.subscribers,
                                  graph.hosts, update)
        except ValueError as error:
            raise ValueError(f'{bag}: {error}') from error
    print(f'{bag}: {summary.messages} messages')


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog='convert', description=__doc__.split(': ', 1)[1], epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('bags', nargs='+', metavar='BAG',
                        help='a recording, or a folder of bags')
    parser.add_argument('-o', '--output', required=True, metavar='LOG', help='file to write')
    parser.add_argument('--encoding', metavar='FILE',
                        help='how messages become events (example: config/encoding.yaml)')
    return parser
