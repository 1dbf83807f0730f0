"""`learn`: its command line, and what is no event of the robot. test/learn.test runs it."""
from __future__ import annotations

import signal
import subprocess

import pytest

from self_awareness import EncodingRules
from self_awareness.commands import learn
from self_awareness.learning.programs import executable


@pytest.mark.parametrize('arguments', [
    ['--hours', '0'], ['--hours', '-1'], ['--hours', 'two'], ['--hours', 'nan'],
    ['--start-up', '-1'], ['--budget', '0'], ['--subscribe', 'model'], ['robot.model']])
def test_wrong_usage_is_an_error(arguments, capsys) -> None:
    assert learn.main(arguments) == 2
    assert arguments[-1] in capsys.readouterr().err


def test_the_node_itself_is_no_part_of_the_robot() -> None:
    assert learn.without('/robot1/self_awareness', EncodingRules.defaults()
                         ) == EncodingRules.defaults()
    rules = learn.without('/robot1/monitor', EncodingRules.defaults())
    assert rules.exclude_sources == EncodingRules.defaults().exclude_sources + ['/robot1/monitor']
    assert learn.without('/robot1/monitor', rules) == rules


def test_wrong_usage_is_told_once_where_roslaunch_would_start_it_again() -> None:
    with subprocess.Popen((executable('learn'), '--hours', 'two', '__name:=self_awareness'),
                          stderr=subprocess.PIPE, text=True) as node:
        assert node.stderr is not None
        told = list(iter(node.stderr.readline, 'learn: waiting for the end: launch it again with '
                                               'other arguments\n'))
        assert 'two' in told[-1]
        node.send_signal(signal.SIGTERM)
        assert node.wait(60) != 0
