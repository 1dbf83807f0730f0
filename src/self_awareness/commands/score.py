"""`rosrun self_awareness score`: finds out afterwards when a recording was abnormal, and why."""
from __future__ import annotations

import argparse
import json
import math
import webbrowser
from dataclasses import asdict
from pathlib import Path
from typing import Iterator, List, Optional, Sequence

from self_awareness import EVIDENCE_THRESHOLD, EvidenceModel, PaperModel
from self_awareness import accepted_file, alarms
from self_awareness.commands import cli
from self_awareness.judging import evidence_judge, load_model, paper_judge
from self_awareness.output_files import (PAGE, PICTURE, RESULT_BAG, TABLE, VALUES, check_outputs,
                                         replacing, save_table)
from self_awareness.parts import BagPart, look
from self_awareness.recordings import in_words, unknown
from self_awareness.reporting import coverage_text
from self_awareness.reporting.plots import save_scores
from self_awareness.reporting.report.incidents import (Incident, as_values, incidents,
                                                       place_of)
from self_awareness.reporting.report.intervals import SUSPICION, intervals
from self_awareness.reporting.report.judged import Judged, JudgedBy
from self_awareness.reporting.report.page import check_installed, save_report
from self_awareness.reporting.report.section import section
from self_awareness.reporting.text import cell, duration, first_lines, number_of, seconds_of
from self_awareness.results import check_apart, result_bag
from self_awareness.stamps import SECOND_NS, span

_COLUMNS = ('bag', 'window_start_ns', 'events', 'unknown', 'score', 'threshold', 'abnormal')
_ROWS = 1 << 16  # of the table that are made at once
_MOST_NAMED = 3  # of an incident
_ALARM = 3  # exit code

_EPILOG = """\
Name a part of a recording as BAG@START-END, in s from its first message. Times that are printed
count from there, too. A suspicion (level WARN) is something abnormal that is too little for an
alarm, or an event that training never saw. All alarms and suspicions of one cause are an incident:
a sentence, its longest alarm and whom that names; --json and --report have all of them. Without an
alarm, it is counted as a suspicion.

The CSV has one row a window. Score and threshold are empty where there is none. abnormal is 1
where the score lies below the threshold, also while settling. A name that a spreadsheet would
compute (=, +, -, @) has a ' before it. With the paper's detector a window without events has no
score and counts as 0.

The result bag has /self_awareness/status, /self_awareness/alarm and /diagnostics, without what the
monitor says of itself. Several recordings go into one bag; they must not overlap in time. It
replaces another result bag, and no other file.

Exit code: 0, or 3 with --fail if there was an alarm; 1 after an error, 2 after wrong usage.
examples:
  score crash.bag --model robot.model --report crash.html
  score crash.bag@20-60 --model robot.model --json crash.json
"""


def _score(arguments: argparse.Namespace) -> int:
    if arguments.open and arguments.report is None:
        raise ValueError('--open: opens the report; name it by --report FILE.html')
    named = look(arguments.bags)
    if not named.parts:
        named.check()
    cli.print_lines(named.told)
    check_outputs([(arguments.csv, TABLE), (arguments.json, VALUES), (arguments.plot, PICTURE),
                   (arguments.report, PAGE), (arguments.result_bag, RESULT_BAG)],
                  [file for part in named.parts for file in part.files] + [arguments.model])
    if arguments.report is not None:
        check_installed(graphs=True)
    check_apart(arguments.result_bag, named.parts)
    parameters = cli.detector_parameters(arguments)
    paper = arguments.detector == 'paper'
    trained = load_model(arguments.model, arguments.detector, watched_only=not paper)
    evidence = None if paper else EvidenceModel(trained)
    if evidence is None:
        judge = paper_judge(trained, PaperModel(trained), trained.threshold, parameters)
        threshold = trained.threshold
    else:
        accepted = accepted_file.beside(arguments.model)
        judge = evidence_judge(trained, parameters, evidence, accepted)
        for each in accepted:
            print(f'{arguments.model}: accepted, so not judged: {accepted_file.in_words(each)}')
        threshold = None if trained.calibration is None else EVIDENCE_THRESHOLD
    if threshold is None and arguments.fail:
        raise ValueError(f'--fail: {arguments.model} is not calibrated, so nothing would ever be '
                         'an alarm (rosrun self_awareness calibrate)')
    if threshold is None:
        print(f'{arguments.model}: not calibrated: windows are scored, none is called abnormal '
              '(rosrun self_awareness calibrate)')
    coverage = [] if paper else trained.coverage()
    missing = coverage_text.not_watched(coverage_text.summarise(coverage))
    if missing:
        print(f'{arguments.model}: {missing}')
    by = JudgedBy(trained, arguments.model, parameters, threshold, evidence, missing)
    judged: List[Judged] = []
    found: List[Incident] = []
    with result_bag(arguments.result_bag, arguments.model, trained,
                    threshold is not None, coverage) as replay:
        for recording in named.each(lambda part: cli.read_recording('score', trained, part)):
            judged.append(Judged(by, recording, judge(recording, replay(recording))))
            found += _print(judged[-1], arguments.details)
        if not judged:
            named.check()
    if threshold is not None:
        seconds = seconds_of(each.recording.recording for each in judged)
        print(f'{number_of(len(judged), "recording")}, {duration(seconds)}: {_counted(found)}')
    if arguments.csv is not None:
        save_table(arguments.csv, _COLUMNS, _rows(judged, threshold))
    if arguments.json is not None:
        _save_json(arguments.json, judged, missing, named.bad)
    if arguments.plot is not None:
        save_scores(arguments.plot, judged)
    if arguments.report is not None:
        save_report(arguments.report, [section(each, f'recording-{number}')
                                       for number, each in enumerate(judged, 1)])
    if arguments.open and not webbrowser.open(Path(arguments.report).resolve().as_uri()):
        cli.warn('score', f'no browser was found here: copy {arguments.report} to where there is '
                 'one, and open it there')
    cli.end_with('score', named, arguments.skip_bad)
    return _ALARM if arguments.fail and any(each.verdicts.alarms for each in judged) else 0


def _print(judged: Judged, details: bool) -> List[Incident]:
    """Print what happened in a recording, a block for each incident; return the incidents."""
    recording = judged.recording
    found = incidents(judged, intervals(judged), 'incident')
    print(f'{recording.part}: {duration(seconds_of([recording.recording]))}, '
          + ('not judged' if judged.by.threshold is None else _counted(found)))
    if recording.steps_of_the_clock:
        print(f'  the clock was set {in_words(recording.steps_of_the_clock)}: the recording is '
              'cut there')
    if details:
        _print_details(judged)
    for incident in found:
        cli.print_lines(_lines(judged, incident, details))
    return found


def _counted(found: Sequence[Incident]) -> str:
    suspicions = sum(each.level == SUSPICION for each in found)
    counted = [number_of(number, what) for number, what in (
        (len(found) - suspicions, 'incident'), (suspicions, 'suspicion')) if number]
    return ', '.join(counted) or 'nothing abnormal'


def _lines(judged: Judged, incident: Incident, details: bool) -> Iterator[str]:
    """Return what happened, the longest alarm of it, and whom that names."""
    place = place_of(judged, incident)
    yield f'  {incident.headline}' + (f' ({place})' if place else '')
    for further in [*([f'{incident.waiting}.'] if incident.waiting else []), *incident.further]:
        yield f'  {further}'
    main = incident.main
    more = len(incident.intervals) - 1
    notes = ', '.join(([] if main.cleared else ['to the end of the recording'])
                      + ([f'and {more} more'] if more else []))
    level = 'suspicion: ' if incident.level == SUSPICION else ''
    yield (f'    {level}{main.start:.1f} - {main.end:.1f} s{notes and f" ({notes})"}, '
           f'{span(main.of.begin, main.of.end)}'
           + (f': {main.reached}, {main.evidence}' if details else ''))
    if main.of.busy is not None and main.of.kind != 'busy machine':
        yield f'    {main.of.busy}'
    named = [f'    {rank}. {suspect.event_type}: {suspect.of.reason.words}'
             for rank, suspect in enumerate(main.suspects, 1)]
    later = [f'    since {suspect.named:.1f} s {suspect.event_type}: '
             f'{suspect.of.reason.words}' for suspect in main.later]
    for lines in (named, later):
        yield from lines if details else first_lines(lines, _MOST_NAMED, indent='    ')


def _print_details(judged: Judged) -> None:
    recording, verdicts = judged.recording, judged.verdicts
    windows = len(verdicts.start)
    line = f'  {len(recording.stamps)} events, {windows} windows'
    if judged.by.threshold is not None:
        abnormal = int((verdicts.abnormal & ~verdicts.settling).sum())
        line += (f', {abnormal} abnormal ({abnormal / windows:.1%}; settling left out), '
                 f'alarms: {len(verdicts.alarms)}, suspicions: {len(verdicts.suspicions)}')
    print(line)
    for said, found in zip(
            ('event types never seen in training',
             'modes never seen in training: they say nothing',
             'event types that nobody subscribed to in training: they are not judged'),
            unknown(judged.by.trained, recording)):
        if found:
            print(f'  {said}:')
        for count, name in found:
            print(f'    {name}: {count}')


def _save_json(path: str, judged: Sequence[Judged], missing: str, bad: Sequence[str]) -> None:
    values = {
        'not_watched': missing or None,
        'skipped': bad,
        'recordings': [{
            'bag': str(each.recording.part),
            'files': [{'file': path, 'begin_s': (start - each.recording.origin) / SECOND_NS}
                      for path, start in each.recording.files],
            'clock_steps': [asdict(step) for step in each.recording.steps_of_the_clock],
            'alarms': [alarms.as_values(alarm, each.recording.event_types, each.recording.origin)
                       for alarm in alarms.in_order(each.verdicts)],
            'incidents': [{**as_values(incident), 'place': place_of(each, incident) or None}
                          for incident in incidents(each, intervals(each), 'incident')],
        } for each in judged],
    }
    with replacing(path) as temporary, open(temporary, 'w', encoding='utf-8') as file:
        json.dump(values, file, indent=2, allow_nan=False)
        file.write('\n')


def _rows(judged: Sequence[Judged], threshold: Optional[float]) -> Iterator[Sequence[object]]:
    limit = '' if threshold is None else repr(threshold)
    for each in judged:
        verdicts = each.verdicts
        part = cell(str(each.recording.part))
        columns = (verdicts.start, verdicts.events, verdicts.unknown, verdicts.score,
                   verdicts.abnormal)
        for begin in range(0, len(verdicts.start), _ROWS):  # lists take much memory
            for start, events, strange, score, abnormal in zip(
                    *(column[begin:begin + _ROWS].tolist() for column in columns)):
                yield (part, start, events, strange, '' if math.isnan(score) else repr(score),
                       limit, int(abnormal))


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('bags', type=BagPart.parse, nargs='+', metavar='BAG',
                        help='a recording, or a folder of bags')
    parser.add_argument('--model', required=True, help='file written by train or calibrate')
    parser.add_argument('--json', metavar='FILE',
                        help='write alarms, suspicions and incidents, for programs')
    parser.add_argument('--plot', type=cli.plot_file, metavar='FILE',
                        help='draw the scores over time; the name ends in .png, .pdf or .svg')
    parser.add_argument('--report', type=cli.page_file, metavar='FILE.html',
                        help='write a page for a browser: who failed, when and why')
    parser.add_argument('--open', action='store_true',
                        help='open the report in a browser')
    parser.add_argument('--fail', action='store_true',
                        help='for scripts: end with exit code 3 if there was an alarm')
    parser.add_argument('--result-bag', metavar='FILE.bag',
                        help='write what the monitor would have published, with the times of the '
                             'recordings')
    cli.add_skip_bad(parser)
    cli.add_unknown(parser)
    cli.add_details(parser)
    group = cli.for_researchers(parser)
    cli.add_detector_argument(group)
    group.add_argument('--csv', metavar='FILE', help='write the score of every window')
    cli.add_settle_time(group)


main = cli.Program('score', __doc__, _EPILOG, _arguments, _score)
