from __future__ import annotations

from self_awareness import progress


def test_waiting_ends_where_no_bar_is_shown() -> None:
    passed = list(progress.waiting(0.25, 'a moment'))
    assert passed[-1] == 0.25
    assert passed == sorted(passed)
    assert len(passed) <= 3
