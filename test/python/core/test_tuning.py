"""`Tuning`: the numbers of the method, as programs read and change them."""
from __future__ import annotations

import pickle

import pytest

from self_awareness import Tuning
from self_awareness.reporting.model_text import tuning_lines


def test_numbers_and_channels_are_known_by_name_and_what_cannot_be_is_told() -> None:
    tuning = Tuning()
    number, = [number for number in Tuning.numbers() if number.name == 'least_effect']
    assert number.least <= number.default == tuning.get('least_effect') <= number.most
    assert number.meaning.endswith('.')
    with pytest.raises(ValueError, match='least_effect must be from 0 to 1000 s, not -1'):
        tuning.set('least_effect', -1.0)
    with pytest.raises(ValueError, match="no channel 'smell'"):
        tuning.leave_out('smell')
    assert tuning == Tuning()


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
