"""What an engineer looks at next: the log of who is to blame, and the recording at that time."""
from __future__ import annotations

import math
import os
import shlex
from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

from self_awareness import last_log_lines
from self_awareness.reporting.report.incidents import Incident
from self_awareness.reporting.report.judged import Judged
from self_awareness.reporting.report.templates import template
from self_awareness.stamps import nanoseconds

MOST_LINES = 12  # lines of the log of a node, at most so many

_BEFORE_S, _AFTER_S = 5.0, 5.0
_LONGEST_S = 60.0
_MOST_TOPICS = 5
_LEVELS = {1: 'DEBUG', 2: 'INFO', 4: 'WARN', 8: 'ERROR', 16: 'FATAL'}


@dataclass(frozen=True)
class NextSteps:
    """What to look at."""

    # The last lines of who is to blame on /rosout, up to shortly after the alarm: time [s] from
    # the recording's first message, level and text.
    log: List[Tuple[float, str, str]]
    play: Optional[str]  # command that plays the recording at that time; None: it is no bag
    layout: Optional[str]  # a layout for PlotJuggler, whose tab names that time; None likewise


def next_steps(judged: Judged, found: Sequence[Incident]) -> List[NextSteps]:
    """Return what to look at of each incident.

    Raises:
        BagError: the bag cannot be read any more.
    """
    if judged.recording.part.recording is not None:  # of an event log, which holds no messages
        return [NextSteps([], None, None) for _ in found]
    spans = [_span(judged, incident) for incident in found]
    until = [(incident.cause, judged.recording.origin
              + nanoseconds(min(end, incident.main.start + _AFTER_S)))
             for incident, (_, end) in zip(found, spans)]
    logs = (last_log_lines(judged.recording.part.files, judged.by.trained.encoding, until,
                           MOST_LINES) if found else [])
    return [NextSteps([(judged.seconds(stamp), _LEVELS.get(level, str(level)), text)
                       for stamp, level, text in log],
                      _play(judged, *span), _layout(judged, incident, *span))
            for incident, span, log in zip(found, spans, logs)]


def _span(judged: Judged, incident: Incident) -> Tuple[float, float]:
    main = incident.main
    begin = main.start if main.began is None else main.began
    begin = max(begin - _BEFORE_S, 0.0)
    return begin, min(main.end + _AFTER_S, begin + _LONGEST_S,
                      judged.seconds(judged.recording.end))


def _files_of(judged: Judged, begin: float, end: float) -> List[Tuple[str, float]]:
    """Return the files that hold what came between two times, and where each begins [s]."""
    files = [(os.path.abspath(path), judged.seconds(start))
             for path, start in judged.recording.files]
    later = [start for _, start in files[1:]] + [math.inf]
    return [(path, start) for (path, start), after in zip(files, later)
            if start <= end and begin < after]


def _play(judged: Judged, begin: float, end: float) -> str:
    files = _files_of(judged, begin, end)
    return (f'rosbag play -s {begin - files[0][1]:.1f} -u {end - begin:.1f} '
            f'{" ".join(shlex.quote(path) for path, _ in files)}')


def _layout(judged: Judged, incident: Incident, begin: float, end: float) -> str:
    """Return a layout that loads the topics of the suspects, and shows when messages came.

    PlotJuggler 3 shows all that it loads, whatever range a plot has: the name of the tab says what
    to zoom to. Stamps rise with the time: a line that stands still is a node that sends no more.
    """
    named = [judged.recording.event_types[suspect.of.id] for suspect in incident.main.named]
    types = {kind.scope: kind.type for kind in named[:_MOST_TOPICS]}
    text: str = template('layout.xml').render(
        tab=f'{incident.cause or "alarm"}: {begin:.0f} to {end:.0f} s', topics=list(types),
        curves=[f'{topic}/header/stamp' for topic, name in types.items() if _has_header(name)],
        file=_files_of(judged, begin, end)[0][0])
    return text


def _has_header(datatype: str) -> bool:
    """Return whether messages of a type have a header, as far as it is installed here."""
    from roslib.message import get_message_class  # takes long, and few programs need it
    try:
        message = get_message_class(datatype)
    except ValueError:  # no name of a type
        return False
    return message is not None and bool(message._has_header)
