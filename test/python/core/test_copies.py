"""What Python reads of an object stays in it: pybind11 2.4 (Ubuntu 20.04) moved optionals out."""
from __future__ import annotations

from pathlib import Path

from self_awareness import TrainedModel, summarise_bag
from self_awareness.commands import convert


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
