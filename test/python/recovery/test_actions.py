"""What is done to nodes, with a made-up master and real processes."""
from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import Dict, List, Set, Tuple

import pytest
from launched import launched

from self_awareness.recovery.actions import ActionError, Actions
from self_awareness.recovery.node_calls import NoAnswer, NodeCalls
from self_awareness.recovery.node_process import process_of
from self_awareness.recovery.rules import Stop

HERE, THERE = 'http://here:1/', 'http://there:1/'
GRACE_S = 0.3


class Robot(NodeCalls):
    """Nodes that say what they are told to.

    Args:
        pids: by node, its process.
    """

    def __init__(self, **pids: int) -> None:
        super().__init__('/test')
        self.pids = {f'/{name}': pid for name, pid in pids.items()}
        self.addresses: Dict[str, str] = {}
        self.hanging: Set[str] = set()
        self.own: Set[str] = set()
        self.told: List[str] = []

    def address(self, node: str) -> str:
        return self.addresses.get(node, HERE)

    def is_here(self, address: str) -> bool:
        return address != THERE

    def process_id(self, node: str, address: str) -> int:
        if node in self.hanging:
            raise NoAnswer(f'{node} does not answer')
        return self.pids[node]

    def shut_down(self, node: str, address: str, reason: str) -> None:
        self.told.append(node)
        if address == HERE:
            os.kill(self.pids[node], signal.SIGTERM)

    def robot(self) -> Tuple[Set[str], Set[str]]:
        return {*self.pids, '/base', '/rosout', *self.own}, self.own


def stop(robot: Robot, *nodes: str, known: bool = True) -> str:
    actions = Actions(robot, nodes, GRACE_S)
    if known:
        hanging, robot.hanging = robot.hanging, set()
        actions.look()
        robot.hanging = hanging
    return actions.do(Stop(nodes), nodes[0], lambda node: robot.told.append(f'mute {node}'))


def test_who_is_well_is_asked_to_end(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        robot = Robot(player=pid)
        assert stop(robot, '/player') == '/player ended when it was asked to'
        assert robot.told == ['/player']


def test_who_does_not_end_when_asked_is_killed(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player', deaf=True) as pid:
        assert stop(Robot(player=pid), '/player') == '/player ended by SIGKILL'


def test_who_hangs_is_known_from_when_it_was_well(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        robot = Robot(player=pid)
        robot.hanging.add('/player')
        with pytest.raises(ActionError, match='its process is not known'):
            stop(robot, '/player', known=False)
        os.kill(pid, signal.SIGSTOP)
        assert stop(robot, '/player') == '/player ended by SIGKILL, since it hangs'
        assert robot.told == []


def test_another_start_that_hangs_from_the_beginning_is_not_the_one_before(tmp_path: Path
                                                                           ) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        robot = Robot(player=pid)
        actions = Actions(robot, ['/player'], GRACE_S)
        actions.look()
        robot.hanging.add('/player')
        robot.addresses['/player'] = 'http://here:2/'
        with pytest.raises(ActionError, match='its process is not known'):
            actions.do(Stop(('/player',)), '/player', lambda _: None)
        assert process_of('/player', pid).runs()


def test_who_is_dead_is_left_to_roslaunch(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        robot = Robot(player=pid)
        actions = Actions(robot, ['/player'], GRACE_S)
        actions.look()
        process_of('/player', pid).end(20.0)
        robot.hanging.add('/player')
        with pytest.raises(ActionError, match='does not run; roslaunch starts it again'):
            actions.do(Stop(('/player',)), '/player', lambda _: None)


def test_dependents_follow_and_are_muted_first(tmp_path: Path) -> None:
    (tmp_path / 'slam').mkdir()
    with launched(tmp_path, '__name:=player') as player, \
            launched(tmp_path / 'slam', '__name:=slam') as slam:
        robot = Robot(player=player, slam=slam)
        assert stop(robot, '/player', '/slam') == (
            '/player ended when it was asked to, /slam ended when it was asked to')
        assert robot.told == ['/player', 'mute /slam', '/slam']


def test_on_another_machine_it_can_only_be_asked() -> None:
    robot = Robot(player=1)
    robot.addresses['/player'] = THERE
    assert stop(robot, '/player') == '/player asked to end, on another machine'
    robot.hanging.add('/player')
    with pytest.raises(ActionError, match='runs on another machine'):
        stop(robot, '/player')


def test_nodes_of_this_package_are_refused_whatever_their_names(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=watch') as pid:
        robot = Robot(watch=pid)
        robot.own.add('/watch')
        with pytest.raises(ActionError, match='/watch is a monitor or a recorder'):
            stop(robot, '/watch')
        assert process_of('/watch', pid).runs()


def test_the_whole_robot_is_refused(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=base') as pid:
        robot = Robot(base=pid)
        with pytest.raises(ActionError, match='all nodes of the robot'):
            stop(robot, '/base')
        assert process_of('/base', pid).runs()


def test_a_node_that_cannot_be_stopped_is_told_before_it_is_needed(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player', by='terminal') as pid:
        actions = Actions(Robot(player=pid), ['/player'], GRACE_S)
        actions.look()
        assert [why for why in actions.refused() if 'not started by roslaunch' in why]
        with pytest.raises(ActionError, match='not started by roslaunch'):
            actions.do(Stop(('/player',)), '/player', lambda _: None)
