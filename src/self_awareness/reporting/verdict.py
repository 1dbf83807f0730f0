"""What a model is worth, in a few lines: the verdict, who is not watched, what to do next."""
from __future__ import annotations

import os
import shlex
from typing import Any, Dict, List, Sequence

from self_awareness import HOURS_OF_ROBOTS, Coverage, TrainedModel
from self_awareness.judging import PAPER
from self_awareness.reporting import coverage_text
from self_awareness.reporting.text import (aligned, duration, first_lines, first_of, number_of,
                                           rounded, seconds_of)
from self_awareness.stamps import SECOND_NS

_SOON_S = 1.0
_MOST_NAMED, _MOST_LINES = 3, 8


def lines(model: TrainedModel) -> List[str]:
    """Return the verdict, a table of who is not watched if they are several, and what to record
    next, and what that buys."""
    if model.detectors == PAPER:
        return [f"learned from {_learned_from(model)}, for the paper's detector: "
                + ('no threshold yet' if model.threshold is None else
                   f'threshold {rounded(model.threshold, 4)}')]
    coverage = coverage_text.summarise(model.coverage())
    blind = sorted((each['component'], _why(model, each)) for each in coverage
                   if not each['watched'])
    noun = 'node' if any(kind.source for kind in model.event_types) else 'topic'
    parts = [*_false_alarms(model), *_deaths(coverage, noun)]
    if len(blind) == 1:
        parts.append(f'{blind[0][0]} is not watched: {blind[0][1]}')
    elif blind:
        parts.append(f'{len(blind)} are not watched')
    table = aligned([('not watched', 'why'), *blind]) if len(blind) > 1 else []
    return ([f'learned from {_learned_from(model)}: {"; ".join(parts)}',
             *first_lines([f'  {line}' for line in table], _MOST_LINES + 1, ' (--details)', '  ')]
            + _record_next(model, coverage))


def next_steps(model: TrainedModel, path: str) -> List[str]:
    """Return what comes next, and below it the command."""
    named = shlex.quote(path)
    paper = ' --detector paper' if model.detectors == PAPER else ''
    if not (has_limits(model) or (paper and model.threshold is not None)):
        return ['next, with recordings that it was not trained on:',
                f'  rosrun self_awareness calibrate --model {named} --normal BAG{paper} '
                f'-o {named}']
    if paper:
        return ['next:', f'  rosrun self_awareness score BAG --model {named}{paper}']
    return ['next:', '  roslaunch self_awareness monitor.launch '
            f'model:={shlex.quote(os.path.abspath(path))}']


def has_limits(model: TrainedModel) -> bool:
    """Return whether a model has limits that are not preliminary."""
    return model.calibration is not None and model.calibration.method == 'held-out'


def _learned_from(model: TrainedModel) -> str:
    held_out = (model.calibration.recordings
                if model.calibration is not None and has_limits(model) else [])
    recordings = [*model.recordings, *held_out]
    return (f'{number_of(model.starts_of(recordings), "start")}, '
            f'{duration(seconds_of(recordings))}')


def _false_alarms(model: TrainedModel) -> List[str]:
    if model.calibration is None:
        return ['no limits yet, so that nothing is an alarm']
    rate = model.calibration.false_alarms_per_hour
    hourly = rounded(rate, 2)
    text = ('at most 1 false alarm an hour' if hourly == '1' else
            f'at most {hourly} false alarms an hour' if rate > 1.0 else
            f'at most 1 false alarm in {duration(3600.0 / rate)}' if rate > 0.0 else
            'no false alarm')
    return [text + ('' if has_limits(model) else ' (preliminary)')]


def _deaths(coverage: Sequence[Dict[str, Any]], noun: str) -> List[str]:
    found_s = sorted(each['death_found_after'] for each in coverage if each['death_found_after'])
    soon = sum(found <= _SOON_S for found in found_s)
    everybody = len(found_s) == len(coverage)
    of_all = number_of(len(coverage), noun)
    text = []
    if 0 < soon < len(found_s):
        rest = 'the others' if everybody else f'{len(found_s) - soon} more'
        text.append(f'deaths of {soon} of {of_all} found within {_SOON_S:g} s, of {rest} within '
                    f'{duration(found_s[-1])}')
    elif found_s:
        number = 'all' if everybody and len(found_s) > 1 else f'{len(found_s)} of'
        text.append(f'deaths of {number} {of_all} found within {duration(found_s[-1])}')
    asked = [each['component'] for each in coverage
             if each['watched'] and not each['death_found_after']]
    if asked:
        text.append(f'the death of {first_of(asked, _MOST_NAMED)} only while what runs with it '
                    'goes on')
    return text


def _why(model: TrainedModel, each: Dict[str, Any]) -> str:
    if each['gaps'] >= model.fewest_gaps:
        return 'all its messages came at one moment'
    messages = max(model.event_count(index) for index, kind in enumerate(model.event_types)
                   if kind.component == each['component'])
    if not messages:
        return 'it sent only latched messages in training'
    return (f'{number_of(messages, "message")} in training, more than {model.fewest_gaps} are '
            'needed')


def _record_next(model: TrainedModel, coverage: Sequence[Dict[str, Any]]) -> List[str]:
    """Return a line: what to record, and what it buys; and why starts are not told apart."""
    if model.calibration is None:
        return []
    more_s = (model.calibration.windows * model.window / SECOND_NS
              + HOURS_OF_ROBOTS * 3600.0)
    buys = [f'{duration(more_s)} of other starts, for half as many false alarms']
    waiting = [(each['more_starts'], each['component']) for each in coverage
               if 0 < (each['more_starts'] or 0) <= Coverage.MOST_STARTS]
    if waiting:
        more = min(waiting)[0]
        late = first_of([name for starts, name in waiting if starts == more], _MOST_NAMED)
        buys.append(f'{number_of(more, "more start")}, to find late answers of {late}'
                    + ('' if model.graph else ' (fewer with train --graph)'))
    return [f'record next: {"; ".join(buys)}', *(
        ['all recordings count as one start of the robot: record event logs, which say when it '
         'was started, or leave a minute or more between bags of different starts']
        if len(model.recordings) > 1 and model.starts_of(model.recordings) == 1 else [])]
