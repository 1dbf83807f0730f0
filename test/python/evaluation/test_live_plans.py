"""Live sessions: the plans, how one is walked through without a master, and the processes."""
from __future__ import annotations

import contextlib
import itertools
import time
from pathlib import Path
from typing import Any, Iterator, List, Set

import numpy as np
import pytest
import rosbag
import rosgraph
import rosnode

from self_awareness_evaluation.live import packaged, plans, session
from self_awareness_evaluation.live.follow_me import FollowMe
from self_awareness_evaluation.live.packaged import CAMERAS_HZ, FAULTS, HALF_RATE, NODES
from self_awareness_evaluation.live.processes import (LiveError, Processes, await_condition,
                                                      free_port, unregister)
from self_awareness_evaluation.live.rows import CRASH, DOUBLE, ERROR, HALF, HANG, Status
from self_awareness_evaluation.live.session import Plan, Step, used
from self_awareness_evaluation.records import Learning

PAGES = Path(__file__).resolve().parents[3] / 'docs' / 'evaluation'
LEARNING = Learning(1, 60.0, 1, 60.0)


def test_faults_are_those_of_the_seed() -> None:
    robot = FollowMe(Processes(Path()), seed=1)
    possible = robot.possible()
    drawn = [list(itertools.islice(plans.drawn(possible, seed), 300)) for seed in (1, 1, 2)]
    assert drawn[0] == drawn[1] != drawn[2]
    assert {name.partition(':')[0] for name, _, _ in drawn[0]} == {CRASH, HANG, HALF, DOUBLE}
    assert {name.partition(':')[2] for name, _, _ in drawn[0]} == set(robot.topics)
    for name, after_s, lasts_s in drawn[0]:
        low, high = plans.SHORT_S if lasts_s < 2.0 else plans.LONG_S
        assert low <= lasts_s <= high and (lasts_s > 2.0 or name.startswith(HANG))
        assert plans.PAUSE_S[0] <= after_s <= plans.PAUSE_S[1]
        assert robot.culprits(name) == (f'/{name.partition(":")[2]}',)
    assert 10 < sum(lasts_s < 2.0 for _, _, lasts_s in drawn[0]) < 100


def test_names_are_unique_and_faults_are_of_nodes() -> None:
    page = (PAGES / 'README.md').read_text(encoding='utf-8')
    names = [node.name for node in NODES]
    assert len(set(names)) == len(names)
    assert {node.manager for node in NODES if node.manager} <= set(names)
    assert f'{len(NODES)} nodes of Debian packages' in page
    for kind, node, _ in FAULTS:
        assert not node or node in names
        if kind == HALF_RATE:
            assert node in CAMERAS_HZ, 'others have no rate that can be set'


def test_what_drivers_replay_is_made(tmp_path: Path) -> None:
    packaged.write_drivers(tmp_path)
    for node in NODES:
        assert not node.file or (tmp_path / node.file).exists()
        if node.command.startswith('rosbag '):
            with rosbag.Bag(str(tmp_path / node.file)) as bag:
                assert set(bag.get_type_and_topic_info().topics) == set(node.topics.split())


class Monitor:
    """Has said every 10 ms what was wrong, and is reset."""

    incidents = ()

    def __init__(self) -> None:
        self.resets = 0
        self.wrong_from = self.wrong_to = float('inf')
        self._begin = time.time() - 1.0

    @property
    def statuses(self) -> List[Status]:
        """All so far."""
        stamps = np.arange(self._begin, time.time(), 0.01)
        return [Status(stamp, ERROR, False, suspects=('/a',), component='/a')
                if self.wrong_from <= stamp <= self.wrong_to else Status(stamp, 0, False)
                for stamp in stamps.tolist()]

    def quiet_for(self) -> float:
        """Return for how long there is no alarm [s]."""
        return time.time() - max([each.stamp for each in self.statuses if each.level], default=0.0)

    def reset_until_quiet(self) -> str:
        """Be quiet."""
        self.resets += 1
        return 'twice'

    @contextlib.contextmanager
    def loud(self) -> Iterator[float]:
        """Say that something is wrong, soon after it is so, and until it is undone."""
        onset = time.time()
        self.wrong_from = onset + 0.1
        yield onset
        self.wrong_to = time.time()


@pytest.fixture(name='monitor')
def _monitor(monkeypatch: pytest.MonkeyPatch) -> Monitor:
    monkeypatch.setattr(session, 'process_id', lambda name: 1)
    monkeypatch.setattr(session, 'AFTERMATH_S', 0.2)
    monkeypatch.setattr(session, 'used', lambda pid: {'memory_mb': 20.0})
    return Monitor()


def walk(monitor: Any, quiet_within_s: float) -> session.Walk:
    """Return what takes steps beside a monitor."""
    plan = Plan(FollowMe(Processes(Path()), 1), 'bags', LEARNING, iter(()), 0.3, quiet_within_s)
    return session.Walk(plan, monitor, {'watched': 1, 'components': 2})


def returned() -> float:
    """Return when the node was back."""
    time.sleep(0.3)
    return time.time()


def test_a_fault_is_watched_until_its_alarm_is_over(monitor: Monitor) -> None:
    steps = walk(monitor, 5.0)
    row = steps.take(Step('killed', 9.0, ('/a',), monitor.loud, round=2, reset=True,
                          returned=returned))
    assert (row.fault, row.node, row.round, row.note, monitor.resets) == ('killed', 'a', 2,
                                                                          'twice', 1)
    assert row.latency_s == pytest.approx(0.105, abs=0.006) and row.lasted_s >= 0.3
    assert row.back_s == pytest.approx(row.lasted_s - 0.105, abs=0.1)
    assert row.recovered_s is not None and row.recovered_s >= row.lasted_s
    assert (row.cleared_s, row.end_component, row.memory_mb) == (0.0, '/a', 20.0)
    over = row.onset + row.recovered_s
    row = steps.take(Step('normal', 0.2, is_normal=True))
    assert row.onset == pytest.approx(over + 0.2), 'an alarm after the aftermath is a false one'
    assert (row.alarms, row.watched, row.components) == (0, 1, 2)
    assert steps.take(Step('normal', 0.1, is_normal=True)).onset > row.onset + 0.2
    assert monitor.resets == 1


def test_nobody_waits_where_the_plan_does_not_say_so(monitor: Monitor) -> None:
    steps = walk(monitor, 0.0)
    row = steps.take(Step('killed', 0.1, ('/a',), monitor.loud))
    assert (row.recovered_s, row.cleared_s, row.back_s, monitor.resets) == (None, None, None, 0)
    begin = time.time()
    assert steps.take(Step('normal', 0.1, is_normal=True)).onset >= begin


STARTED_WITHIN_S = 60.0


def test_processes_are_ended_and_failures_are_told(tmp_path: Path) -> None:
    with Processes(tmp_path) as processes:
        asleep = processes.start('asleep', 'sleep', '1000')
        processes.run('right', 10.0, 'echo', 'well')
        with pytest.raises(LiveError, match='exit code 3.*wrong.log'):
            processes.run('wrong', 10.0, 'sh', '-c', 'exit 3')
    assert asleep.poll() is not None
    assert (tmp_path / 'right.log').read_text() == 'well\n'
    with pytest.raises(LiveError, match='not within 0 s: a wonder'):
        await_condition('a wonder', lambda: False, 0.0)
    with pytest.raises(LiveError, match=f'process {asleep.pid} has ended'):
        used(asleep.pid)


def nodes() -> Set[str]:
    """Return the names of those that publish, subscribe or serve, but for roscore's own."""
    return set(rosnode.get_node_names()) - {'/rosout'}


def test_who_ended_without_unregistering_is_unknown_to_the_master(
        tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    port = free_port()
    monkeypatch.setenv('ROS_MASTER_URI', f'http://127.0.0.1:{port}')
    monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path))
    with Processes(tmp_path) as processes:
        processes.start('roscore', 'roscore', '-p', str(port))
        await_condition('the master answers', rosgraph.is_master_online, STARTED_WITHIN_S)
        for number, name in enumerate(('/camera', '/lidar', '/lidar_driver')):
            gone = f'http://127.0.0.1:{number + 1}'
            node = rosgraph.Master(name)
            node.registerPublisher(f'{name}/out', 'std_msgs/String', gone)
            node.registerSubscriber('/tf', 'std_msgs/String', gone)
            node.registerService(f'{name}/get_loggers', f'rosrpc://127.0.0.1:{number + 1}', gone)
        assert nodes() == {'/camera', '/lidar', '/lidar_driver'}

        unregister(['/lidar', '/never_there'])
        assert nodes() == {'/camera', '/lidar_driver'}
    with pytest.raises(LiveError, match='the master does not answer any more'):
        unregister(['/camera'])
