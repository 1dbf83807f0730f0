"""Options that several parts of `evaluate` have, and what their arguments may be."""
from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, Callable, Dict

from self_awareness.commands import cli


def add(parser: argparse.ArgumentParser, name: str, kind: Callable[[str], Any], default: Any,
        metavar: str, told: str) -> None:
    """Add an option with a default; several values, where that is a sequence."""
    several = isinstance(default, (list, tuple))
    shown = ' '.join(map(str, default)) if several else str(default).replace('.0', '')
    more: Dict[str, Any] = {'nargs': '+'} if several else {}
    parser.add_argument(name, type=kind, default=default, metavar=metavar,
                        help=f'{told} (default: {shown})', **more)


def add_output(parser: argparse.ArgumentParser, written: str,
               default: str = 'docs/evaluation') -> None:
    """Add the option that says where results go; written: what they are."""
    parser.add_argument('-o', '--output', type=Path, default=Path(default), metavar='DIR',
                        help=f'where {written} go (default: {default})')


def within(least: float, most: float, what: str) -> Callable[[str], float]:
    """Return an argument type: a number of something in a range."""
    def convert(text: str) -> float:
        value = float(text)
        if not least <= value <= most:
            raise ValueError(f'expected {what} from {least:g} to {most:g}, not {text}')
        return value
    return cli.checked(convert)
