"""`rosrun self_awareness convert`: makes a small event log of bags."""
from __future__ import annotations

import argparse
import os
from typing import Optional

from self_awareness import (BagSummary, EncodingRules, EventLogWriter, encoding_file, progress,
                            summarise_bag)
from self_awareness.commands import cli
from self_awareness.output_files import EVENT_LOG, check_outputs, replacing
from self_awareness.parts import BagPart, look
from self_awareness.training.robot_graph import RobotGraph

_EPILOG = """\
An event log holds when each message came, from whom, and of which type: 4 to 6 bytes a message,
whatever its size. train, calibrate and score read it like the bags, and give the same results.
Each bag is a recording of its own: LOG#1, LOG#2 and so on; the bags that rosbag record --split
made of one recording are one. Keep the file NAME.graph.yaml, which record.launch writes, beside
the bag: it says who subscribes to what.
example:
  convert /nfs/bags/*.bag -o robot.events.bag
"""


def _convert(arguments: argparse.Namespace) -> None:
    named = look(map(BagPart, arguments.bags))
    cli.say_found(named, arguments.skip_bad)
    for part in named.parts:
        if part.recording is not None:
            raise ValueError(f'{part.path}: is an event log already')
    bags = [file for part in named.parts for file in part.files]
    check_outputs([(arguments.output, EVENT_LOG)], [*bags, arguments.encoding])
    encoding = None if arguments.encoding is None else encoding_file.load(arguments.encoding)
    with replacing(arguments.output) as temporary:
        log = EventLogWriter(temporary, arguments.output)
        added = 0
        for part, summary in named.each(lambda part: (part, summarise_bag(part.files))):
            _add(log, part, summary, encoding)
            added += 1
        named.check(arguments.skip_bad and added > 0)
        log.close()
    of_bags = sum(os.path.getsize(bag) for bag in bags)
    size = os.path.getsize(arguments.output)
    cli.say_skipped('convert', named.bad)
    print(f'written: {arguments.output}, {size / 1e6:.1f} MB of {of_bags / 1e6:.1f} MB')


def _add(log: EventLogWriter, part: BagPart, summary: BagSummary,
         encoding: Optional[EncodingRules]) -> None:
    rules = EncodingRules.defaults() if encoding is None else encoding
    if encoding is None and not summary.has_sources:
        rules.source = 'none'
        print(f'{part}: names no senders: sources are not told apart (source: none)')
    graph = RobotGraph.beside(part.files)
    with progress.messages(os.path.basename(part.path)) as update:
        try:
            log.add_bag(part.files, rules, graph.publishers, graph.subscribers, graph.hosts,
                        update)
        except ValueError as error:
            raise ValueError(f'{part}: {error}') from error
    print(f'{part}: {summary.messages} messages')


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('bags', nargs='+', metavar='BAG',
                        help='a recording, or a folder of bags')
    parser.add_argument('-o', '--output', required=True, metavar='LOG', help='file to write')
    parser.add_argument('--encoding', metavar='FILE',
                        help='how messages become events (example: config/encoding.yaml)')
    cli.add_skip_bad(parser)


main = cli.Program('convert', __doc__, _EPILOG, _arguments, _convert)
