"""`learn`: its command line, and what is no event of the robot. test/learn.test runs it."""
from __future__ import annotations

import pytest

from self_awareness import EncodingRules
from self_awareness.commands import cli, learn
from self_awareness.learning.recorder import RecorderCrash


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


def test_who_can_go_on_ends_unlike_who_cannot(monkeypatch, capsys) -> None:
    """launch/until_refused.sh lets roslaunch start it again."""
    def crash(*_) -> int:
        raise RecorderCrash('the recorder crashed (exit code -9)')
    monkeypatch.setattr(cli, 'run', crash)
    assert learn.main([]) not in (0, 1, 2)
    assert capsys.readouterr().err == 'learn: error: the recorder crashed (exit code -9)\n'
