"""`rosrun self_awareness info`: shows what is in a model, an event log or a folder."""
from __future__ import annotations

import argparse
import os
import shutil
from collections import Counter
from typing import Any, Dict, List, Optional, Sequence

from self_awareness import (EventType, EvidenceModel, ModelFileError, PaperModel, ResultBag,
                            TrainedModel, recordings_in_event_log)
from self_awareness.commands import cli
from self_awareness.judging import EVIDENCE
from self_awareness.learning.age import age_of, logs_of
from self_awareness.parts import BagPart, look
from self_awareness.recordings import is_bag
from self_awareness.reporting import (age_text, coverage_text, delay_bins, rates_text,
                                      recordings_text, relations_text)
from self_awareness.reporting.evidence_report import counts
from self_awareness.reporting.file_summary import (describe_version, summarise_event_log,
                                                   summarise_results)
from self_awareness.reporting.model_summary import summarise, tuning_lines
from self_awareness.reporting.text import rounded
from self_awareness.stamps import moment, span

_LIMITS_OF = {'held-out': 'of recordings that were not trained on',
              'cross-fit': 'preliminary, of the training alone'}


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
    if arguments.pair is not None:
        _print_pair(model, *(_find(model.event_types, text) for text in arguments.pair))
    elif arguments.tuning:
        cli.print_lines(tuning_lines(model.tuning))
    elif arguments.json:
        cli.print_values(summarise(model))
    else:
        _print(summarise(model))


def _info_of_age(arguments: argparse.Namespace) -> None:
    _refuse(arguments, 'says nothing of an age (--age)')
    named = logs_of(arguments.model, arguments.age)
    found = age_of(arguments.model, _load(arguments.model), named, arguments.skip_bad)
    if arguments.json:
        cli.print_values(age_text.summarise(found))
    else:
        cli.print_lines([*named.told, *age_text.lines(found)])
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
    """Refuse the options that are for models alone."""
    for option, given in (('pair', arguments.pair), ('tuning', arguments.tuning)):
        if given:
            raise ValueError(f'--{option}: {why}')


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
        _print_log(summary)


def _info_of_results(arguments: argparse.Namespace) -> None:
    if arguments.pair is not None:
        raise ValueError(f'--pair: is for models, and {arguments.model} is a result bag')
    summary = summarise_results(arguments.model)
    if arguments.json:
        cli.print_values(summary)
        return
    print(f'result bag   {summary["size"] / 1e6:.1f} MB, {summary["messages"]} messages')
    _print_version(summary['version'])
    print(f'results      {span(summary["start_ns"], summary["end_ns"])}')


def _print_version(version: Dict[str, Any]) -> None:
    print(f'written by   {describe_version(version)}')


def _print_log(summary: Dict[str, Any]) -> None:
    print(f'event log    {summary["size"] / 1e6:.1f} MB')
    _print_version(summary['version'])
    print(f'recordings   {len(summary["recordings"])}, {summary["duration"]:.1f} s'
          + (f', starts of the robot: {summary["starts"]}' if summary['starts'] else ''))
    for number, recording in enumerate(summary['recordings'], 1):
        start = recording['robot_start_ns']
        print(f'    #{number} {_recording(recording)}'
              + ('' if start is None else f', robot started {moment(start)}')
              + (f', {recording["dropped"]} messages were dropped' if recording['dropped']
                 else ''))
    encodings = [recording['encoding'] for recording in summary['recordings']]
    for index, encoding in enumerate(encodings):
        if encoding not in encodings[:index]:
            _print_encoding(encoding)
    print(f'events       {summary["events"]}')
    print(f'event types  {len(summary["event_types"])}')
    print('     count  rate [Hz]')
    for kind in summary['event_types']:
        rate = '-' if kind['rate'] is None else rounded(kind['rate'], 3)
        print(f'  {kind["count"]:8d} {rate:>10}  {kind["source"] or "-"} {kind["scope"]} '
              f'{kind["type"]}')
    print(f'graph        {_graph(summary)}')


def _print(summary: Dict[str, Any]) -> None:
    horizon = summary['horizon']
    print(f'trained      {moment(summary["trained_ns"])}')
    _print_version(summary['version'])
    print(f'detector     {summary["detectors"]}')
    print(f'recordings   {len(summary["recordings"])}, {summary["duration"]:.1f} s')
    _print_recordings(summary['recordings'])
    print(f'window       {summary["window"]:g} s')
    print(f'bin size     {summary["bin_size"]:g} s, '
          + ('no horizon' if horizon is None else f'horizon {horizon:g} s'))
    _print_encoding(summary['encoding'])
    sources = summary['sources']
    print(f'sources      {len(sources) if sources else "not told apart"}')
    for source in sources:
        print(f'  {source}')
    print(f'events       {summary["events"]}')
    print(f'event types  {len(summary["event_types"])}{_rates(summary)}')
    print('     count  rate [Hz]  usual delay [s]')
    for kind in summary['event_types']:
        print(f'  {_event_type(kind, summary["fewest_gaps"])}')
    print(f'pairs        {summary["pairs"]} of {len(summary["event_types"]) ** 2} with delays')
    print(f'graph        {_graph(summary)}')
    if summary['evidence'] is not None:
        _print_evidence(summary['evidence'], summary['fewest_gaps'])
    if summary['detectors'] != EVIDENCE:
        _print_calibration(summary['calibration'])


def _print_encoding(encoding: Dict[str, Any]) -> None:
    print('encoding')
    for key, value in encoding.items():
        if key == 'rename':
            value = [f'{pattern} to {name}' for pattern, name in value]
        if isinstance(value, dict):
            value = [f'{datatype}: {field}' for datatype, field in value.items()]
        print(f'  {key:<16}{", ".join(value) if isinstance(value, list) else value}'.rstrip())


def _rates(summary: Dict[str, Any]) -> str:
    if summary['lowest_rate'] is None:
        return ''
    return (f', {rounded(summary["lowest_rate"], 3)} to '
            f'{rounded(summary["highest_rate"], 3)} Hz')


def _event_type(kind: Dict[str, Any], fewest_gaps: int) -> str:
    rate = '-' if kind['rate'] is None else rounded(kind['rate'], 3)
    usual = f'{kind["usual_shortest"]:.3f} - {kind["usual_longest"]:.3f}' if kind['gaps'] else '-'
    rare = '' if kind['judged'] else f'  (too rare to judge: fewer than {fewest_gaps} gaps)'
    return (f'{kind["count"]:8d} {rate:>10}  {usual:<16} '
            f'{kind["source"] or "-"} {kind["scope"]} {kind["type"]}{rare}')


def _graph(summary: Dict[str, Any]) -> str:
    graph = summary['graph']
    if not graph:
        return ('none: roots are told from victims by the training alone (record.launch writes '
                'it down, or train --graph)')
    publishers = {edge['publisher'] for edge in graph}
    silent = sorted({edge['subscriber'] for edge in graph}
                    - {kind['source'] for kind in summary['event_types']})
    nodes = Counter(summary['hosts'].values())
    del nodes['']  # who runs on several
    hosts = ', '.join(f'{host} ({number})' for host, number in sorted(nodes.items()))
    return (f'sources that somebody listens to: {len(publishers)}, connections: {len(graph)}'
            + (f'; hosts and their nodes: {hosts}' if hosts else '')
            + (f'; not watched, since they publish nothing: {", ".join(silent)}'
               if silent else ''))


def _print_evidence(evidence: Dict[str, Any], fewest_gaps: int) -> None:
    print(f'evidence     watches: {counts(evidence["tracks"])}')
    if evidence['not_judged']:
        print(f'  not judged: {"; ".join(evidence["not_judged"])}')
    if evidence['left_out']:
        print(f'  left out: {", ".join(evidence["left_out"])}: this version does not judge them')
    for line in [*coverage_text.unheard_lines(evidence['unheard']),
                 *coverage_text.optional_lines(evidence)]:
        print(f'  {line}')
    calibration = evidence['calibration']
    if calibration is None:
        print('limits       not calibrated (rosrun self_awareness calibrate)')
        return
    print(f'limits       {_LIMITS_OF.get(calibration["method"], calibration["method"])}, for '
          f'{calibration["budget"]:g} false alarms an hour, calibrated '
          f'{moment(calibration["calibrated_ns"])}')
    print(f'  of {counts(calibration["judged_tracks"])}')
    print(f'  {calibration["windows"]} windows; at most '
          f'{_or_none(calibration["false_alarms_per_hour"])} false alarms an hour (95 %)')
    for line in relations_text.lines(calibration['relations']):
        print(f'  {line}')
    print('  normal recordings')
    _print_recordings(calibration['normal'])
    for line in coverage_text.lines(calibration['coverage'], fewest_gaps):
        print(f'  {line}')


def _print_calibration(calibration: Optional[Dict[str, Any]]) -> None:
    if calibration is None:
        print('threshold    not calibrated (rosrun self_awareness calibrate --detector paper)')
        return
    print(f'threshold    {calibration["threshold"]!r} ({calibration["method"]}), calibrated '
          f'{moment(calibration["calibrated_ns"])}')
    print(f'  AUC {_or_none(calibration["auc"])}, TPR '
          f'{_or_none(calibration["true_positive_rate"])} of {calibration["faulty_windows"]} '
          f'abnormal windows, FPR {_or_none(calibration["false_positive_rate"])} of '
          f'{calibration["normal_windows"]} normal windows')
    print(f'  false alarms {_or_none(calibration["false_alarms_per_hour"])} an hour, after '
          'persistence')
    print('  normal recordings')
    _print_recordings(calibration['normal'])
    if calibration['faulty']:
        print('  faulty recordings')
        _print_recordings(calibration['faulty'])
    if calibration['injected']:
        print(f'  injected {", ".join(calibration["injected"])}')


def _print_recordings(recordings: Sequence[Dict[str, Any]]) -> None:
    cli.print_lines(f'    {_recording(recording)}' for recording in recordings)


def _recording(recording: Dict[str, Any]) -> str:
    return (f'{recording["bag"]}: {recording["duration"]:.1f} s, {recording["events"]} events, '
            f'from {moment(recording["start_ns"])}'
            + ('' if recording['robot'] is None else f', of {recording["robot"]}'))


def _or_none(value: Optional[float]) -> str:
    return 'none' if value is None else f'{value:.4g}'


def _print_pair(model: TrainedModel, first: int, second: int) -> None:
    print(f'delay from the last  {model.event_types[first]}')
    print(f'to the current       {model.event_types[second]}')
    if model.detectors == EVIDENCE:
        bins = delay_bins.log_bins(EvidenceModel.of_all_pairs(model).delays(first, second))
    else:
        bins = delay_bins.paper_bins(model, first, second)
        computed = PaperModel(model)
        print(f'count {sum(count for _, _, count in bins)}, entropy '
              f'{computed.entropies[first, second]:.4g} bit, '
              f'weight {computed.weight(first, second):.4g}')
    width = max(10, shutil.get_terminal_size().columns - 40)
    cli.print_lines(delay_bins.drawn(bins, width) if bins
                    else ['no delay was seen in training'])


def _find(event_types: Sequence[EventType], text: str) -> int:
    """Return the index of the event type that the text is, or is a part of.

    Raises:
        ValueError: there is none, or more than one; lists the candidates.
    """
    names = [str(kind) for kind in event_types]
    if text in names:
        return names.index(text)
    found: List[str] = ([name for name in names if text in name]
                        or [name for name in names if _bare(text) in _bare(name)])
    if len(found) == 1:
        return names.index(found[0])
    problem = 'is a part of several event types' if found else 'is no event type of the model'
    raise ValueError(f"--pair: '{text}' {problem}; name one of: {'; '.join(found or names)}")


def _bare(text: str) -> str:
    """Return names without their first slashes, as people type them."""
    return ' '.join(word.lstrip('/') for word in text.split(' '))


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
    how.add_argument('--tuning', action='store_true',
                     help='print the numbers of the method that the model was trained with')
    how.add_argument('--pair', nargs=2, metavar=('A', 'B'),
                     help="draw the delays from the last A to the current B; event types are "
                          "written 'SOURCE SCOPE TYPE', and a part that only one has is enough")
    other = parser.add_mutually_exclusive_group()
    other.add_argument('--model', dest='usual', metavar='MODEL',
                       help='the others are recordings: how often each topic came in them, beside '
                            'how often it came in the training of this model')
    other.add_argument('--age', nargs='*', metavar='LOG',
                       help='say how far recordings of normal operation since have drifted from '
                            'what the model was learned from (default: those of MODEL.kept)')
    cli.add_skip_bad(parser)
    return parser
