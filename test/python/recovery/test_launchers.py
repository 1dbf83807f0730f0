"""What roslaunch is asked, with made-up ones on the loopback interface."""
from __future__ import annotations

from contextlib import contextmanager
from typing import Any, Dict, Iterator, Sequence

import pytest
from test_node_calls import CALLS, serving

from self_awareness.recovery.launchers import Launchers
from self_awareness.recovery.xml_rpc import NoAnswer


@contextmanager
def roslaunch(children: Sequence[str] = (), **changed: Any) -> Iterator[str]:
    """Hand out the address of one that has started /robot/player-one as process 42."""
    info: Dict[str, Any] = {'pid': 42, 'respawn': True, 'required': False, **changed}
    with serving(list_processes=lambda: (1, '', [[['robot/player-one-3', 1], ['rosout-1', 1]],
                                                 [['dead-2', 1]]]),
                 process_info=lambda name: (1, '', info) if name == 'robot/player-one-3'
                 else (-1, 'no process by that name', {}),
                 list_children=lambda: (1, '', list(children))) as address:
        yield address


NODE = '/robot/player-one'
GONE = 'http://127.0.0.1:1/'


def test_who_is_respawned_may_be_stopped() -> None:
    with roslaunch() as address:
        assert Launchers([address]).why_not(NODE, {41, 42}) == ''
        assert Launchers([GONE, address]).why_not(NODE, None) == ''


@pytest.mark.parametrize('changed, why', [
    ({'respawn': False}, 'not respawn="true"'), ({'required': True}, 'required="true"'),
    ({'respawn': 'yes'}, 'not respawn="true"'), ({'required': 0}, 'required="true"'),
    ({'pid': 43}, 'started by no roslaunch')])
def test_others_may_not(changed: Any, why: str) -> None:
    with roslaunch(**changed) as address:
        assert why in Launchers([address]).why_not(NODE, {41, 42})


def test_who_no_roslaunch_knows_may_not_be_stopped() -> None:
    with roslaunch() as address:
        assert 'started by no roslaunch' in Launchers([address]).why_not('/player', {42})
        assert 'started by no roslaunch' in Launchers([address]).why_not('/dead', {42})
    assert f'({GONE} does not answer)' in Launchers([GONE]).why_not(NODE, {42})


def test_nodes_on_other_machines_are_those_of_another_roslaunch() -> None:
    with roslaunch(respawn=False) as child, roslaunch([child, GONE], pid=43) as parent:
        assert 'not respawn' in Launchers([parent]).why_not(NODE, {42})
        assert 'not respawn' in Launchers([parent]).why_not(NODE, None), 'it may be either'


def test_the_master_knows_where_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    with roslaunch() as address:
        for uris, found in (({'host__1': address}, True), ({}, False)):
            with serving(getParam=lambda name, key: (1, '', uris)) as master:
                monkeypatch.setenv('ROS_MASTER_URI', master)
                assert (CALLS.launchers().why_not(NODE, {42}) == '') == found
        with serving(getParam=lambda name, key: (-1, 'not set', 0)) as master:
            monkeypatch.setenv('ROS_MASTER_URI', master)
            with pytest.raises(NoAnswer, match='not set'):
                CALLS.launchers()
