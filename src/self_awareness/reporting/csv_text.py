"""Texts in tables that a spreadsheet may open."""
from __future__ import annotations

_FORMULA = ('=', '+', '-', '@')


def cell(text: str) -> str:
    """Return a text that a spreadsheet shows and does not compute: a bag may be called `=1+1`."""
    return f"'{text}" if text.startswith(_FORMULA) else text
