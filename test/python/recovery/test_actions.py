"""What is done to nodes, with a made-up master and real processes, and which process a node is."""
from __future__ import annotations

import os
import signal
import subprocess
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Set, Tuple
from unittest.mock import MagicMock

import pytest

from self_awareness.recovery.actions import ActionError, Actions
from self_awareness.recovery.node_calls import NodeCalls
from self_awareness.recovery.node_process import NodeProcess, NotItsProcess, process_of
from self_awareness.recovery.rules import Call, Step, Stop
from self_awareness.recovery.xml_rpc import NoAnswer

# As nodes do, it handles SIGTERM: the kernel ends others by it even while they are stopped.
_NODE = """
import signal, sys, time
signal.signal(signal.SIGTERM, {handler})
print("up", flush=True)
while True:
    time.sleep(0.05)
"""


@contextmanager
def launched(folder: Path, *words: str, deaf: bool = False, by: str = 'roslaunch'
             ) -> Iterator[int]:
    """Hand out the process id of a program with these arguments, below one called `by`.

    Args:
        folder: for what is started.
        words: the program's arguments.
        deaf: it does not end by SIGTERM.
        by: name of the program that starts it.
    """
    program = folder / 'node.py'
    program.write_text(_NODE.format(
        handler='signal.SIG_IGN' if deaf else 'lambda *_: sys.exit()'))
    launcher = folder / by
    launcher.write_text('#!/bin/bash\n/usr/bin/python3 "$@" &\necho $!\nwait\nwait\n')
    launcher.chmod(0o755)
    with subprocess.Popen((launcher, program, *words), stdout=subprocess.PIPE, text=True
                          ) as process:
        lines = sorted(process.stdout.readline().strip() for _ in range(2))
        pid = int(lines[0])
        try:
            yield pid
        finally:
            for each in (pid, process.pid):
                subprocess.run(('kill', f'-{signal.SIGKILL:d}', str(each)), check=False,
                               stderr=subprocess.DEVNULL)


HERE, THERE = 'http://here:1/', 'http://there:1/'
GRACE_S = 20.0  # of who obeys, on a machine that is busy
DEAF_S = 0.3  # of who does not obey anyway


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

    def launchers(self) -> Any:
        return MagicMock(why_not=lambda node, pids: self.why_dead.get(node, ''))

    def robot(self) -> Tuple[Set[str], Set[str]]:
        return {*self.pids, '/base', '/rosout', *self.own}, self.own

    def runs(self, node: str) -> bool:
        return process_of(node, self.pids[node]).runs()


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[Robot]:
    """Two nodes that run."""
    (tmp_path / 'slam').mkdir()
    with launched(tmp_path, '__name:=player') as player, \
            launched(tmp_path / 'slam', '__name:=slam') as slam:
        yield Robot(player=player, slam=slam)


STOP = Stop(('/player',))


def looked(robot: Robot, *nodes: str) -> Actions:
    actions = Actions(robot, nodes or ('/player',), GRACE_S)
    actions.look()
    return actions


def do(actions: Actions, step: Step = STOP) -> str:
    return actions.do(step, '/player', lambda _: None)


def stop(robot: Robot, *nodes: str, known: bool = True, grace: float = GRACE_S,
         held: Callable[[], str] = str) -> str:
    actions = Actions(robot, nodes, grace, held)
    if known:
        hanging, robot.hanging = robot.hanging, set()
        actions.look()
        robot.hanging = hanging
    return actions.do(Stop(nodes), nodes[0], lambda node: robot.told.append(f'mute {node}'))


def test_who_does_not_end_when_asked_is_killed(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player', deaf=True) as pid:
        assert stop(Robot(player=pid), '/player', grace=DEAF_S) == '/player ended by SIGKILL'


def test_who_hangs_is_known_from_when_it_was_well(robot: Robot) -> None:
    robot.hanging.add('/player')
    with pytest.raises(ActionError, match='its process is not known'):
        stop(robot, '/player', known=False)
    os.kill(robot.pids['/player'], signal.SIGSTOP)
    assert stop(robot, '/player', grace=DEAF_S) == '/player ended by SIGKILL, since it hangs'
    assert robot.told == []


def test_another_start_that_hangs_from_the_beginning_is_not_the_one_before(robot: Robot) -> None:
    actions = looked(robot)
    robot.hanging.add('/player')
    robot.addresses['/player'] = 'http://here:2/'
    with pytest.raises(ActionError, match='its process is not known'):
        do(actions)
    assert robot.runs('/player')


@pytest.mark.parametrize('gone', [True, False])
def test_who_has_ended_already_is_left_to_roslaunch_and_the_next_one_follows(
        robot: Robot, gone: bool) -> None:
    both = Stop(('/player', '/slam'))
    actions = looked(robot, *both.nodes)
    process_of('/player', robot.pids['/player']).end(GRACE_S)
    (robot.gone if gone else robot.hanging).add('/player')
    assert actions.would_do(both) == ('/player has ended already; roslaunch starts it again, '
                                      f'/slam is process {robot.pids["/slam"]}')
    assert do(actions, both) == ('/player has ended already; roslaunch starts it again, '
                                 '/slam ended when it was asked to')


def test_who_is_well_is_asked_to_end_and_a_dependent_muted_first(robot: Robot) -> None:
    assert stop(robot, '/player', '/slam') == (
        '/player ended when it was asked to, /slam ended when it was asked to')
    assert robot.told == ['/player', 'mute /slam', '/slam']


def test_on_another_machine_it_can_only_be_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = Robot(player=1)
    robot.addresses['/player'] = THERE
    assert stop(robot, '/player') == '/player asked to end, on another machine'
    monkeypatch.setattr(robot, 'shut_down', MagicMock(side_effect=NoAnswer('no answer')))
    with pytest.raises(ActionError, match='on another machine, and did not answer'):
        stop(robot, '/player')
    robot.hanging.add('/player')
    with pytest.raises(ActionError, match='runs on another machine'):
        stop(robot, '/player')


@pytest.mark.parametrize('own, why', [({'/base'}, '/base is a monitor or a recorder'),
                                      (set(), 'all nodes of the robot')])
def test_nodes_of_this_package_and_the_whole_robot_are_refused(robot: Robot, own: Set[str],
                                                               why: str) -> None:
    """Whatever their names are."""
    robot.own = own
    with pytest.raises(ActionError, match=why):
        stop(robot, '/player', '/slam', '/base', known=False)
    assert robot.runs('/player') and robot.told == []


def test_a_node_that_cannot_be_stopped_is_told_before_it_is_needed(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player', by='terminal') as pid:
        actions = looked(Robot(player=pid))
        assert [why for why in actions.refused() if 'not started by roslaunch' in why]
        with pytest.raises(ActionError, match='not started by roslaunch'):
            do(actions)


def test_who_would_stay_dead_is_refused_and_told_before(robot: Robot) -> None:
    robot.why_dead['/player'] = '/player is not respawn="true"'
    actions = looked(robot)
    assert actions.refused() == ['/player is not respawn="true"']
    with pytest.raises(ActionError, match='is not respawn="true"'):
        do(actions)
    assert robot.runs('/player')
    robot.why_dead.clear()
    actions.look()
    assert actions.refused() == []
    robot.why_dead['/player'] = '/player is required="true"'
    robot.hanging.add('/player')
    with pytest.raises(ActionError, match='is required="true"'):
        do(actions)
    assert robot.runs('/player') and robot.told == []


def test_without_an_answer_of_roslaunch_nobody_is_stopped(
        robot: Robot, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot, 'launchers', MagicMock(side_effect=NoAnswer('no master answers')))
    with pytest.raises(ActionError, match='/player may stay dead: .*no master answers'):
        stop(robot, '/player')
    assert robot.runs('/player')


def test_who_has_never_answered_is_named() -> None:
    robot = Robot()
    robot.gone.add('/plyer')
    actions = looked(robot, '/plyer')
    assert actions.refused() == ['/plyer: not heard so far']
    ways: List[Callable[[Step], str]] = [actions.would_do, partial(do, actions)]
    for doing in ways:
        with pytest.raises(ActionError, match='unknown node /plyer'):
            doing(Stop(('/plyer',)))


def test_a_dry_run_looks_and_does_nothing(robot: Robot) -> None:
    actions = looked(robot)
    assert actions.would_do(STOP) == f'/player is process {robot.pids["/player"]}'
    robot.hanging.add('/player')
    assert actions.would_do(STOP).startswith('/player hangs, and is process ')
    robot.why_dead['/player'] = '/player is required="true"'
    with pytest.raises(ActionError, match='is required="true"'):
        actions.would_do(STOP)
    assert robot.runs('/player') and robot.told == []


def test_a_dry_run_looks_for_a_service(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(NodeCalls, 'service', MagicMock(
        side_effect=['rosrpc://here:1', NoAnswer('no provider of /reset')]))
    actions = Actions(Robot(), [], GRACE_S)
    assert actions.would_do(Call('/reset')) == '/reset is there'
    with pytest.raises(ActionError, match='no provider of /reset'):
        actions.would_do(Call('/reset'))


def test_a_hold_comes_before_the_next_signal(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player', deaf=True) as pid:
        robot = Robot(player=pid)
        with pytest.raises(ActionError, match='not done to its end: held'):
            stop(robot, '/player', held=lambda: 'held' if robot.told else '')
        assert robot.runs('/player') and robot.told == ['/player']


def test_a_hold_comes_before_the_next_node(robot: Robot) -> None:
    process = process_of('/player', robot.pids['/player'])
    with pytest.raises(ActionError, match='^/player ended .*; not done to its end: held'):
        stop(robot, '/player', '/slam', held=lambda: '' if process.runs() else 'held')
    assert robot.runs('/slam') and robot.told == ['/player']


def test_a_hold_comes_before_a_call() -> None:
    with pytest.raises(ActionError, match='not done to its end: held'):
        do(Actions(Robot(), [], GRACE_S, lambda: 'held'), Call('/reset'))


OURSELVES = -2


def test_a_node_ends_when_it_is_told_to_and_nobody_else_does(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        process = process_of('/robot/player', pid)
        with_the_same_id = NodeProcess(pid, process.start - 1)
        assert not with_the_same_id.runs()
        assert with_the_same_id.end(0.3) == 'ended by SIGTERM', 'it has ended long ago'
        assert not process.ends_within(0.3, lambda: None), 'it gets no signal'
        assert process.pid == pid and process.runs()
        assert process.end(20.0) == 'ended by SIGTERM'
        assert not process.runs()


@pytest.mark.parametrize('name', ['/player2', '/robot/play', '/slam'])
def test_a_process_of_another_name_is_not_the_nodes(tmp_path: Path, name: str) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        with pytest.raises(NotItsProcess, match='not started with its name'):
            process_of(name, pid)


@pytest.mark.parametrize('pid', [-1, 0, 1, 2 ** 30, OURSELVES])
def test_what_is_no_process_of_a_node_is_refused(pid: int) -> None:
    with pytest.raises(NotItsProcess, match='/player says that it is process'):
        process_of('/player', os.getpid() if pid == OURSELVES else pid)
