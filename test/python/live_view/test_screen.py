"""What keys do on the screen of `top`, without a terminal."""
from __future__ import annotations

import time
from types import SimpleNamespace
from typing import Any, List, Sequence, Tuple

import pytest

from self_awareness.live_view.said import Said

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

    def stands(self, kind: str, suspect: str) -> None:
        self.said.on_status(SimpleNamespace(
            score=-2.0, threshold=-1.0, settling=False, level=1, alarm=7, component='/player',
            kind=kind, suspects=[SimpleNamespace(component='/player', kind=kind),
                                 SimpleNamespace(component='/slam', kind=suspect)]))

    def tell(self, *names: str, strangers: Sequence[Any] = ()) -> None:
        self.said.on_components(SimpleNamespace(
            components=[SimpleNamespace(
                name=name, level=0, state='heard', rate=1.0, usual_rate=1.0, age=0.1, share=0.1,
                found_after=1.0, found_when_asked=-1.0, not_watched='') for name in names],
            strangers=strangers, delays_not_watched=[], off_together=[], mutes=[]))
        self._screen._on_time()

    def told_new(self, number: int) -> List[Any]:
        new = [SimpleNamespace(component=f'/n{k}', topic=f'/t{k}', kind='stranger')
               for k in range(number)]
        self.tell(strangers=new)
        return new

    def drawn(self) -> List[List[Tuple[Any, str]]]:
        """Return the lines on the screen, as styles and texts."""
        canvas = self._screen._frame.render((80, 24), focus=True)
        return [[(style, text.decode()) for style, _, text in line] for line in canvas.content()]

    def selected(self) -> List[str]:
        """Return the lines that are highlighted."""
        styles = {name for name, color, *_ in screen._PALETTE_SELECTED if 'standout' in color}
        return [''.join(text for _, text in line) for line in self.drawn()
                if all(style in styles for style, _ in line)]


@pytest.fixture()
def shown() -> Shown:
    return Shown()


def test_a_death_is_accepted_after_yes_only(shown: Shown) -> None:
    shown.stands('slow', 'silent')
    assert shown.press('a') == 'accept it? /slam may then die unseen (y/n)'
    assert shown.press('n') == 'not done' and shown.called == []
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
    first = shown.told_new(9)
    assert shown.press('a') == 'accept 9 that are new? (y/n)'
    shown.told_new(1)
    assert shown.press('y') == 'done'
    assert shown.called == [(0, first)], 'in one call'


def test_a_warning_of_which_nothing_stands_is_not_accepted(shown: Shown) -> None:
    shown.said.on_diagnostics(SimpleNamespace(status=[SimpleNamespace(
        name='watch: communication', level=1, message='is the model of this robot?', values=[])]))
    assert shown.press('a') == 'nothing stands, and nobody is new' and shown.called == []


def test_the_selected_component_is_highlighted_and_stays_so(shown: Shown) -> None:
    shown.tell('/a', '/c')
    assert [line.split()[0] for line in shown.selected()] == ['/a']
    shown._screen._frame.keypress((80, 24), 'down')
    assert [line.split()[0] for line in shown.selected()] == ['/c']
    shown.tell('/a', '/b', '/c')
    assert [line.split()[0] for line in shown.selected()] == ['/c']


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


def test_all_keys_are_in_one_line(shown: Shown) -> None:
    assert len(screen.KEYS) <= 80 and '  m mute  u unmute  ' in screen.KEYS
