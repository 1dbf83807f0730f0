"""Verdicts that changed are a new version of the method: pages of the old one are told as old."""
from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any, Dict, Iterator, List, Tuple

import numpy as np
import pytest

from self_awareness import DEFAULT_WINDOW, METHOD
from self_awareness_evaluation.families.protocol import KINDS, Records
from self_awareness_evaluation.records import Judged, Learning, SystemAlarm, WindowedEvents
from self_awareness_evaluation.systems import Evidence

KEPT = Path(__file__).resolve().parents[2] / 'data' / 'verdicts.json'
ROBOTS = (('bursty', 3), ('driving_docked', 3), ('everyday', 3), ('hole', 3), ('lossy', 3),
          ('stalled_loops', 3))
LEARNING = Learning.of(2, 150.0, 150.0)


def watched(records: Records) -> Iterator[Tuple[str, WindowedEvents]]:
    """Yield the recordings that are judged, by name."""
    for number, recording in enumerate(records.watched(1.0)):
        yield f'normal {number}', recording
    for fault in records.faults(KINDS, most=2, after_death_s=120.0):
        yield f'{fault.kind} {fault.source}', fault.recording


def verdict(alarm: SystemAlarm, recording: WindowedEvents) -> List[Any]:
    """Return when it was raised and cleared, in windows before the end, and what it says."""
    return [(recording.end - alarm.start) // DEFAULT_WINDOW,
            (recording.end - alarm.end) // DEFAULT_WINDOW, alarm.evidence,
            *(alarm.suspects or [])[:1]]


def verdicts() -> Tuple[str, Dict[str, Any]]:
    """Return a digest of all recordings, and what is said of each that is not quiet."""
    digest = hashlib.sha256()
    found: Dict[str, Any] = {}
    for robot in ROBOTS:
        records = Records(*robot)
        system = Evidence(records.robot.graph)
        system.train(records.training(LEARNING))
        system.calibrate(records.calibration(LEARNING))
        for name, recording in watched(records):
            digest.update(recording.stamps.tobytes())
            digest.update(recording.ids.tobytes())
            judged: Judged = system.judge(recording)
            said = {word: [verdict(alarm, recording) for alarm in alarms] for word, alarms in
                    (('alarms', judged.alarms), ('suspicions', judged.suspicions)) if alarms}
            if said:
                found[f'{robot[0]}: {name}'] = said
    return digest.hexdigest(), found


def test_other_verdicts_are_another_method(tmp_path: Path) -> None:
    """Whoever changes what is judged raises kMethod, and keeps the verdicts of the new one."""
    records, found = verdicts()
    new = tmp_path / KEPT.name
    new.write_text(json.dumps({'method': METHOD, 'numpy': np.__version__, 'records': records,
                               'verdicts': found}) + '\n', encoding='utf-8')
    kept = json.loads(KEPT.read_text(encoding='utf-8'))
    if kept['records'] != records and kept['numpy'] != np.__version__:
        pytest.skip('this NumPy draws other numbers, so the recordings are others')
    assert kept['records'] == records, f'the recordings are others: copy {new} to {KEPT}'
    assert (kept['method'], kept['verdicts']) == (METHOD, found), (
        'verdicts are others: raise kMethod in include/self_awareness/ros/file_version.h if it is '
        f'still {kept["method"]}, copy {new} to {KEPT}, and see which pages are old: '
        'rosrun self_awareness evaluate pages')
