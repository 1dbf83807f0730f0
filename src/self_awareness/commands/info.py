"""`rosrun self_awareness info`: shows what is in a model, an event log or a folder."""
from __future__ import annotations

import argparse
import os
from typing import Any, Callable, Dict, Iterator

from self_awareness import ModelFileError, ResultBag, TrainedModel, recordings_in_event_log
from self_awareness.commands import cli
from self_awareness.learning.age import age_of, logs_of
from self_awareness.parts import BagPart, look
from self_awareness.recordings import is_bag
from self_awareness.reporting import (age_text, model_text, rates_text, recordings_text,
                                      verdict)
from self_awareness.reporting.file_summary import (describe_version, summarise_event_log,
                                                   summarise_results)
from self_awareness.reporting.model_text import summarise, tuning_lines
from self_awareness.reporting.text import duration, number_of, or_dash
from self_awareness.stamps import moment, span


def _info(arguments: argparse.Namespace) -> None:
    show = _what(arguments)
    if arguments.tuning and show is not _model:
        raise ValueError('--tuning: is for one model alone, without --age and --model')
    show(arguments)


def _what(arguments: argparse.Namespace) -> Callable[[argparse.Namespace], None]:
    """Return what shows that which is named."""
    if arguments.age is not None:
        return _age
    if arguments.usual is not None:
        return _rates
    first = BagPart.parse(arguments.model)
    if arguments.more or os.path.isdir(first.path) or first.last is not None:
        return _recordings
    if recordings_in_event_log(arguments.model) is not None:
        return _log
    return _results if ResultBag.is_one(arguments.model) else _model


def _model(arguments: argparse.Namespace) -> None:
    model = _load(arguments.model)
    if arguments.tuning:
        cli.print_lines(tuning_lines(model.tuning))
    elif arguments.json:
        cli.print_values(summarise(model))
    else:
        details = model_text.lines(summarise(model)) if arguments.details else []
        cli.print_lines([*verdict.lines(model), *details,
                         *verdict.next_steps(model, arguments.model)])


def _age(arguments: argparse.Namespace) -> None:
    named = logs_of(arguments.model, arguments.age)
    found = age_of(arguments.model, _load(arguments.model), named, arguments.skip_bad)
    cli.show(arguments.json, age_text.summarise(found),
             [*named.told, *age_text.lines(found, arguments.details)])
    cli.say_skipped('info', named.bad)


def _rates(arguments: argparse.Namespace) -> None:
    trained = TrainedModel.load(arguments.usual)
    named = look(map(BagPart.parse, [arguments.model, *arguments.more]))
    found = list(named.each(lambda part: rates_text.summarise(
        trained, cli.read_recording('info', trained, part))))
    cli.show(arguments.json, {'recordings': found, 'skipped': named.bad},
             [*named.told, *(line for each in found for line in rates_text.lines(each))])
    cli.end_with('info', named, arguments.skip_bad)


def _recordings(arguments: argparse.Namespace) -> None:
    named = look(map(BagPart.parse, [arguments.model, *arguments.more]))
    summary = recordings_text.summarise(named)
    cli.show(arguments.json, summary, [*named.told, *recordings_text.lines(summary)])
    cli.end_with('info', named, arguments.skip_bad)


def _log(arguments: argparse.Namespace) -> None:
    summary = summarise_event_log(arguments.model)
    cli.show(arguments.json, summary, _lines_of_log(summary, arguments.details))


def _results(arguments: argparse.Namespace) -> None:
    summary = summarise_results(arguments.model)
    cli.show(arguments.json, summary, [
        f'result bag   {summary["size"] / 1e6:.1f} MB, {summary["messages"]} messages',
        f'written by   {describe_version(summary["version"])}',
        f'results      {span(summary["start_ns"], summary["end_ns"])}'])


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


def _lines_of_log(summary: Dict[str, Any], details: bool) -> Iterator[str]:
    nodes = {kind['source'] for kind in summary['event_types']} - {''}
    recordings = summary['recordings']
    dropped = sum(recording['dropped'] for recording in recordings)
    yield (f'event log    {number_of(len(recordings), "recording")}, '
           f'{duration(summary["duration"])}, nodes: {len(nodes) or "not known"}'
           + (f', starts of the robot: {summary["starts"]}' if summary['starts'] else '')
           + (f'; {dropped} messages were dropped' if dropped else ''))
    if not details:
        return
    yield f'written by   {describe_version(summary["version"])}'
    for number, recording in enumerate(recordings, 1):
        start = recording['robot_start_ns']
        yield (f'    #{number} {model_text.recording(recording)}'
               + ('' if start is None else f', robot started {moment(start)}')
               + (f', {recording["dropped"]} messages were dropped' if recording['dropped']
                  else ''))
    encodings = [recording['encoding'] for recording in recordings]
    for index, encoding in enumerate(encodings):
        if encoding not in encodings[:index]:
            yield from model_text.encoding(encoding)
    yield f'size         {summary["size"] / 1e6:.1f} MB'
    yield f'events       {summary["events"]}'
    yield f'event types  {len(summary["event_types"])}'
    yield '     count  rate [Hz]'
    for kind in summary['event_types']:
        yield (f'  {kind["count"]:8d} {or_dash(kind["rate"]):>10}  {kind["source"] or "-"} '
               f'{kind["scope"]} {kind["type"]}')
    yield f'graph        {model_text.graph(summary)}'


def _arguments(parser: argparse.ArgumentParser) -> None:
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


main = cli.Program('info', __doc__, '', _arguments, _info)
