"""Numbers as people read them."""
from __future__ import annotations

import pytest

from self_awareness.reporting.number_text import rounded


@pytest.mark.parametrize('value, digits, text', [
    (1234.0, 2, '1200'), (0.0116, 2, '0.012'), (18.2, 2, '18'), (0.0, 2, '0'), (997.0, 2, '1000'),
    (86.4, 3, '86.4'), (12345.0, 3, '12300'), (999_999.0, 2, '1e+06')])
def test_a_number_has_no_exponent_that_nobody_needs(value: float, digits: int, text: str) -> None:
    assert rounded(value, digits) == text
