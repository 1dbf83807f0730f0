"""The exit codes of the recovery, by which launch/until_refused.sh lets it be started again."""
from __future__ import annotations

from pathlib import Path
from unittest.mock import MagicMock

import pytest
import rospy

from self_awareness.commands import recovery

RULES = Path(__file__).resolve().parents[3] / 'config' / 'recovery.yaml'


@pytest.fixture(autouse=True)
def without_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rospy, 'init_node', lambda name: None)
    monkeypatch.setattr(rospy, 'get_name', lambda: '/recovery')
    monkeypatch.setattr(recovery.ros_node, 'limit_goodbye', lambda: None)
    monkeypatch.setattr(recovery, 'Recovery', MagicMock())


def test_rules_that_it_cannot_use_are_refused(tmp_path: Path) -> None:
    assert recovery.main([str(RULES)]) == 0
    assert recovery.main([str(tmp_path / 'none.yaml')]) == 1
    (tmp_path / 'r.yaml').write_text('rules: []')
    assert recovery.main([str(tmp_path / 'r.yaml')]) == 1
    assert recovery.main([]) == 2


@pytest.mark.parametrize('error', [OSError('no master'), ValueError('odd'), RuntimeError('odd'),
                                   rospy.ROSException('odd'), MemoryError()])
@pytest.mark.parametrize('where', ['begin', 'run'])
def test_what_may_go_well_the_next_time_is_not(error: Exception, where: str,
                                               monkeypatch: pytest.MonkeyPatch,
                                               capsys: pytest.CaptureFixture[str]) -> None:
    failing = MagicMock(side_effect=error)
    if where == 'begin':
        monkeypatch.setattr(rospy, 'init_node', failing)
    else:
        monkeypatch.setattr(recovery, 'Recovery', failing)
    assert recovery.main([str(RULES)]) not in (0, 1, 2)
    assert type(error).__name__ in capsys.readouterr().err
