"""Which parts of recordings are trained on, and which limits are found on."""
from __future__ import annotations

from typing import List

from self_awareness.learning.division import divide
from self_awareness.learning.logs import Log
from self_awareness.parts import BagPart


def parts(lengths: List[float], starts: List[int], start_up: float = 30.0) -> List[List[str]]:
    logs = [Log(BagPart(f'{number}.bag', recording=0), seconds, start)
            for number, (seconds, start) in enumerate(zip(lengths, starts))]
    division = divide(logs, start_up)
    return [[str(part) for part in half] for half in (division.training, division.calibration)]


def test_recordings_are_cut_and_the_start_up_of_the_robot_is_left_out() -> None:
    training, calibration = parts([1800.0, 900.4, 330.0], [1, 1, 2])
    assert training == ['0.bag@30-1210', '1.bag@0-600', '2.bag@30-230']
    assert calibration == ['0.bag@1211', '1.bag@601', '2.bag@231']


def test_what_is_too_short_to_be_cut_is_trained_on_as_a_whole() -> None:
    training, calibration = parts([121.0, 122.0, 91.0, 92.0], [1, 2, 2, 2])
    assert training == ['0.bag@30', '1.bag@30-91', '2.bag', '3.bag@0-61']
    assert calibration == ['1.bag@92', '3.bag@62']


def test_a_start_that_soon_ended_is_left_out() -> None:
    assert parts([39.0, 9.0, 41.0], [1, 1, 2]) == [['2.bag@30'], []]


def test_no_part_of_the_training_is_in_the_calibration() -> None:
    logs = [Log(BagPart('a.bag', recording=0), seconds / 7.0, 1) for seconds in range(0, 5000, 13)]
    for log in logs:
        division = divide([log], 20.0)
        for part in division.calibration:
            assert division.training and not part.meets(division.training[0])
            assert part.start is not None and log.seconds - part.start >= 30.0
