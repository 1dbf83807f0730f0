"""What a recovery says of itself."""
from __future__ import annotations

from self_awareness.recovery import words
from self_awareness.recovery.history import Action
from self_awareness.recovery.ladder import Standing
from self_awareness.recovery.rules import Rule, Stop

RULE = Rule('/player', ('silent',), (Stop(('/player',)), Stop(('/player', '/slam'))))
DONE = Action(7, '/player', 'silent', 1, 2, 'stop /player', 1_600_000_000_000_000_000, False, True,
              True, '/player ended by SIGKILL')
DOING = Action(7, '/player', 'silent', 2, 2, 'stop /player, /slam', 1_600_000_020_000_000_000,
               False)


def test_nothing_to_do_is_ok() -> None:
    assert words.status(3, [], [DONE], '', '') == (
        words.OK, 'watches 3 components; 1 actions so far')


def test_what_is_done_and_what_will_be_is_told() -> None:
    waiting = Standing(RULE, 1, '', 12.4)
    assert words.status(1, [waiting], [DONE], '', '') == (
        words.WARN, '/player is to be mended by step 2 of 2 in 12 s, if it does not recover')
    assert words.status(1, [Standing(RULE, 1, '', 0.0)], [DONE], '', '')[1] == (
        '/player is to be mended by step 2 of 2 as soon as it fails so again')
    assert words.status(1, [waiting], [DONE, DOING], '', '') == (
        words.WARN, 'stop /player, /slam (step 2 of 2), since /player: silent')


def test_who_gave_up_says_so_until_it_is_healed() -> None:
    level, message = words.status(1, [Standing(RULE, 3, '3 actions', 0.0)], [DONE], '', '')
    assert (level, message) == (words.ERROR, 'gave up on /player: 3 actions')
    assert words.status(1, [Standing(RULE, 3, '3 actions', 0.0)], [], 'not heard', '')[1] == (
        'gave up on /player: 3 actions; does nothing: not heard')


def test_why_nothing_is_done_is_told() -> None:
    assert words.status(1, [], [], 'the monitor is not heard', '') == (
        words.WARN, 'does nothing: the monitor is not heard')
    assert words.status(1, [], [], '', 'until noon, by /me') == (
        words.WARN, 'does nothing until noon, by /me')


def test_a_hold_and_a_step_under_way_are_both_told() -> None:
    doing = 'stop /player, /slam (step 2 of 2), since /player: silent'
    assert words.status(1, [], [DONE, DOING], '', 'until noon, by /me') == (
        words.WARN, f'{doing}; does nothing more until noon, by /me')
    assert words.status(1, [], [DONE, DOING], 'not heard', 'until noon') == (
        words.WARN, f'{doing}; does nothing more until noon; does nothing: not heard')
    assert words.status(1, [], [], 'not heard', 'until noon')[1] == (
        'does nothing until noon; does nothing: not heard')


def test_the_last_actions_are_values() -> None:
    shown = words.values([DONE] * 11 + [DOING], ['/x was not started by roslaunch'], True)
    assert shown['dry run'] == 'true'
    assert shown['cannot stop 1'] == '/x was not started by roslaunch'
    assert shown['action 1'] == (
        '2020-09-13 12:27:00 UTC, stop /player, /slam (step 2 of 2), since /player: silent')
    assert shown['action 2'] == ('2020-09-13 12:26:40 UTC, stop /player (step 1 of 2), since '
                                 '/player: silent: done: /player ended by SIGKILL')
    assert 'action 11' not in shown
