"""Recordings of a robot that a model does not know, or hardly."""
from __future__ import annotations

from typing import Callable, List

import pytest
from conftest import Message, robot

from self_awareness.commands import calibrate, score


def renamed(messages: List[Message], nodes: List[str]) -> List[Message]:
    """Put what some nodes publish into another namespace."""
    return [(stamp, source, f'/other{topic}' if source in nodes else topic)
            for stamp, source, topic in messages]


@pytest.mark.parametrize('program', [
    lambda bag, model, output: score.main([bag, '--model', model]),
    lambda bag, model, output: calibrate.main(['--model', model, '--normal', bag, '-o', output])])
def test_a_model_of_another_robot_is_an_error(program: Callable[[str, str, str], int],
                                              make_bag: Callable[..., str], model_file: str,
                                              tmp_path, capsys) -> None:
    bag = make_bag('other.bag', renamed(list(robot(5000.0, 60.0)),
                                        ['/laser', '/slam', '/battery']))
    assert program(bag, model_file, str(tmp_path / 'm')) == 1
    error = capsys.readouterr().err
    assert f'{bag}: the model knows none of the 3 event types of this recording' in error
    assert 'another encoding' in error
    assert error.count('\n') == 1


@pytest.mark.parametrize('nodes, warned', [(['/laser', '/slam'], True), (['/laser'], False)])
def test_a_model_that_knows_little_of_a_recording_warns(
        nodes: List[str], warned: bool, make_bag: Callable[..., str], model_file: str,
        capsys) -> None:
    bag = make_bag('other.bag', renamed(list(robot(5000.0)), nodes))
    assert score.main([bag, '--model', model_file]) == 0
    error = capsys.readouterr().err
    assert (f'score: warning: {bag}: the model knows 1 of the 3 event types' in error) == warned
