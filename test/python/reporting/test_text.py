"""Numbers as people read them."""
from __future__ import annotations

import math
from typing import Optional

import pytest

from self_awareness.reporting.text import of_limit, rounded


@pytest.mark.parametrize('value, digits, text', [
    (1234.0, 2, '1200'), (0.0116, 2, '0.012'), (18.2, 2, '18'), (0.0, 2, '0'), (997.0, 2, '1000'),
    (86.4, 3, '86.4'), (12345.0, 3, '12300'), (999_999.0, 2, '1e+06')])
def test_a_number_has_no_exponent_that_nobody_needs(value: float, digits: int, text: str) -> None:
    assert rounded(value, digits) == text


@pytest.mark.parametrize('score, threshold, text', [
    (-1.104, -1.0, '110 % of the limit'), (-0.0, -1.0, '0 % of the limit'),
    (0.0, -1.0, '0 % of the limit'), (-95.16, -1.0, '9516 % of the limit'),
    (0.25, 0.5, 'lowest score 0.25, threshold 0.5'), (0.25, None, 'lowest score 0.25'),
    (math.nan, 0.5, 'lowest score none, threshold 0.5')])
def test_only_the_evidence_detector_has_a_percentage_of_its_limit(
        score: float, threshold: Optional[float], text: str) -> None:
    assert of_limit(score, threshold) == text
