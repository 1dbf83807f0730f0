"""What keys do on the screen of `top`, without a terminal."""
from __future__ import annotations

import time
from types import SimpleNamespace
from typing import Any, List

import pytest

from self_awareness.live_view.said import Said

screen = pytest.importorskip('self_awareness.live_view.screen', reason='needs urwid')


class Shown:
    """A screen, what it shows, and what was called."""

    def __init__(self) -> None:
        self.said = Said('/watch')
        self.called: List[Any] = []
        self._screen = screen.Screen(lambda: self.said, lambda: '', {'a': self._accept})
        # Without a terminal, urwid 2.6 takes the rows for the columns.
        self._screen._loop.screen.get_cols_rows = lambda: (80, 24)

    def press(self, *keys: str) -> str:
        """Press keys; return the last line but that of the keys."""
        for key in keys:
            self._screen._on_key(key)
        end = time.monotonic() + 60.0
        while self._said_last() == 'asked ...' and time.monotonic() < end:
            time.sleep(0.01)
            self._screen._take_answers()
        return self._said_last()

    def _said_last(self) -> str:
        return str(self._screen._foot.get_text()[0].split('\n')[0])

    def _accept(self, *what: Any) -> str:
        self.called.append(what)
        return 'done'

    def stands(self, kind: str, suspect: str) -> None:
        self.said.on_status(SimpleNamespace(
            score=-2.0, threshold=-1.0, settling=False, level=1, alarm=7, component='/player',
            kind=kind, suspects=[SimpleNamespace(component='/player', kind=kind),
                                 SimpleNamespace(component='/slam', kind=suspect)]))

    def told_new(self, number: int) -> None:
        told = ', '.join(f'/n{k} on /t{k}: 3' for k in range(number))
        self.said.on_diagnostics(SimpleNamespace(status=[SimpleNamespace(
            name='watch: communication', level=0, message='', values=[SimpleNamespace(
                key='not accepted, events so far', value=told)])]))


@pytest.fixture()
def shown() -> Shown:
    return Shown()


def test_a_death_is_accepted_after_yes_only(shown: Shown) -> None:
    shown.stands('slow', 'died')
    assert shown.press('a') == 'accept it? /slam may then die unseen (y/n)'
    assert shown.press('n') == 'not accepted' and shown.called == []
    shown.press('y')
    assert shown.called == [], 'there is no question any more'
    assert shown.press('a', 'y') == 'done'
    assert shown.called == [(7, [])]


def test_what_names_no_death_now_may_have_been_raised_by_one(shown: Shown) -> None:
    shown.stands('slow', 'late')
    assert shown.press('a') == (
        'accept it? who has died since it was raised may then die unseen (y/n)')
    assert shown.press('y') == 'done' and shown.called == [(7, [])]


@pytest.mark.parametrize('paused', [True, False])
def test_a_pause_keeps_what_is_shown(shown: Shown, paused: bool) -> None:
    shown.stands('slow', 'late')
    shown._screen._on_time()
    shown.press(*(['p'] if paused else []))
    shown.said = Said('/watch')  # it is over meanwhile
    shown._screen._on_time()
    shown.press('a', 'y')
    assert shown.called == ([(7, [])] if paused else []), 'the monitor refuses it'


def test_what_comes_after_the_question_is_not_accepted(shown: Shown) -> None:
    shown.told_new(1)
    shown._screen._on_time()
    assert shown.press('a') == 'accept 1 that are new? (y/n)'
    shown.told_new(9)
    shown._screen._on_time()
    shown.press('y')
    assert shown.called == [(0, [('/n0', '/t0')])]


def test_a_warning_of_which_nothing_stands_is_not_accepted(shown: Shown) -> None:
    shown.said.on_diagnostics(SimpleNamespace(status=[SimpleNamespace(
        name='watch: communication', level=1, message='is the model of this robot?', values=[])]))
    assert shown.press('a') == 'nothing stands, and nobody is new' and shown.called == []


def test_all_who_are_new_are_accepted_in_one_call(shown: Shown) -> None:
    shown.told_new(9)
    assert shown.press('a') == 'accept 9 that are new? (y/n)'
    assert shown.press('y') == 'done'
    assert shown.called == [(0, [(f'/n{k}', f'/t{k}') for k in range(9)])]
