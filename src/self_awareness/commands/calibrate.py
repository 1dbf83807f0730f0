"""`rosrun self_awareness calibrate`: finds the limits, or the threshold, of a model."""
from __future__ import annotations

import argparse
import os
import time
from dataclasses import replace
from statistics import median
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Sequence

from self_awareness import (EVIDENCE_THRESHOLD, Acceptance, DetectorParameters, EvidenceModel,
                            PaperCalibration, PaperModel, Roc, RocPoint, TrainedModel,
                            accepted_file)
from self_awareness.calibration import confidence, heads_and_tails, holes, limits
from self_awareness.calibration.fault_injection import FORMS, InjectedFault, of_known_source
from self_awareness.calibration.runs import (ABNORMAL, LEFT_OUT, NORMAL, RECORDED, FalseAlarms,
                                             FaultResult, Injections, JudgedRun, Run,
                                             check_unseen, false_alarms, fault_results,
                                             injections, judge_runs, labelled, recorded_fault)
from self_awareness.calibration.threshold_rule import ThresholdRule
from self_awareness.commands import cli
from self_awareness.judging import Judge, evidence_judge, load_model, paper_judge
from self_awareness.output_files import MODEL, PICTURE, TABLE, check_outputs, save_table
from self_awareness.parts import BagPart, Named, by_folder, look
from self_awareness.recordings import RecordingEvents
from self_awareness.reporting import coverage_text, evidence_report, verdict
from self_awareness.reporting.plots import save_roc
from self_awareness.reporting.text import cell, duration, rounded
from self_awareness.stamps import SECOND_NS

_COLUMNS = ('bag', 'fault', 'window_start_ns', 'events', 'unknown', 'score', 'label')
_LABELS = {NORMAL: 'normal', ABNORMAL: 'abnormal', LEFT_OUT: ''}

_EPILOG = f"""\
Name a part of a recording as BAG@START-END, in s from its first message.
FAULT is one of {FORMS}.
SOURCE may be *: each source in turn. A fault hits a copy of every normal recording, in its middle,
and only its source. In reality, those who depend on the source would stop, too. Where the machine
was busy, or all was silent, nobody would be to blame: no fault is injected there.
examples:
  calibrate --model robot.model --normal wednesday.bag -o robot.model
  calibrate --model robot.model --normal wednesday.bag --inject 'crash:*' starve -o robot.model
  calibrate --model robot.model --normal wednesday.bag --faulty dead_laser.bag@42 -o robot.model
  calibrate --model robot.model --normal wednesday.bag --detector paper --cutoff fpr=0.001 \\
            -o robot.model
"""


class _Measured(NamedTuple):
    """What the runs say of the chosen threshold."""

    point: RocPoint
    roc: Roc
    normal: List[JudgedRun]
    faulty: List[JudgedRun]
    faults: List[FaultResult]
    false_alarms: FalseAlarms
    by_budget: Dict[float, List[Dict[str, Any]]]
    injected: Injections


def _calibrate(arguments: argparse.Namespace) -> None:
    normal_bags, faulty_bags = _named(arguments)
    bags = [file for part in normal_bags.parts + faulty_bags.parts for file in part.files]
    check_outputs([(arguments.roc, PICTURE), (arguments.csv, TABLE)],
                  bags + [arguments.model, arguments.output])
    check_outputs([(arguments.output, MODEL)], bags)
    if arguments.roc is not None and not (arguments.faulty or arguments.inject):
        raise ValueError('--roc: there is no ROC without faults: name recordings of some '
                         '(--faulty) or let some be made (--inject)')
    parameters = cli.detector_parameters(arguments)
    _check_options(arguments)
    trained = load_model(arguments.model, arguments.detector)
    accepted = accepted_file.of_either(arguments.model, arguments.output)
    goes_elsewhere = os.path.realpath(arguments.model) != os.path.realpath(arguments.output)
    if goes_elsewhere:
        accepted = accepted_file.learned(accepted, trained)[1]
    faults = [of_known_source(fault, trained.event_types) for fault in arguments.inject]

    normal = _read(trained, normal_bags, arguments.skip_bad, lambda part: part)
    faulty = _read(trained, faulty_bags, arguments.skip_bad, BagPart.whole)
    check_unseen(trained, normal + faulty)
    normal_runs = [Run(recording) for recording in normal]
    recorded = [recorded_fault(recording, trained.window) for recording in faulty]

    if arguments.detector == 'evidence':
        measured = _find_limits(arguments, trained, parameters, normal_runs, recorded, faults,
                                accepted)
        cli.print_lines(verdict.lines(trained))
        silences = [(each.part, heads_and_tails.silences(each)) for each in normal]
        found = holes.find(silences, holes.known_silences(trained))
        left = ' '.join(map(str, holes.without([part for part, _ in silences], found)))
        for line in holes.lines(found, trained.coverage(), arguments.details,
                                f'leave it out: --normal {left}'):
            cli.warn('calibrate', line)
        if arguments.details:
            cli.print_lines([
                *heads_and_tails.lines(silences, 'BAG@START', 'BAG@0-END'),
                *coverage_text.lines(measured.by_budget[arguments.budget], trained.fewest_gaps),
                *coverage_text.unheard_lines(coverage_text.unheard(trained.unheard)),
                *evidence_report.budgets(measured.by_budget)])
        cli.print_lines([
            *evidence_report.on_normal(measured.normal, measured.false_alarms, arguments.details),
            *evidence_report.faults(measured.faulty, arguments.details),
            *(evidence_report.not_tried(measured.injected)
              if arguments.details or not measured.faulty else [])])
    else:
        measured = _find_threshold(trained, parameters, arguments.cutoff, normal_runs, recorded,
                                   faults)
        trained.paper_calibration = _calibration(arguments, measured)
        _print(arguments.cutoff, measured)
    if measured.faulty and measured.roc.auc < 0.5:
        cli.warn('calibrate', f'AUC {measured.roc.auc:.3f}: the faults score higher than normal '
                 'operation; this threshold cannot separate them')
    if arguments.csv is not None:
        save_table(arguments.csv, _COLUMNS, _rows(measured.normal + measured.faulty))
    if arguments.roc is not None:
        save_roc(arguments.roc, f'ROC of windows of {trained.window / SECOND_NS:g} s',
                 [(result.fault, result.roc) for result in measured.faults], measured.point)
    trained.save(arguments.output)
    if goes_elsewhere:  # else the file is there
        accepted = accepted_file.of_either(arguments.model, arguments.output)
        cli.print_lines(accepted_file.keep_what_is_left(accepted, trained, arguments.output))
    cli.say_skipped('calibrate', normal_bags.bad + faulty_bags.bad)
    cli.print_lines([f'written: {arguments.output}',
                     *verdict.next_steps(trained, arguments.output)])


def _named(arguments: argparse.Namespace) -> List[Named]:
    """Return the normal and the faulty recordings."""
    normal, faulty = look(arguments.normal), look(arguments.faulty)
    cli.say_found(Named(normal.parts + faulty.parts, normal.bad + faulty.bad,
                        normal.told + faulty.told), arguments.skip_bad)
    if arguments.robots_by_folder:
        normal.parts, faulty.parts = by_folder(normal.parts), by_folder(faulty.parts)
    return [normal, faulty]


def _read(trained: TrainedModel, named: Named, skip_bad: bool,
          what: Callable[[BagPart], BagPart]) -> List[RecordingEvents]:
    """Return the events of what is asked for of each recording, as those of the part named."""
    events = list(named.each(lambda part: replace(
        cli.read_recording('calibrate', trained, what(part)), part=part)))
    named.check(skip_bad and bool(events))
    return events


def _check_options(arguments: argparse.Namespace) -> None:
    if arguments.detector == 'evidence' and arguments.cutoff is not None:
        raise ValueError('--cutoff is for --detector paper; the limits of the evidence follow '
                         'from the false alarms that are allowed (--budget)')
    if arguments.detector == 'paper' and arguments.budget is not None:
        raise ValueError("--budget is for --detector evidence; the threshold of the paper's score "
                         'is chosen by --cutoff')
    if arguments.cutoff is None:
        arguments.cutoff = ThresholdRule('youden')
    if arguments.budget is None:
        arguments.budget = limits.BUDGET


def _find_limits(arguments: argparse.Namespace, trained: TrainedModel,
                 parameters: DetectorParameters, normal_runs: Sequence[Run],
                 recorded: Sequence[Run], faults: Sequence[InjectedFault],
                 accepted: Sequence[Acceptance]) -> _Measured:
    try:
        budgets = [factor * arguments.budget for factor in (0.1, 10.0, 1.0)]
        found = limits.held_out(trained, [run.source for run in normal_runs],
                                parameters.settle_time, budgets)
    except ValueError as error:
        if not EvidenceModel(trained).tracks:
            raise ValueError(f'{arguments.model}: {error}') from error
        raise ValueError(f'--normal: {error}; name longer recordings, or more of them') from error
    by_budget = {}
    for calibration in found:  # the last one stays
        trained.calibration = calibration
        by_budget[calibration.budget] = coverage_text.summarise(trained.coverage())
    judge = evidence_judge(trained, parameters, accepted=accepted)
    return _measure(judge, trained, parameters, normal_runs, recorded, faults,
                    lambda roc: roc.at(EVIDENCE_THRESHOLD))._replace(by_budget=by_budget)


def _find_threshold(trained: TrainedModel, parameters: DetectorParameters, cutoff: ThresholdRule,
                    normal_runs: Sequence[Run], recorded: Sequence[Run],
                    faults: Sequence[InjectedFault]) -> _Measured:
    model = PaperModel(trained)
    # Without a threshold, there are scores only.
    scored = _measure(paper_judge(trained, model, None, parameters), trained, parameters,
                      normal_runs, recorded, faults, cutoff.choose)
    judge = paper_judge(trained, model, scored.point.cutoff, parameters)
    return _measure(judge, trained, parameters, normal_runs,
                    [judged.run for judged in scored.faulty], (), lambda _: scored.point
                    )._replace(roc=scored.roc, injected=scored.injected)


def _measure(judge: Judge, trained: TrainedModel, parameters: DetectorParameters,
             normal_runs: Sequence[Run], recorded: Sequence[Run],
             faults: Sequence[InjectedFault], choose: Callable[[Roc], RocPoint]) -> _Measured:
    """Judge normal operation and faults, and choose a threshold.

    Raises:
        ValueError: there is no window of normal operation, or none of a fault.
    """
    normal = judge_runs(judge, trained.window, normal_runs)
    injected = injections(faults, trained, normal)
    faulty = judge_runs(judge, trained.window, [*recorded, *injected.runs])
    normal_scores = labelled(normal, NORMAL)
    settle_s = f'first {parameters.settle_time / SECOND_NS:g} s (--settle-time)'
    if len(normal_scores) == 0:
        raise ValueError(f'--normal: no window is left after the {settle_s} of the recordings; '
                         'name longer ones')
    for run in faulty:
        if not (run.labels == ABNORMAL).any():
            raise ValueError(f'{run.run.source.part}: no window of the fault is left after the '
                             f'{settle_s} of the recording; name a longer one')
    roc = Roc(normal_scores, labelled(faulty, ABNORMAL))
    point = choose(roc)
    return _Measured(point, roc, normal, faulty,
                     fault_results(normal_scores, faulty, point.cutoff),
                     false_alarms(normal, trained.window), {}, injected)


def _calibration(arguments: argparse.Namespace, measured: _Measured) -> PaperCalibration:
    result = PaperCalibration()
    result.threshold = measured.point.cutoff
    result.method = str(arguments.cutoff)
    result.auc = measured.roc.auc
    result.true_positive_rate = measured.point.true_positive_rate
    result.false_positive_rate = measured.point.false_positive_rate
    result.normal_windows = len(labelled(measured.normal, NORMAL))
    result.faulty_windows = len(labelled(measured.faulty, ABNORMAL))
    result.false_alarms_per_hour = measured.false_alarms.per_hour
    result.normal = [judged.run.source.recording for judged in measured.normal]
    result.faulty = [judged.run.source.recording for judged in measured.faulty
                     if judged.run.fault == RECORDED]
    result.injected = list(dict.fromkeys(
        judged.run.fault for judged in measured.faulty if judged.run.fault != RECORDED))
    result.stamp = int(time.time()) * SECOND_NS
    return result


def _print(cutoff: ThresholdRule, measured: _Measured) -> None:
    windows = len(labelled(measured.normal, NORMAL))
    rate = measured.point.false_positive_rate
    for result in measured.faults:
        print(f'{result.fault}: {result.windows} abnormal windows')
        print(f'  AUC {result.roc.auc:.4f}')
        print(f'  TPR {_share(result.true_positive_rate, result.windows)}')
        print(f'  alarm {_alarms(result)}')
    print(f'normal operation: {windows} windows (recordings: {len(measured.normal)})')
    print(f'  FPR {_share(rate, windows)}, {round(rate * windows)} windows')
    if cutoff.method == 'fpr' and cutoff.rate * windows < 1.0:
        print(f'  a false positive rate of {cutoff.rate:g} is less than one of these windows: the '
              'threshold is the lowest score seen')
    _print_false_alarms(measured.false_alarms)
    print('  the intervals take windows for independent and the threshold for given: the truth '
          'may lie further off')
    print(f'threshold s* {measured.point.cutoff!r} ({cutoff})')


def _print_false_alarms(alarms: FalseAlarms) -> None:
    low, high = alarms.interval
    print(f'  false alarms after persistence: {alarms.count} in '
          f'{duration(3600.0 * alarms.hours)}, {rounded(alarms.per_hour, 3)} an hour '
          f'(95 %: {rounded(low, 3)} to {rounded(high, 3)})')
    needed = confidence.poisson_rate(0, 1.0)[1]
    if alarms.hours < needed:
        print(f'  too little to say whether there is less than one an hour: that takes '
              f'{needed:.1f} h of normal operation without one')


def _share(rate: float, windows: int) -> str:
    low, high = confidence.wilson(round(rate * windows), windows)
    return f'{rate:.2%} (95 %: {low:.2%} to {high:.2%})'


def _alarms(result: FaultResult) -> str:
    text = f'after the onset in {len(result.latencies)} of {result.recordings} recordings'
    if result.latencies:
        text += f', median {median(result.latencies):.2f} s, longest {max(result.latencies):.2f} s'
    if result.stood_before:
        text += f'; in {result.stood_before} it stood before, a false alarm'
    return text


def _rows(runs: Sequence[JudgedRun]) -> Iterator[Sequence[object]]:
    for judged in runs:
        part = cell(str(judged.run.source.part))
        columns = (judged.verdicts.start, judged.verdicts.events, judged.verdicts.unknown,
                   judged.scores, judged.labels)
        for start, events, unknown, score, label in zip(*(column.tolist() for column in columns)):
            yield part, judged.run.fault, start, events, unknown, repr(score), _LABELS[label]


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('--model', required=True, help='file written by train or calibrate')
    parser.add_argument('--normal', type=BagPart.parse, nargs='+', action='extend',
                        required=True, default=[], metavar='BAG',
                        help='recording of normal operation that was not trained on, or a folder '
                             'of them')
    parser.add_argument('--faulty', type=BagPart.parse, nargs='+', action='extend', default=[],
                        metavar='BAG', help='recording with a fault: from its beginning to its '
                        'end, or, as BAG@START or BAG@START-END, in this part only')
    parser.add_argument('--inject', type=cli.checked(InjectedFault.parse), nargs='+',
                        action='extend', default=[], metavar='FAULT',
                        help='fault to make out of the normal recordings, to see how soon it is '
                             'found; see below')
    parser.add_argument('-o', '--output', required=True, metavar='MODEL',
                        help='file to write; may be the same model')
    cli.add_robots_by_folder(parser)
    cli.add_skip_bad(parser)
    parser.add_argument('--budget', type=cli.budget, metavar='N', help='evidence: how many false '
                        f'alarms an hour you allow (default: {limits.BUDGET:g})')
    cli.add_unknown(parser)
    cli.add_details(parser)
    group = cli.for_researchers(parser)
    cli.add_detector_argument(group)
    group.add_argument('--cutoff', type=cli.checked(ThresholdRule.parse),
                       metavar='HOW', help='paper: how to choose the threshold. youden: the '
                       'largest true positive rate less false positive rate; closest: '
                       'nearest to finding every fault without a false alarm; fpr=RATE: this '
                       'share of the normal windows is below it (default: youden)')
    group.add_argument('--roc', type=cli.plot_file, metavar='FILE',
                       help='draw the ROC; the name ends in .png, .pdf or .svg')
    group.add_argument('--csv', metavar='FILE', help='write score and label of every window')
    cli.add_settle_time(group)


main = cli.Program('calibrate', __doc__, _EPILOG, _arguments, _calibrate)
