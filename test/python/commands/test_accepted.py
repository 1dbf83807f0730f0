"""What `train` and `calibrate` make of what is accepted beside the models."""
from __future__ import annotations

from pathlib import Path
from typing import Any, List, Tuple

import pytest

from self_awareness import Acceptance, TrainedModel, accepted_file, read_accepted
from self_awareness.commands import calibrate, train

Bags = Tuple[str, str]

PROGRAMS = [(train, '--add-to', []), (calibrate, '--model', ['--normal'])]
"""How each is told a model and a recording."""

OF_SOURCE = Acceptance('/joystick', '/joy', 'stranger', 10, '/rqt')
OF_OUTPUT = Acceptance('/camera', '/image', 'slow', 20, '/top')


@pytest.fixture(name='models')
def _models(long_bags: Bags, tmp_path: Path, capsys) -> Tuple[str, str]:
    """A trained model, and another file; something is accepted beside each."""
    source, output = str(tmp_path / 'source'), str(tmp_path / 'output')
    assert train.main([long_bags[0], '-o', source]) == 0
    accepted_file.keep([OF_SOURCE], source)
    accepted_file.keep([OF_OUTPUT, Acceptance('/nobody', at=5)], output)
    capsys.readouterr()
    return source, output


def heard(model: str) -> Acceptance:
    """Something that the model has learned, once it is accepted."""
    known = TrainedModel.load(model)
    return Acceptance(known.event_types[0].source, '', 'slow',
                      min(end for _, _, end, _ in known.heard_in))


@pytest.mark.parametrize('program, source_option, bag_options', PROGRAMS)
def test_what_is_accepted_beside_the_output_is_kept(
        models: Tuple[str, str], long_bags: Bags, capsys, program: Any, source_option: str,
        bag_options: List[str]) -> None:
    source, output = models
    learned = heard(source)
    accepted_file.keep([*accepted_file.beside(output), learned], output)
    assert program.main([source_option, source, *bag_options, long_bags[1], '-o', output]) == 0
    assert read_accepted(output + '.accepted') == [OF_OUTPUT, Acceptance('/nobody', at=5),
                                                   OF_SOURCE]
    assert read_accepted(source + '.accepted') == [OF_SOURCE]
    said = capsys.readouterr().out
    assert f'learned now, so it is judged again: {learned.component} (slow)' in said
    assert 'accepted, and not learned: /joystick on /joy (stranger)' in said
    assert 'accepted, and not learned: /camera on /image (slow)' in said
    assert 'accepted, and not learned: /nobody' in said


def test_calibrate_in_place_leaves_the_file_alone(models: Tuple[str, str],
                                                  long_bags: Bags) -> None:
    source, _ = models
    accepted = [OF_SOURCE, heard(source)]
    accepted_file.keep(accepted, source)
    assert calibrate.main(['--model', source, '--normal', long_bags[1], '-o', source]) == 0
    assert read_accepted(source + '.accepted') == accepted


@pytest.mark.parametrize('program, source_option, bag_options', PROGRAMS)
def test_a_damaged_file_is_found_before_anything_is_written(
        models: Tuple[str, str], long_bags: Bags, tmp_path: Path, capsys, program: Any,
        source_option: str, bag_options: List[str]) -> None:
    source, output = models
    (tmp_path / 'output.accepted').write_text('what is this')
    assert program.main([source_option, source, *bag_options, long_bags[1], '-o', output]) == 1
    assert 'output.accepted' in capsys.readouterr().err
    assert not (tmp_path / 'output').exists()
