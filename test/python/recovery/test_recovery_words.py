"""What a recovery says of itself."""
from __future__ import annotations

from typing import List

import pytest

from self_awareness.recovery import words
from self_awareness.recovery.history import Action
from self_awareness.recovery.ladder import Climb
from self_awareness.recovery.rules import Rule, Stop

NOW = 100.0
RULE = Rule('/player', ('silent',), (Stop(('/player',)), Stop(('/player', '/slam'))))
DONE = Action(7, '/player', 'silent', 1, 2, 'stop /player', 1_600_000_000_000_000_000, False, True,
              True, '/player ended by SIGKILL')
DOING = Action(7, '/player', 'silent', 2, 2, 'stop /player, /slam', 1_600_000_020_000_000_000,
               False)


def test_nothing_to_do_is_ok() -> None:
    assert words.status(NOW, 3, [], [DONE], '', '') == (
        words.OK, 'watches 3 components; 1 actions so far')


def test_what_is_done_and_what_will_be_is_told() -> None:
    waiting = Climb(RULE, NOW + 12.4, 1)
    assert words.status(NOW, 1, [waiting], [DONE], '', '') == (
        words.WARN, '/player is to be mended by step 2 of 2 in 12 s, if it does not recover')
    assert words.status(NOW, 1, [Climb(RULE, NOW, 1)], [DONE], '', '')[1] == (
        '/player is to be mended by step 2 of 2 as soon as it fails so again')
    assert words.status(NOW, 1, [waiting], [DONE, DOING], '', '') == (
        words.WARN, 'stop /player, /slam (step 2 of 2), since /player: silent')


def test_who_gave_up_says_so_until_it_is_healed() -> None:
    gave_up = [Climb(RULE, NOW, 3, gave_up='3 actions')]
    assert words.status(NOW, 1, gave_up, [DONE], '', '') == (
        words.ERROR, 'gave up on /player: 3 actions')
    assert words.status(NOW, 1, gave_up, [], 'not heard', '')[1] == (
        'gave up on /player: 3 actions; does nothing: not heard')


DOES = 'stop /player, /slam (step 2 of 2), since /player: silent'


@pytest.mark.parametrize('actions, blind, held, told', [
    ([], 'the monitor is not heard', '', 'does nothing: the monitor is not heard'),
    ([], '', 'until noon, by /me', 'does nothing until noon, by /me'),
    ([DONE, DOING], '', 'until noon, by /me', f'{DOES}; does nothing more until noon, by /me'),
    ([DONE, DOING], 'not heard', 'until noon',
     f'{DOES}; does nothing more until noon; does nothing: not heard'),
    ([], 'not heard', 'until noon', 'does nothing until noon; does nothing: not heard')])
def test_why_nothing_is_done_is_told(actions: List[Action], blind: str, held: str,
                                     told: str) -> None:
    assert words.status(NOW, 1, [], actions, blind, held) == (words.WARN, told)


def test_the_last_actions_are_values() -> None:
    shown = words.values([DONE] * 11 + [DOING], ['/x was not started by roslaunch'], True)
    assert shown['dry run'] == 'true'
    assert shown['cannot stop 1'] == '/x was not started by roslaunch'
    assert shown['action 1'] == (
        '2020-09-13 12:27:00 UTC, stop /player, /slam (step 2 of 2), since /player: silent')
    assert shown['action 2'] == ('2020-09-13 12:26:40 UTC, stop /player (step 1 of 2), since '
                                 '/player: silent: done: /player ended by SIGKILL')
    assert 'action 11' not in shown
