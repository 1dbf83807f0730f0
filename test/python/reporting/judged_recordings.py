"""Recordings as the report gets them, for its tests."""
from __future__ import annotations

from pathlib import Path
from typing import List, Optional

from conftest import Message, jittery_robot, write_bag

from self_awareness import (EVIDENCE_THRESHOLD, DetectorParameters, EvidenceModel, PaperModel,
                            TrainedModel, recordings)
from self_awareness.judging import evidence_judge, paper_judge
from self_awareness.parts import BagPart
from self_awareness.reporting.report.judged import Judged, JudgedBy


def without_laser(start: float, length: float = 30.0) -> List[Message]:
    """Its laser, and slam, which needs it, fall silent from 12 s to 20 s."""
    return [m for m in jittery_robot(start, length, 3)
            if not (start + 12.0 <= m[0] < start + 20.0 and m[1] in ('/laser', '/slam'))]


def with_graph(model: str, path: Path) -> str:
    """Copy a model of the robot, with its graph."""
    trained = TrainedModel.load(model)
    trained.graph = {('/laser', '/scan', '/slam'), ('/slam', '/map', '/planner')}
    trained.save(str(path))
    return str(path)


def judged(model: str, bag: str, detector: str = 'evidence',
           threshold: Optional[float] = None) -> Judged:
    """Judge a bag as `score` does."""
    trained = TrainedModel.load(model)
    parameters = DetectorParameters()
    evidence = EvidenceModel(trained) if detector == 'evidence' else None
    if evidence is None:
        judge = paper_judge(trained, PaperModel(trained), threshold, parameters)
    else:
        judge = evidence_judge(trained, parameters, evidence)
        threshold = None if trained.calibration is None else EVIDENCE_THRESHOLD
    recording = recordings.read(trained, BagPart.parse(bag))
    return Judged(JudgedBy(trained, model, parameters, threshold, evidence), recording,
                  judge(recording))


def dead(model: str, folder: Path) -> Judged:
    """Judge a recording in which the laser falls silent by a model with its graph."""
    bag = write_bag(folder / 'dead.bag', without_laser(3000.0))
    return judged(with_graph(model, folder / 'm'), bag)
