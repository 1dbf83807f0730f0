"""What a learner says that hears nothing; test/ros/graph_test.cpp has more of it."""
from __future__ import annotations

from typing import Dict, List

import pytest

from self_awareness import EncodingRules, why_nothing_is_heard

TYPES = {'/self_awareness/status': 'self_awareness/SelfAwareness'}
OURS = {'/self_awareness/status': ['/watch'], '/extra': ['/watch'],
        '/rosout': ['/watch', '/play_7'], '/clock': ['/play_7'],
        '/diagnostics': ['/watch']}
NO_ROBOT = 'no node of a robot publishes anything'


def why(encoding: EncodingRules, published: Dict[str, List[str]],
        subscribed: Dict[str, List[str]], subscribe: str) -> str:
    """Return what is said where nodes of this package run, too."""
    return why_nothing_is_heard(
        encoding, {topic: set(nodes) for topic, nodes in {**OURS, **published}.items()},
        {topic: set(nodes) for topic, nodes in subscribed.items()}, TYPES, subscribe == 'used')


@pytest.mark.parametrize('published, subscribed, subscribe, said', [
    ({}, {'/scan': ['/slam']}, 'all', NO_ROBOT),
    ({'/a': ['/record_1511950934432423433'], '/b': ['/rqt_plot']}, {}, 'all', NO_ROBOT),
    ({'/scan': ['/lidar'], '/a': ['/play_7']}, {'/scan': ['/watch', '/rqt_plot']}, 'used',
     'no node of the robot subscribes to /scan; launch it with subscribe:=all to listen all the '
     'same'),
    ({'/scan': ['/lidar'], '/tf': ['/lidar'], '/x': ['/y']},
     {'/scan': ['/slam'], '/tf': ['/slam']}, 'used', 'nothing is sent on /scan and 1 more'),
])
def test_why(published: Dict[str, List[str]], subscribed: Dict[str, List[str]], subscribe: str,
             said: str) -> None:
    assert why(EncodingRules.defaults(), published, subscribed, subscribe) == said


def test_with_source_none_a_player_is_the_robot() -> None:
    encoding = EncodingRules.defaults()
    encoding.source = 'none'
    assert why(encoding, {'/a': ['/play_7']}, {}, 'all') == 'nothing is sent on /a'
