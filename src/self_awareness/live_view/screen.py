"""The screen of `top`, drawn by urwid."""
from __future__ import annotations

from typing import Any, Callable, Dict, List, Optional

import urwid

from self_awareness.live_view import lines
from self_awareness.live_view.said import SORTS, Said

KEYS = 'q quit  s sort  f filter  p pause  m mute 10 min  a accept  c clear  d dump'
"""The last line."""

_EVERY_S = 0.5
_MUTE_S = 600.0
_PALETTE = [('head', 'default,bold', 'default'), ('OK', 'dark green', 'default'),
            ('WARN', 'yellow', 'default'), ('ERROR', 'light red,bold', 'default'),
            ('STALE', 'dark cyan', 'default'), ('faint', 'dark gray', 'default')]


class Screen:
    """Shows what was said until the operator quits, or the robot is gone."""

    def __init__(self, said: Callable[[], Said], is_over: Callable[[], str],
                 calls: Dict[str, Callable[..., str]]) -> None:
        """Nothing is drawn yet.

        Args:
            said: what is shown now.
            is_over: why nothing more will come; empty: it goes on.
            calls: by key c and d, what it does, by m, what mutes a component for some seconds,
                and by a, what accepts the alarm of an id, or, where that is 0, senders and their
                topics; they return what came of it.
        """
        self._said, self._is_over, self._calls = said, is_over, calls
        self._shown = said()
        self._sort, self._pattern, self._paused = SORTS[0], '', False
        self._names: List[str] = []
        self._if_yes: Optional[Callable[[], str]] = None  # what an answer is awaited for
        self._listed = urwid.SimpleFocusListWalker([])
        self._head = urwid.Pile([urwid.Text('')])
        self._asked = urwid.Edit('filter: ')
        self._foot = urwid.Text(KEYS)
        self._frame = urwid.Frame(urwid.ListBox(self._listed), self._head, self._foot)
        self._loop = urwid.MainLoop(self._frame, _PALETTE, unhandled_input=self._on_key,
                                    handle_mouse=False)
        self.why = ''
        """Why it ended; empty: somebody has quit."""

    def run(self) -> None:
        """Draw until it is over."""
        self._draw()
        self._loop.set_alarm_in(_EVERY_S, self._on_time)
        self._loop.run()

    def _on_time(self, *_: Any) -> None:
        self.why = self._is_over()
        if self.why:
            raise urwid.ExitMainLoop()
        if not self._paused:
            self._shown = self._said()
        self._draw()
        self._loop.set_alarm_in(_EVERY_S, self._on_time)

    def _draw(self) -> None:
        width = self._loop.screen.get_cols_rows()[0]
        above = [*lines.head(self._shown, width, self._paused),
                 *lines.incidents(self._shown, width),
                 lines.component_head(self._sort, self._pattern, width)]
        self._head.contents = [(urwid.Text(line, wrap='clip'), ('pack', None)) for line in above]
        focus = self._focus()
        found = self._shown.components(self._sort, self._pattern)
        self._names = [each.name for each in found]
        self._listed[:] = [urwid.AttrMap(_Row(lines.component(each, width)), None, 'head')
                           for each in found]
        if focus in self._names:  # the selection goes with its component
            self._listed.set_focus(self._names.index(focus))

    def _focus(self) -> str:
        at = self._listed.focus
        return self._names[at] if self._names and at < len(self._names) else ''

    def _on_key(self, key: str) -> None:
        if self._frame.focus_position == 'footer':
            self._on_filter(key)
        elif self._if_yes is not None:
            call, self._if_yes = self._if_yes, None
            self._say(call() if key in ('y', 'Y') else 'not accepted')
        elif key in ('q', 'Q'):
            raise urwid.ExitMainLoop()
        elif key == 's':
            self._sort = SORTS[(SORTS.index(self._sort) + 1) % len(SORTS)]
        elif key == 'p':
            self._paused = not self._paused
        elif key == 'f':
            self._asked.set_edit_text(self._pattern)
            self._frame.footer, self._frame.focus_position = self._asked, 'footer'
        elif key == 'm' and self._focus():
            self._say(self._calls['m'](self._focus(), _MUTE_S))
        elif key == 'a':
            self._on_accept()
        elif key in ('c', 'd'):
            self._say(self._calls[key]())
        self._draw()

    def _on_accept(self) -> None:
        alarm, strangers = self._shown.standing, self._shown.strangers

        def accept() -> str:
            return self._calls['a'](alarm, strangers)

        if self._shown.deaths:
            self._if_yes = accept
            self._say(f'accept it? {", ".join(self._shown.deaths)} may then die unseen (y/n)')
        elif alarm or strangers:
            self._say(accept())
        else:
            self._say('nothing stands, and nobody is new')

    def _on_filter(self, key: str) -> None:
        if key in ('enter', 'esc'):
            self._pattern = self._asked.edit_text if key == 'enter' else self._pattern
            self._frame.footer, self._frame.focus_position = self._foot, 'body'

    def _say(self, answer: str) -> None:
        width = self._loop.screen.get_cols_rows()[0]
        self._foot.set_text([lines.cut(answer, width), '\n', KEYS])


class _Row(urwid.Text):
    """A line of the table, which can be selected."""

    _selectable = True

    def __init__(self, line: lines.Line) -> None:
        super().__init__(line, wrap='clip')

    def keypress(self, _size: Any, key: str) -> str:
        """Leave all keys to the screen."""
        return key
