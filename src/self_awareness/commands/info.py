"""`rosrun self_awareness info`: shows what is in a model, an event log or a folder."""
from __future__ import annotations

import argparse
import os
from typing import Any, Dict, Optional, Sequence

from self_awareness import ModelFileError, ResultBag, TrainedModel, recordings_in_event_log
from self_awareness.commands import cli
from self_awareness.learning.age import age_of, logs_of
from self_awareness.parts import BagPart, look
from self_awareness.recordings import is_bag
from self_awareness.reporting import (age_text, model_text, rates_text, recordings_text,
                                      verdict)
from self_awareness.reporting.file_summary import (describe_version, summarise_event_log,
                                                   summarise_results)
from self_awareness.reporting.model_summary import summarise, tuning_lines
from self_awareness.reporting.text import duration, number_of, or_dash
from self_awareness.stamps import moment, span


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program; return its exit code (see cli.run)."""
    return cli.run(_parser(), _info, argv)


def _info(arguments: argparse.Namespace) -> None:
    if arguments.age is not None:
        _info_of_age(arguments)
        return
    if arguments.usual is not None:
        _info_of_rates(arguments)
        return
    first = BagPart.parse(arguments.model)
    if arguments.more or os.path.isdir(first.path) or first.last is not None:
        _info_of_recordings(arguments)
        return
    recordings = recordings_in_event_log(arguments.model)
    if recordings is not None:
        _info_of_log(arguments, recordings)
        return
    if ResultBag.is_one(arguments.model):
        _info_of_results(arguments)
        return
    model = _load(arguments.model)
    if arguments.tuning:
        cli.print_lines(tuning_lines(model.tuning))
    elif arguments.json:
        cli.print_values(summarise(model))
    else:
        details = model_text.lines(summarise(model)) if arguments.details else []
        cli.print_lines([*verdict.lines(model), *details,
                         *verdict.next_steps(model, arguments.model)])


def _info_of_age(arguments: argparse.Namespace) -> None:
    _refuse(arguments, 'says nothing of an age (--age)')
    named = logs_of(arguments.model, arguments.age)
    found = age_of(arguments.model, _load(arguments.model), named, arguments.skip_bad)
    if arguments.json:
        cli.print_values(age_text.summarise(found))
    else:
        cli.print_lines([*named.told, *age_text.lines(found, arguments.details)])
    cli.say_skipped('info', named.bad)


def _info_of_rates(arguments: argparse.Namespace) -> None:
    _refuse(arguments, 'says nothing of rates (--model)')
    trained = TrainedModel.load(arguments.usual)
    named = look(map(BagPart.parse, [arguments.model, *arguments.more]))
    found = list(named.each(lambda part: rates_text.summarise(
        trained, cli.read_recording('info', trained, part))))
    if arguments.json:
        cli.print_values({'recordings': found, 'skipped': named.bad})
    else:
        cli.print_lines(named.told)
        for each in found:
            cli.print_lines(rates_text.lines(each))
    cli.end_with('info', named, arguments.skip_bad)


def _info_of_recordings(arguments: argparse.Namespace) -> None:
    _refuse(arguments, 'is for one model, not for recordings')
    named = look(map(BagPart.parse, [arguments.model, *arguments.more]))
    summary = recordings_text.summarise(named)
    if arguments.json:
        cli.print_values(summary)
    else:
        cli.print_lines([*named.told, *recordings_text.lines(summary)])
    cli.end_with('info', named, arguments.skip_bad)


def _refuse(arguments: argparse.Namespace, why: str) -> None:
    """Refuse the option that is for models alone."""
    if arguments.tuning:
        raise ValueError(f'--tuning: {why}')


def _load(path: str) -> TrainedModel:
    try:
        return TrainedModel.load(path)
    except ModelFileError as error:
        if is_bag(path):
            raise ValueError(f'{path}: a recording, not a model. To see what is in it: rosbag '
                             f"info '{path}'. To see its rates beside the usual ones: rosrun "
                             f"self_awareness info '{path}' --model MODEL. To see when "
                             f"it was abnormal, and why: rosrun self_awareness score "
                             f"'{path}' --model MODEL") from error
        raise


def _info_of_log(arguments: argparse.Namespace, recordings: int) -> None:
    _refuse(arguments, f'is for models, and {arguments.model} is an event log')
    summary = summarise_event_log(arguments.model, recordings)
    if arguments.json:
        cli.print_values(summary)
    else:
        _print_log(summary, arguments.details)


def _info_of_results(arguments: argparse.Namespace) -> None:
    summary = summarise_results(arguments.model)
    if arguments.json:
        cli.print_values(summary)
        return
    print(f'result bag   {summary["size"] / 1e6:.1f} MB, {summary["messages"]} messages')
    print(f'written by   {describe_version(summary["version"])}')
    print(f'results      {span(summary["start_ns"], summary["end_ns"])}')


def _print_log(summary: Dict[str, Any], details: bool) -> None:
    nodes = {kind['source'] for kind in summary['event_types']} - {''}
    recordings = summary['recordings']
    dropped = sum(recording['dropped'] for recording in recordings)
    print(f'event log    {number_of(len(recordings), "recording")}, '
          f'{duration(summary["duration"])}, nodes: {len(nodes) or "not known"}'
          + (f', starts of the robot: {summary["starts"]}' if summary['starts'] else '')
          + (f'; {dropped} messages were dropped' if dropped else ''))
    if not details:
        return
    print(f'written by   {describe_version(summary["version"])}')
    for number, recording in enumerate(recordings, 1):
        start = recording['robot_start_ns']
        print(f'    #{number} {model_text.recording(recording)}'
              + ('' if start is None else f', robot started {moment(start)}')
              + (f', {recording["dropped"]} messages were dropped' if recording['dropped']
                 else ''))
    encodings = [recording['encoding'] for recording in recordings]
    for index, encoding in enumerate(encodings):
        if encoding not in encodings[:index]:
            cli.print_lines(model_text.encoding(encoding))
    print(f'size         {summary["size"] / 1e6:.1f} MB')
    print(f'events       {summary["events"]}')
    print(f'event types  {len(summary["event_types"])}')
    print('     count  rate [Hz]')
    for kind in summary['event_types']:
        print(f'  {kind["count"]:8d} {or_dash(kind["rate"]):>10}  {kind["source"] or "-"} '
              f'{kind["scope"]} {kind["type"]}')
    print(f'graph        {model_text.graph(summary)}')


def _parser() -> argparse.ArgumentParser:
    parser = cli.parser('info', __doc__)
    parser.add_argument('model', metavar='MODEL',
                        help='file written by train or calibrate, an event log, a result bag of '
                             'score, or a folder of recordings')
    parser.add_argument('more', metavar='BAG', nargs='*',
                        help='further recordings: it says which bags are one recording, and '
                             'which cannot be used')
    how = parser.add_mutually_exclusive_group()
    how.add_argument('--json', action='store_true', help='print all but the counts, for programs')
    cli.add_details(how)
    how.add_argument('--tuning', action='store_true',
                     help='print the numbers of the method that the model was trained with')
    other = parser.add_mutually_exclusive_group()
    other.add_argument('--model', dest='usual', metavar='MODEL',
                       help='the others are recordings: how often each topic came in them, beside '
                            'how often it came in the training of this model')
    other.add_argument('--age', nargs='*', metavar='LOG',
                       help='say how far recordings of normal operation since have drifted from '
                            'what the model was learned from (default: those of MODEL.kept)')
    cli.add_skip_bad(parser)
    return parser
