"""The statistics of a comparison: what is chance, and what is not."""
from __future__ import annotations

import math

import numpy as np
import pytest

from self_awareness.comparison import chance


@pytest.mark.parametrize('freedom, t, p', [
    (2, 4.3027, 0.05), (10, 2.2281, 0.05), (10, 4.5869, 0.001), (10, 0.0, 1.0), (8, 3.3554, 0.01)])
def test_student_as_in_the_tables(freedom: int, t: float, p: float) -> None:
    assert chance.student_tail(t, freedom) == pytest.approx(p, rel=1e-3)


def test_large_values_of_student_are_no_less_than_0() -> None:
    values = [chance.student_tail(10.0 ** power, 10) for power in range(8)]
    assert all(0.0 <= after <= before + 1e-12 for before, after in zip(values, values[1:]))


def test_inflation_follows_the_halves() -> None:
    rng = np.random.default_rng(1)
    by_chance = (rng.normal(size=1000) ** 2).tolist()
    assert chance.common_inflation(by_chance) == pytest.approx(1.0, abs=0.15)
    assert chance.common_inflation([9.0 * each for each in by_chance]) == pytest.approx(9.0,
                                                                                        rel=0.15)
    assert chance.common_inflation([]) == 1.0
    # One quantity that changed between the halves says nothing of the others.
    assert chance.common_inflation([*by_chance, 1e9]) == pytest.approx(1.0, abs=0.15)


def test_chance_is_listed_at_most_as_often_as_the_level_says() -> None:
    """10,000 quantities whose halves vary three times as much as their counts do."""
    rng = np.random.default_rng(2)
    number, spread = 10_000, 3.0
    halves = rng.normal(scale=spread, size=(number, 2, 2))
    excesses = [[chance.excess(side.tolist(), (1.0, 1.0)) for side in each] for each in halves]
    common = chance.common_inflation(np.concatenate(excesses).tolist())
    p_values = [chance.p_value(float(sides[1].mean() - sides[0].mean()), 1.0,
                               (own[0], own[1]), common)
                for sides, own in zip(halves, excesses)]
    assert 0.001 < np.mean(np.array(p_values) < 0.01) < 0.01


def test_what_differs_between_the_halves_is_less_certain() -> None:
    steady = chance.p_value(10.0, 1.0, (1.0, 1.0), 1.0)
    wild = chance.p_value(10.0, 1.0, (400.0, 1.0), 1.0)
    assert steady < 1e-4 < 0.01 < wild


def test_variances_of_counts() -> None:
    # 100 s of 20 Hz: 50 spans of 2 s; a timer has half an event of doubt at each cut.
    assert chance.rate_variance(0.0, 2.0, 100.0) == pytest.approx(0.25 / 200.0)
    assert chance.share_variance(0.0, 30) > 0.0
    assert chance.share_variance(0.5, 10_000) == pytest.approx(0.25 / 10_000)
    assert math.isclose(chance.excess((1.0, 4.0), (2.0, 1.0)), 3.0)
