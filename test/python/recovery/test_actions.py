"""What is done to nodes, with a made-up master and real processes."""
from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import Callable, Dict, List, Optional, Set, Tuple

import pytest
from launched import launched

from self_awareness.recovery.actions import ActionError, Actions
from self_awareness.recovery.launchers import Launchers
from self_awareness.recovery.node_calls import NodeCalls
from self_awareness.recovery.node_process import process_of
from self_awareness.recovery.rules import Call, Stop
from self_awareness.recovery.xml_rpc import NoAnswer

HERE, THERE = 'http://here:1/', 'http://there:1/'
GRACE_S = 20.0  # of who obeys, on a machine that is busy
DEAF_S = 0.3  # of who does not obey anyway


class MadeUp(Launchers):
    """Would start all nodes again but these."""

    def __init__(self, why_dead: Dict[str, str]) -> None:
        super().__init__([])
        self._why_dead = why_dead

    def why_not(self, node: str, pids: Optional[Set[int]]) -> str:
        return self._why_dead.get(node, '')


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
        self.gone: Set[str] = set()  # the master does not know them
        self.why_dead: Dict[str, str] = {}  # by node, why roslaunch would not start it again
        self.own: Set[str] = set()
        self.told: List[str] = []

    def address(self, node: str) -> str:
        if node in self.gone:
            raise NoAnswer(f'the master says: unknown node {node}')
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

    def launchers(self) -> Launchers:
        return MadeUp(self.why_dead)

    def robot(self) -> Tuple[Set[str], Set[str]]:
        return {*self.pids, '/base', '/rosout', *self.own}, self.own


def stop(robot: Robot, *nodes: str, known: bool = True, grace: float = GRACE_S,
         held: Callable[[], str] = str) -> str:
    actions = Actions(robot, nodes, grace, held)
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
        assert stop(Robot(player=pid), '/player', grace=DEAF_S) == '/player ended by SIGKILL'


def test_who_hangs_is_known_from_when_it_was_well(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        robot = Robot(player=pid)
        robot.hanging.add('/player')
        with pytest.raises(ActionError, match='its process is not known'):
            stop(robot, '/player', known=False)
        os.kill(pid, signal.SIGSTOP)
        assert stop(robot, '/player', grace=DEAF_S) == (
            '/player ended by SIGKILL, since it hangs')
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


@pytest.mark.parametrize('gone', [True, False])
def test_who_has_ended_already_is_left_to_roslaunch_and_the_next_one_follows(
        tmp_path: Path, gone: bool) -> None:
    (tmp_path / 'slam').mkdir()
    with launched(tmp_path, '__name:=player') as player, \
            launched(tmp_path / 'slam', '__name:=slam') as slam:
        robot = Robot(player=player, slam=slam)
        nodes = ('/player', '/slam')
        actions = Actions(robot, nodes, GRACE_S)
        actions.look()
        process_of('/player', player).end(GRACE_S)
        (robot.gone if gone else robot.hanging).add('/player')
        assert actions.would_do(Stop(nodes)) == (
            f'/player has ended already; roslaunch starts it again, /slam is process {slam}')
        assert actions.do(Stop(nodes), '/player', lambda _: None) == (
            '/player has ended already; roslaunch starts it again, '
            '/slam ended when it was asked to')


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


def test_on_another_machine_no_answer_is_a_failure() -> None:
    class Deaf(Robot):

        def shut_down(self, node: str, address: str, reason: str) -> None:
            raise NoAnswer(f'{node} does not answer')

    robot = Deaf(player=1)
    robot.addresses['/player'] = THERE
    with pytest.raises(ActionError, match='on another machine, and did not answer'):
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


def test_who_would_stay_dead_is_refused_and_told_before(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        robot = Robot(player=pid)
        robot.why_dead['/player'] = '/player is not respawn="true"'
        actions = Actions(robot, ['/player'], GRACE_S)
        actions.look()
        assert actions.refused() == ['/player is not respawn="true"']
        with pytest.raises(ActionError, match='is not respawn="true"'):
            actions.do(Stop(('/player',)), '/player', lambda _: None)
        assert process_of('/player', pid).runs()
        robot.why_dead.clear()
        actions.look()
        assert actions.refused() == []
        robot.why_dead['/player'] = '/player is required="true"'
        robot.hanging.add('/player')
        with pytest.raises(ActionError, match='is required="true"'):
            actions.do(Stop(('/player',)), '/player', lambda _: None)
        assert process_of('/player', pid).runs()
        assert robot.told == []


def test_without_an_answer_of_roslaunch_nobody_is_stopped(tmp_path: Path,
                                                          monkeypatch: pytest.MonkeyPatch) -> None:
    def no_answer(_: NodeCalls) -> Launchers:
        raise NoAnswer('the master does not answer')

    with launched(tmp_path, '__name:=player') as pid:
        monkeypatch.setattr(Robot, 'launchers', no_answer)
        with pytest.raises(ActionError, match='/player may stay dead: .* not answer'):
            stop(Robot(player=pid), '/player')
        assert process_of('/player', pid).runs()


def test_who_has_never_answered_is_named() -> None:
    robot = Robot()
    robot.gone.add('/plyer')
    actions = Actions(robot, ['/plyer'], GRACE_S)
    actions.look()
    assert actions.refused() == ['/plyer: not heard so far']
    for doing in (lambda: actions.would_do(Stop(('/plyer',))),
                  lambda: actions.do(Stop(('/plyer',)), '/plyer', lambda _: None)):
        with pytest.raises(ActionError, match='unknown node /plyer'):
            doing()


def test_a_dry_run_looks_and_does_nothing(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        robot = Robot(player=pid)
        actions = Actions(robot, ['/player'], GRACE_S)
        step = Stop(('/player',))
        assert actions.would_do(step) == f'/player is process {pid}'
        robot.hanging.add('/player')
        assert actions.would_do(step) == f'/player hangs, and is process {pid}'
        robot.why_dead['/player'] = '/player is required="true"'
        with pytest.raises(ActionError, match='is required="true"'):
            actions.would_do(step)
        assert process_of('/player', pid).runs()
        assert robot.told == []


def test_a_dry_run_looks_for_a_service(monkeypatch: pytest.MonkeyPatch) -> None:
    def only_reset(_: NodeCalls, name: str) -> str:
        if name != '/reset':
            raise NoAnswer(f'the master says: no provider of {name}')
        return 'rosrpc://here:1'

    monkeypatch.setattr(NodeCalls, 'service', only_reset)
    actions = Actions(Robot(), [], GRACE_S)
    assert actions.would_do(Call('/reset')) == '/reset is there'
    with pytest.raises(ActionError, match='no provider of /rest'):
        actions.would_do(Call('/rest'))


def test_a_hold_comes_before_the_next_signal(tmp_path: Path) -> None:
    held: List[str] = []

    class Holding(Robot):
        """Is held as soon as a node was asked to end."""

        def shut_down(self, node: str, address: str, reason: str) -> None:
            super().shut_down(node, address, reason)
            held.append('it is held, by /me')

    with launched(tmp_path, '__name:=player', deaf=True) as pid:
        robot = Holding(player=pid)
        with pytest.raises(ActionError, match='not done to its end: it is held, by /me'):
            stop(robot, '/player', held=lambda: ''.join(held))
        assert process_of('/player', pid).runs()
        assert robot.told == ['/player']


def test_a_hold_comes_before_the_next_node(tmp_path: Path) -> None:
    (tmp_path / 'slam').mkdir()
    with launched(tmp_path, '__name:=player') as player, \
            launched(tmp_path / 'slam', '__name:=slam') as slam:
        robot = Robot(player=player, slam=slam)
        process = process_of('/player', player)
        with pytest.raises(ActionError, match='^/player ended .*; not done to its end: held'):
            stop(robot, '/player', '/slam', held=lambda: '' if process.runs() else 'held')
        assert process_of('/slam', slam).runs()
        assert robot.told == ['/player']


def test_a_hold_comes_before_a_call() -> None:
    with pytest.raises(ActionError, match='not done to its end: held'):
        Actions(Robot(), [], GRACE_S, lambda: 'held').do(Call('/reset'), '/player',
                                                         lambda _: None)
