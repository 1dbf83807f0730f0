"""The screen of `top`, drawn by urwid."""
from __future__ import annotations

import queue
import threading
import time
from functools import partial
from typing import Any, Callable, Dict, List, Optional, Tuple

import urwid

from self_awareness.live_view import lines
from self_awareness.live_view.said import SORTS, Said

KEYS = 'q quit  s sort  f filter  p pause  m mute  u unmute  a accept  c clear  d dump'
"""The last line."""

_EVERY_S = 0.5
_MUTE_S = 600.0
# The monitor answers within a tenth of a second; a call that is not answered keeps others waiting
# for no longer.
_SLOW_S, _GIVEN_UP_S = 2.0, 10.0
_PALETTE = [('head', 'default,bold', 'default'), ('OK', 'dark green', 'default'),
            ('WARN', 'yellow', 'default'), ('ERROR', 'light red,bold', 'default'),
            ('STALE', 'dark cyan', 'default'), ('faint', 'dark gray', 'default')]
_SELECTED = {None: 'selected', '': 'selected',
             **{style: f'selected {style}' for style, _, _ in _PALETTE}}
_PALETTE_SELECTED = [('selected', 'default,standout', 'default', 'standout'),
                     *((_SELECTED[style], f'{color},standout', background, 'standout')
                       for style, color, background in _PALETTE)]


class Screen:
    """Shows what was said until the operator quits, or the robot is gone."""

    def __init__(self, said: Callable[[], Said], is_over: Callable[[], str],
                 calls: Dict[str, Callable[..., str]]) -> None:
        """Nothing is drawn yet.

        Args:
            said: what is shown now.
            is_over: why nothing more will come; empty: it goes on.
            calls: by key c and d, what it does, by m, what mutes a component for some seconds
                (0: takes that back), and by a, what accepts the alarm of an id, or, where that is
                0, strangers; they return what came of it, and may take as long as they like.
        """
        self._said, self._is_over = said, is_over
        self._calls = {key: self._in_thread(call) for key, call in calls.items()}
        self._answers: queue.SimpleQueue[Tuple[float, str]] = queue.SimpleQueue()
        self._called_at: Optional[float] = None  # steady [s]; None: all is answered
        self._shown = said()
        self._sort, self._pattern, self._paused = SORTS[0], '', False
        self._names: List[str] = []
        self._muted = ''  # who was muted last; empty: nobody
        self._if_yes: Optional[Callable[[], str]] = None  # what an answer is awaited for
        self._listed = urwid.SimpleFocusListWalker([])
        self._head = urwid.Pile([urwid.Text('')])
        self._asked = urwid.Edit('filter: ')
        self._foot = urwid.Text(KEYS)
        self._frame = urwid.Frame(urwid.ListBox(self._listed), self._head, self._foot)
        self._loop = urwid.MainLoop(self._frame, [*_PALETTE, *_PALETTE_SELECTED],
                                    unhandled_input=self._on_key, handle_mouse=False)
        self.why = ''  # why it ended; empty: somebody has quit

    def run(self) -> None:
        """Draw until it is over."""
        self._draw()
        self._loop.set_alarm_in(_EVERY_S, self._on_time)
        self._loop.run()

    def _on_time(self, *_: Any) -> None:
        self.why = self._is_over()
        if self.why:
            raise urwid.ExitMainLoop()
        latest = self._said()
        if self._paused:
            self._shown.heard_at = latest.heard_at  # whether it lives is shown all the same
        else:
            self._shown = latest
        self._take_answers()
        self._draw()
        self._loop.set_alarm_in(_EVERY_S, self._on_time)

    def _draw(self) -> None:
        width = self._loop.screen.get_cols_rows()[0]
        above = [*lines.head(self._shown, width, self._paused),
                 *lines.incidents(self._shown, width),
                 lines.component_head(self._sort, self._pattern, width)]
        self._head.contents = [(urwid.Text(line, wrap='clip'), ('pack', None)) for line in above]
        # Whoever has moved nothing sees the first line, where who fails is.
        focus = self._focus() if self._listed.focus else ''
        found = self._shown.components(self._sort, self._pattern)
        self._names = [each.name for each in found]
        self._listed[:] = [urwid.AttrMap(_Row(lines.component(each, width)), None, _SELECTED)
                           for each in found]
        if found:  # the selection goes with its component
            self._listed.set_focus(self._names.index(focus) if focus in self._names else 0)

    def _focus(self) -> str:
        at = self._listed.focus
        return self._names[at] if self._names and at < len(self._names) else ''

    def _on_key(self, key: str) -> None:
        if self._frame.focus_position == 'footer':
            self._on_filter(key)
        elif self._if_yes is not None:
            call, self._if_yes = self._if_yes, None
            self._say(call() if key in ('y', 'Y') else 'not done')
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
            self._ask_to_mute(self._focus())
        elif key == 'u':
            self._say(self._calls['m'](self._muted, 0.0) if self._muted
                      else 'nobody was muted here')
        elif key == 'a':
            self._on_accept()
        elif key in ('c', 'd'):
            self._say(self._calls[key]())
        self._draw()

    def _ask_to_mute(self, component: str) -> None:
        def mute() -> str:
            self._muted = component
            return self._calls['m'](component, _MUTE_S)

        self._if_yes = mute
        self._say(f'mute {component} for {_MUTE_S / 60.0:.0f} minutes? (y/n)')

    def _on_accept(self) -> None:
        alarm, strangers = self._shown.standing, self._shown.strangers
        if not alarm and not strangers:
            self._say('nothing stands, and nobody is new')
            return
        # What is shown may change before the key is seen, and an alarm has named more than its
        # last window does.
        self._if_yes = partial(self._calls['a'], alarm, strangers)
        if not alarm:
            self._say(f'accept {len(strangers)} that are new? (y/n)')
            return
        who = ', '.join(self._shown.deaths) or 'who has died since it was raised'
        self._say(f'accept it? {who} may then die unseen (y/n)')

    def _on_filter(self, key: str) -> None:
        if key in ('enter', 'esc'):
            self._pattern = self._asked.edit_text if key == 'enter' else self._pattern
            self._frame.footer, self._frame.focus_position = self._foot, 'body'

    def _in_thread(self, call: Callable[..., str]) -> Callable[..., str]:
        """Return what makes a call without waiting for its answer: keys go on meanwhile."""
        def start(*arguments: Any) -> str:
            now = time.monotonic()
            if self._called_at is not None and now - self._called_at < _GIVEN_UP_S:
                return 'not done: the call before is not answered yet'
            self._called_at = now
            threading.Thread(target=lambda: self._answers.put((now, call(*arguments))),
                             daemon=True).start()
            return 'asked ...'
        return start

    def _take_answers(self) -> None:
        while not self._answers.empty():
            called_at, answer = self._answers.get()
            if called_at == self._called_at:
                self._called_at = None
            self._say(answer)
        waited = 0.0 if self._called_at is None else time.monotonic() - self._called_at
        if waited > _SLOW_S:
            self._say(f'no answer for {waited:.0f} s')

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
