"""Numbers as people read them."""
from __future__ import annotations


def rounded(value: float, digits: int) -> str:
    """Return a number with so many significant digits; without an exponent from 0.0001 to 999999.

    As `{value:.2g}`, which makes 1200 s to `1.2e+03 s`.
    """
    return f'{float(f"{value:.{digits}g}"):g}'
