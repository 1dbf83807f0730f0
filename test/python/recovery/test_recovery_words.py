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


WAITING, GAVE_UP = Climb(RULE, NOW + 12.4, 1), Climb(RULE, NOW, 3, gave_up='3 actions')
DOES = 'stop /player, /slam (step 2 of 2), since /player: silent'


@pytest.mark.parametrize('climbs, actions, blind, held, level, told', [
    ([], [DONE], '', '', words.OK, 'watches 3 components; 1 actions so far'),
    ([WAITING], [DONE], '', '', words.WARN,
     '/player is to be mended by step 2 of 2 in 12 s, if it does not recover'),
    ([Climb(RULE, NOW, 1)], [DONE], '', '', words.WARN,
     '/player is to be mended by step 2 of 2 as soon as it fails so again'),
    ([WAITING], [DONE, DOING], '', '', words.WARN, DOES),
    ([GAVE_UP], [DONE], '', '', words.ERROR, 'gave up on /player: 3 actions'),
    ([GAVE_UP], [], 'not heard', '', words.ERROR,
     'gave up on /player: 3 actions; does nothing: not heard'),
    ([], [], 'not heard', '', words.WARN, 'does nothing: not heard'),
    ([], [], '', 'until noon, by /me', words.WARN, 'does nothing until noon, by /me'),
    ([], [DONE, DOING], '', 'until noon', words.WARN, f'{DOES}; does nothing more until noon'),
    ([], [DONE, DOING], 'not heard', 'until noon', words.WARN,
     f'{DOES}; does nothing more until noon; does nothing: not heard'),
    ([], [], 'not heard', 'until noon', words.WARN,
     'does nothing until noon; does nothing: not heard')])
def test_what_is_and_will_be_done_is_told_or_why_nothing_is(
        climbs: List[Climb], actions: List[Action], blind: str, held: str, level: int,
        told: str) -> None:
    assert words.status(NOW, 3, climbs, actions, blind, held) == (level, told)


def test_the_last_actions_are_values() -> None:
    shown = words.values([DONE] * 11 + [DOING], ['/x was not started by roslaunch'], True)
    assert shown['dry run'] == 'true'
    assert shown['cannot stop 1'] == '/x was not started by roslaunch'
    assert shown['action 1'] == (
        '2020-09-13 12:27:00 UTC, stop /player, /slam (step 2 of 2), since /player: silent')
    assert shown['action 2'] == ('2020-09-13 12:26:40 UTC, stop /player (step 1 of 2), since '
                                 '/player: silent: done: /player ended by SIGKILL')
    assert 'action 11' not in shown
