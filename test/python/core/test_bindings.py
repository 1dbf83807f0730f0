"""What Python reads, changes and copies of the C++ module's objects."""
from __future__ import annotations

import pickle
from pathlib import Path

from self_awareness import TrainedModel, Tuning, summarise_bag
from self_awareness.commands import convert
from self_awareness.reporting.model_text import tuning_lines


def test_calibrations_of_a_model_are_copies(evidence_model: str) -> None:
    model = TrainedModel.load(evidence_model)
    first = model.calibration
    assert first is not None and len(first.limits) == len(first.relations) > 0
    first.stamp = 1
    again = model.calibration
    assert again is not None and again.stamp != 1
    assert len(again.limits) == len(first.limits) and model.coverage()
    model.calibration = first
    assert model.calibration.stamp == 1 and len(first.limits) == len(again.limits)
    model.calibration = None
    assert model.calibration is None and model.paper_calibration is None


def test_the_encoding_of_an_event_log_is_a_copy(robot_bags, tmp_path: Path) -> None:
    log = str(tmp_path / 'log.bag')
    assert convert.main([robot_bags[0], '-o', log]) == 0
    summary = summarise_bag(log, 0)
    for _ in range(2):
        assert summary.encoding is not None
        assert summary.encoding.exclude_sources
        summary.encoding.exclude_sources = []


def test_other_processes_get_all_of_it() -> None:
    tuning = Tuning()
    for number in Tuning.numbers():
        tuning.set(number.name, number.least)
    tuning.leave_out(Tuning.channels()[0])
    assert pickle.loads(pickle.dumps(tuning)) == tuning != Tuning()


def test_the_text_has_a_line_for_each_number_and_marks_what_is_changed() -> None:
    tuning = Tuning()
    tuning.set('least_effect', 0.01)
    channel = Tuning.channels()[-1]
    tuning.leave_out(channel)
    lines = tuning_lines(tuning)
    assert [line.split()[0] for line in lines[:-1]] == [each.name for each in Tuning.numbers()]
    changed, = [line for line in lines if '(default: ' in line]
    assert changed.split()[:6] == ['least_effect', '0.01', 's', '0', 'to', '1000']
    assert changed.endswith('A change of a delay that is no fault. (default: 0.005)')
    assert lines[-1] == f'without the channel {channel}'
