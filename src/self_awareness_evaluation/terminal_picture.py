"""Draws what a program shows in a terminal of 80 columns, 3 s after it shows a text; then ends it.

usage: python3 -m self_awareness_evaluation.terminal_picture FILE.png TEXT COMMAND...
"""
from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from typing import Any, Callable, List, Tuple

import matplotlib

matplotlib.use('Agg')  # before pyplot

import urwid  # noqa: E402
import urwid.vterm  # noqa: E402
from matplotlib import pyplot  # noqa: E402

urwid.set_encoding('utf8')
COLUMNS, ROWS = 80, 24
AFTER_S, AT_MOST_S = 3.0, 300.0
# A terminal of the type linux has bold ones for light ones, and urwid.vterm knows no others.
COLORS = {'dark green': '#4ec94e', 'brown': '#e5c07b', 'dark red': '#ff6b6b',
          'dark cyan': '#56b6c2', 'black': '#8a8f98'}
Row = List[Tuple[str, bool, str]]  # colors, whether they are bold, and texts
PLAIN, PAPER = '#dcdfe4', '#1e2127'


class Quiet:
    """What a terminal would do besides drawing."""

    term_modes = urwid.vterm.TermModes()

    def __getattr__(self, _name: str) -> Callable[..., None]:
        def nothing(*_: Any) -> None:
            pass
        return nothing


def drawn_by(command: List[str], text: str) -> urwid.vterm.TermCanvas:
    """Run the command until it shows the text, and a little longer; return its last screen."""
    screen = urwid.vterm.TermCanvas(COLUMNS, ROWS, Quiet())
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack('HHHH', ROWS, COLUMNS, 0, 0))
    process = subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs,
                               start_new_session=True,
                               env=dict(os.environ, TERM='linux', LC_ALL='C.UTF-8'))
    os.close(theirs)
    end, shown = time.monotonic() + AT_MOST_S, False
    while time.monotonic() < end and process.poll() is None:
        if select.select([ours], [], [], 0.1)[0]:
            # Of a bold color, urwid.vterm forgets the color.
            screen.addstr(re.sub(rb'(;1)+(?=;3[0-7])|(?<=;3[0-7]);1(?=;)', b'',
                                 os.read(ours, 65536)))
        if not shown and any(text in ''.join(words for _, _, words in row)
                             for row in rows_of(screen)):
            end, shown = time.monotonic() + AFTER_S, True
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    os.close(ours)
    if not shown:
        sys.exit(f'terminal_picture: error: it did not show "{text}"')
    return screen


def rows_of(screen: urwid.vterm.TermCanvas) -> List[Row]:
    """Return what is on it."""
    rows = []
    for line in screen.content():
        row: Row = []
        for attribute, _, text in line:
            style = attribute.foreground if attribute is not None else 'default'
            color = next((COLORS[name] for name in COLORS if name in style), PLAIN)
            row.append((color, 'bold' in style, text.decode('utf-8', 'replace')))
        rows.append(row)
    return rows


def draw(rows: List[Row], file: str) -> None:
    """Draw what rows_of() returns."""
    wide, high = 0.0723, 0.158  # of a character of 9 points [inch]
    figure = pyplot.figure(figsize=(wide * (COLUMNS + 2), high * (len(rows) + 1)),
                           facecolor=PAPER)
    for at, row in enumerate(rows):
        column = 0
        for color, bold, text in row:
            for letter in text:  # one by one: no font is as regular as a terminal
                if letter != ' ':
                    figure.text((column + 1) / (COLUMNS + 2),
                                1 - (at + 1.1) / (len(rows) + 1), letter, color=color, size=9,
                                family='DejaVu Sans Mono', weight='bold' if bold else 'normal')
                column += 1
    figure.savefig(file, dpi=110, facecolor=PAPER, pil_kwargs={'optimize': True})


def main() -> None:
    """Run the program."""
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    screen = drawn_by(sys.argv[3:], sys.argv[2])
    draw(rows_of(screen), sys.argv[1])


if __name__ == '__main__':
    main()
