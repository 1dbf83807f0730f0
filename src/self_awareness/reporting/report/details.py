"""All that is shown of an incident when it is opened."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Optional, Sequence

from self_awareness.reporting.report.against import Evidence, against
from self_awareness.reporting.report.incidents import MOST_DETAILS, Incident
from self_awareness.reporting.report.intervals import Interval
from self_awareness.reporting.report.judged import Judged
from self_awareness.reporting.report.neighbours import Neighbourhood, neighbourhood
from self_awareness.reporting.report.next_steps import NextSteps, next_steps
from self_awareness.reporting.report.timeline import Overview, strongest_track
from self_awareness.reporting.text import percent


@dataclass(frozen=True)
class Details:
    """What is shown of an incident.

    Args:
        decided: which track was strongest when the main interval was raised, in words; empty: not
            known.
        evidence: against each suspect that the main interval names; None: it cannot be drawn.
        graph: who publishes to whom near the cause; None: not known.
        next: what to look at.
    """

    decided: str
    evidence: List[Optional[Evidence]]
    graph: Optional[Neighbourhood]
    next: NextSteps


def details(judged: Judged, shown: Overview, found: Sequence[Incident]) -> Dict[str, Details]:
    """Return the details of the first MOST_DETAILS incidents, by their keys.

    Raises:
        BagError: the bag cannot be read any more.
    """
    steps = next_steps(judged, found)
    return {incident.key: Details(_decided(judged, shown, incident.main),
                                  [against(judged, incident.main.of, suspect.of)
                                   for suspect in incident.main.named],
                                  _graph(judged, incident), steps[incident.key])
            for incident in found[:MOST_DETAILS]}


def _graph(judged: Judged, incident: Incident) -> Optional[Neighbourhood]:
    named = [incident.cause, *(suspect.component for suspect in incident.main.named)]
    found = neighbourhood(judged.by.trained.graph, [name for name in named if name])
    return found if found.roles else None


def _decided(judged: Judged, found: Overview, main: Interval) -> str:
    time = main.start - judged.by.trained.window / 2e9  # in the window that raised it
    strongest = strongest_track(found, judged, time)
    if strongest is None:
        return ''
    track, share = strongest
    kinds = judged.by.trained.event_types
    name = str(kinds[track.to_id])
    if track.from_id != track.to_id:
        name = f'{kinds[track.from_id]} → {name}'
    return f'{track.channel} of {name}: {percent(share)} of its limit'
