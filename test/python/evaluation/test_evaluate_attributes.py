"""`evaluate attributes`: what it runs, and what its page says."""
from __future__ import annotations

from pathlib import Path
from typing import Any, List, Optional

import pytest

from self_awareness_evaluation import evaluate, pages
from self_awareness_evaluation.simulated import attributes_command
from self_awareness_evaluation.simulated.experiment import Plan, Results
from self_awareness_evaluation.simulated.measures import NORMAL, Row
from self_awareness_evaluation.simulated.records import WITHIN_S


def fault(system: str, kind: str, alarm_s: Optional[float], noticed_s: Optional[float],
          first: Optional[bool]) -> Row:
    return Row(system, 1.0, 1, kind, 450, 0, 0, 0, latency_s=alarm_s, top1=first,
               noticed_s=noticed_s, noticed_first=first)


def rows(plan: Plan) -> List[Row]:
    """Return those of two seeds: evidence finds all once, and one thing late."""
    found = []
    for system in plan.systems:
        found += [Row(system, 1.0, seed, NORMAL, 6000, 0, int(system == 'sizes'), 0)
                  for seed in plan.seeds]
        for kind in plan.faults:
            finds = system == 'evidence' or (system, kind) == ('timestamps', 'stale:slam')
            is_alarm = finds and not kind.startswith('unsubscribed')
            found.append(fault(system, kind, 1.0 if is_alarm else None, 1.0 if finds else None,
                               finds or None))
            found.append(fault(system, kind, 20.0 if is_alarm else None, None, None))
    return found


def test_the_page_tells_what_was_found_in_time_and_by_whom(
        tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(attributes_command.experiment, 'run',
                        lambda plan, *_: Results(rows(plan)))
    assert evaluate.main(['attributes', '--seeds', '2', '--seed', '7', '-o', str(tmp_path)]) == 0
    text = (tmp_path / 'attributes.md').read_text(encoding='utf-8')
    assert '| `stale:slam` | 1.4 s | 1 of 2 | 2 of 2, 1.00 s | 20.00 s | 1 of 1 |' in text
    assert '| `lossy:camera` | 30 s | 2 of 2 |' in text
    assert '| `unsubscribed:navigation` | 65 s | 1 of 2 | 1 of 2, 1.00 s | 1.00 s |' in text
    lines = text.splitlines()
    of_stale = [line for line in lines if line.startswith('| `stale:slam` | 2 of 2')]
    assert of_stale == ['| `stale:slam` | 2 of 2, 1.00 s | 2 of 2, 1.00 s | 0 of 2 | 0 of 2 '
                        '| 0 of 2 |']
    false = [line.split(' | ') for line in lines if line.startswith('| false alarms')][0]
    assert [cell.split()[0] for cell in false[1:4]] == ['0', '0', '4.1']
    assert 'Seeds 7, 8: for each' in text and len(pages.written(text)) == 1
    assert (tmp_path / 'attributes.csv').read_text().count('\n') == 1 + 5 * (2 + 2 * 6)


def test_every_fault_of_messages_and_peers_of_them_are_run(monkeypatch: pytest.MonkeyPatch,
                                                           tmp_path: Path) -> None:
    plans: List[Plan] = []

    def run(plan: Plan, *_: Any) -> Results:
        plans.append(plan)
        return Results(rows(plan))

    monkeypatch.setattr(attributes_command.experiment, 'run', run)
    assert evaluate.main(['attributes', '--seeds', '1', '-o', str(tmp_path)]) == 0
    assert plans[0].faults == tuple(WITHIN_S) and len(WITHIN_S) == 6
    assert {'evidence', 'timestamps', 'sizes'} <= set(plans[0].systems)
