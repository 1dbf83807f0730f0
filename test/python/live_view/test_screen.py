"""What keys do on the screen of `top`, without a terminal."""
from __future__ import annotations

import time
from typing import Any, List, Sequence

import pytest
from conftest import error_of
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from told import of_component, stands, stranger

from self_awareness.commands import top
from self_awareness.live_view.said import Said
from self_awareness.msg import Components

screen = pytest.importorskip('self_awareness.live_view.screen', reason='needs urwid')


class Shown:
    """A screen, what it shows, and what was called."""

    def __init__(self) -> None:
        self.said = Said('/watch')
        self.called: List[Any] = []
        self._screen = screen.Screen(lambda: self.said, lambda: '', {
            'a': self._call, 'm': self._call})
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

    def _call(self, *what: Any) -> str:
        self.called.append(what)
        return 'done'

    def tell(self, *names: str, strangers: Sequence[Any] = ()) -> None:
        self.said.on_components(Components(
            components=[of_component(name) for name in names], strangers=strangers))
        self._screen._on_time()

    def selected(self) -> List[str]:
        """Return the first words of the lines that are highlighted."""
        styles = {name for name, color, *_ in screen._PALETTE_SELECTED if 'standout' in color}
        drawn = self._screen._frame.render((80, 24), focus=True).content()
        return [line[0][2].decode().split()[0] for line in drawn
                if all(style in styles for style, _, _ in line)]


@pytest.fixture()
def shown() -> Shown:
    return Shown()


@pytest.mark.parametrize('kind, who', [
    ('silent', '/slam'), ('late', 'who has died since it was raised')])
def test_what_stands_is_accepted_after_yes_only(shown: Shown, kind: str, who: str) -> None:
    shown.said.on_status(stands(7, '/player', 'slow', ('/slam', kind)))
    assert shown.press('a') == f'accept it? {who} may then die unseen (y/n)'
    assert shown.press('n') == 'not done' and shown.called == []
    shown.press('y')
    assert shown.called == [], 'there is no question any more'
    assert shown.press('a', 'y') == 'done'
    assert shown.called == [(7, [])]


@pytest.mark.parametrize('paused', [True, False])
def test_a_pause_keeps_what_is_shown(shown: Shown, paused: bool) -> None:
    shown.said.on_status(stands(7, '/player', 'slow', ('/slam', 'late')))
    shown._screen._on_time()
    shown.press(*(['p'] if paused else []))
    shown.said = Said('/watch')  # it is over meanwhile
    shown._screen._on_time()
    shown.press('a', 'y')
    assert shown.called == ([(7, [])] if paused else []), 'the monitor refuses it'


def test_what_comes_after_the_question_is_not_accepted(shown: Shown) -> None:
    new = [stranger(f'/n{number}', '/t') for number in range(9)]
    shown.tell(strangers=new)
    assert shown.press('a') == 'accept 9 that are new? (y/n)'
    shown.tell(strangers=new[:1])
    assert shown.press('y') == 'done'
    assert shown.called == [(0, new)], 'in one call'


def test_a_warning_of_which_nothing_stands_is_not_accepted(shown: Shown) -> None:
    shown.said.on_diagnostics(DiagnosticArray(status=[DiagnosticStatus(
        1, 'watch: communication', 'is the model of this robot?', '', [])]))
    assert shown.press('a') == 'nothing stands, and nobody is new' and shown.called == []


def test_the_selected_component_is_highlighted_and_stays_so(shown: Shown) -> None:
    shown.tell('/a', '/c')
    assert shown.selected() == ['/a']
    shown._screen._frame.keypress((80, 24), 'down')
    assert shown.selected() == ['/c']
    shown.tell('/a', '/b', '/c')
    assert shown.selected() == ['/c']


def test_who_fails_is_seen_first_by_whoever_has_moved_nothing(shown: Shown) -> None:
    shown.tell('/b', '/c')
    shown.tell('/a', '/b', '/c')
    assert shown.selected() == ['/a']


def test_who_is_selected_is_muted_after_yes_only_and_told_again(shown: Shown) -> None:
    assert shown.press('u') == 'nobody was muted here' and shown.called == []
    shown.tell('/a', '/player')
    shown._screen._frame.keypress((80, 24), 'down')
    assert shown.press('m') == 'mute /player for 10 minutes? (y/n)'
    assert shown.press('n') == 'not done' and shown.called == []
    assert shown.press('u') == 'nobody was muted here'
    shown.press('m')
    shown._screen._frame.keypress((80, 24), 'up')
    assert shown.press('y') == 'done', 'the one that was asked for'
    assert shown.press('u') == 'done'
    assert shown.called == [('/player', 600.0), ('/player', 0.0)]


def test_without_a_terminal_it_says_so() -> None:
    assert 'needs a terminal' in error_of(top, [])


def test_all_keys_are_in_one_line(shown: Shown) -> None:
    assert len(screen.KEYS) <= 80 and '  m mute  u unmute  ' in screen.KEYS
