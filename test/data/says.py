"""Says what a model says: its limits, and its alarms in recordings: says.py MODEL RECORDING..."""
from __future__ import annotations

import json
import math
import sys
from typing import Any, Dict, List, Sequence

from self_awareness import DetectorParameters, EvidenceModel, PaperModel, TrainedModel, Verdicts
from self_awareness.judging import evidence_judge, paper_judge
from self_awareness.parts import BagPart, expand
from self_awareness.recordings import RecordingEvents, read
from self_awareness.stamps import SECOND_NS


def limits(trained: TrainedModel) -> List[Dict[str, Any]]:
    """Return the limit of each track that is judged."""
    kinds = [str(kind) for kind in trained.event_types]
    return [{'channel': track.channel, 'to': kinds[track.to_id], 'from': kinds[track.from_id],
             'limit': limit}
            for track, limit in zip(EvidenceModel(trained).tracks, trained.calibration.limits)
            if not math.isnan(limit)]


def _alarms(recording: RecordingEvents, verdicts: Verdicts) -> List[Dict[str, Any]]:
    return [{'start': round((alarm.begin - recording.origin) / SECOND_NS, 3),
             'end': round((alarm.end - recording.origin) / SECOND_NS, 3),
             'suspects': [str(recording.event_types[suspect.id]) for suspect in alarm.suspects]}
            for alarm in verdicts.alarms]


def says(model: str, recordings: Sequence[str]) -> Dict[str, Any]:
    """Return the limits of a model with both calibrations, and its alarms in recordings."""
    trained = TrainedModel.load(model)
    parameters = DetectorParameters()
    paper = paper_judge(trained, PaperModel(trained), trained.threshold, parameters)
    evidence = evidence_judge(trained, parameters)
    found: Dict[str, Any] = {'threshold': trained.threshold, 'limits': limits(trained),
                             'recordings': {}}
    for part in expand([BagPart.parse(path) for path in recordings]):
        recording = read(trained, part)
        scored, judged = paper(recording), evidence(recording)
        scores = scored.score.tolist()
        found['recordings'][recording.part.path.rsplit('/', 1)[-1]] = {
            'evidence': _alarms(recording, judged),
            'paper': _alarms(recording, scored),
            'sum of the paper\'s scores': math.fsum(score for score in scores
                                                    if not math.isnan(score))}
    return found


if __name__ == '__main__':
    print(json.dumps(says(sys.argv[1], sys.argv[2:]), indent=1))
