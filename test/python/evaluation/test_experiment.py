"""Variants judge records: what there is of them, what is kept, and what is refused."""
from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import List, Set, Tuple

import pytest

from self_awareness import Tuning
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation import experiment
from self_awareness_evaluation import variants as frame
from self_awareness_evaluation.experiment import Unit
from self_awareness_evaluation.families.protocol import Records, recorded
from self_awareness_evaluation.records import FAMILIES, NORMAL, FaultRecord, Learning, Robot
from self_awareness_evaluation.rows import Row
from self_awareness_evaluation.systems import Evidence
from self_awareness_evaluation.variants import Variant, one_by_one, side_by_side, tuning_of

from evaluation_robot import START, robot

TWO = Learning.of(2, 60.0, 60.0)
AS_IT_IS = Variant('evidence', TWO)

# Whatever the method has: a channel, and a number that can be halved and doubled.
SOME = Tuning.channels()[-1]
FIRST = next(number for number in Tuning.numbers() if number.off is None
             and number.least < 0.5 * number.default < 2.0 * number.default < number.most
             and number.default % 2.0 == 0.0)


def test_the_method_as_it_is_comes_first_then_channels_rules_and_numbers() -> None:
    found = one_by_one()
    assert found[0] == Variant('evidence')
    assert [variant.change.partition('=')[0] for variant in found if not variant.is_number] == [
        '', *(f'without {name}' for name in Tuning.channels()),
        *(each.name for each in Tuning.numbers() if each.off is not None)]
    assert [variant.is_number for variant in found] == sorted(
        variant.is_number for variant in found)
    methods = [tuning_of(variant.change) for variant in found]
    assert methods[0] == Tuning() and all(method != Tuning() for method in methods[1:])
    assert len({variant.change for variant in found}) == len(found)


def test_numbers_are_halved_and_doubled_within_their_range() -> None:
    for each in Tuning.numbers():
        values = [float(variant.change.partition('=')[2])
                  for variant in one_by_one([], [each.name]) if variant.is_number]
        assert len(values) <= 2 and each.default not in values
        assert all(each.least <= value <= each.most for value in values)
        if not each.unit and float(each.default).is_integer():
            assert all(value.is_integer() for value in values)


def test_only_what_is_asked_for_is_changed() -> None:
    assert [variant.change for variant in one_by_one([SOME], [FIRST.name])] == [
        '', f'without {SOME}', *(f'{FIRST.name}={factor * FIRST.default:g}'
                                 for factor in (0.5, 2.0))]
    with pytest.raises(ValueError, match='smell'):
        one_by_one(['smell'], [])
    with pytest.raises(ValueError, match='luck'):
        one_by_one([], ['luck'])


def small(seconds: float = 60.0) -> Robot:
    """Return a robot whose fast topic falls silent."""
    crash = FaultRecord('crash', ('/player',), robot(40.0, 4, silent=((20.0, 40.0),)),
                        START + 20 * SECOND_NS)
    return Robot({'/player', '/power'}, set(), lambda _: [robot(seconds, 1), robot(seconds, 2)],
                 lambda _: [robot(seconds, 3)], lambda: [robot(60.0, 5)], lambda: [crash])


def unit(*variants: Variant) -> Unit:
    return Unit(lambda unit: experiment.measure(small, unit), FAMILIES, 'small 1',
                variants or (AS_IT_IS,))


def test_a_variant_is_measured_on_every_record() -> None:
    blind = replace(AS_IT_IS, change='without overdue')
    normal, _, crash, unseen = experiment.measure(small, unit(AS_IT_IS, blind))
    assert (normal.subject.robot, normal.subject.learning, normal.fault) == (
        'small 1', '2 x 60 s + 1 x 60 s', NORMAL)
    assert normal.hours == pytest.approx(55.0 / 3600.0, rel=0.01)
    assert (normal.alarms, normal.latency_s, normal.refused, normal.watched, normal.components) \
        == (0, None, '', 2, 2)
    assert (crash.fault, crash.source, crash.first, crash.watched) == ('crash', '/player', True, 1)
    assert crash.latency_s is not None and 0.0 < crash.latency_s < 1.0
    assert crash.hours == pytest.approx(15.0 / 3600.0, rel=0.02)  # what was before the onset
    assert unseen.subject.change == 'without overdue'
    assert unseen.latency_s is None or unseen.latency_s > crash.latency_s


def test_where_no_limits_can_be_found_nothing_is_judged() -> None:
    rows = list(experiment.measure(partial(small, 8.0), unit()))
    assert len(rows) == 2 and all(row.refused and row.latency_s is None for row in rows)


def test_the_detector_gets_the_graph_of_the_robot_and_the_budget(
        monkeypatch: pytest.MonkeyPatch) -> None:
    made = []

    class Told(Evidence):
        """Remembers what it was told."""

        def __init__(self, graph: Set[Tuple[str, str, str]], budget: float,
                     tuning: Tuning) -> None:
            super().__init__(graph, budget=budget, tuning=tuning)
            made.append((graph, budget))

    monkeypatch.setattr(frame, 'Evidence', Told)
    judges = side_by_side(('evidence', 'evidence_no_graph', 'gaps'), [TWO], budgets=(0.5, 5.0))
    assert [variant.faults for variant in judges] == [True, False, True, False, True]
    of_family = partial(recorded, 'events_only', 1, 0.1, ('crash',), 1)
    assert list(experiment.measure(
        of_family, Unit(lambda _: [], FAMILIES, 'events_only 1', tuple(judges))))
    graph = Records('events_only', 1).robot.graph
    assert made == [(graph, 0.5), (graph, 5.0), (set(), 0.5), (set(), 5.0)]


def counted_units(folder: Path, names: Tuple[str, ...], *variants: Variant) -> List[Unit]:
    """Return units that leave a file in the folder when they are measured, in any process."""
    folder.mkdir(exist_ok=True)

    def rows(unit: Unit) -> List[Row]:
        (folder / unit.name).touch()
        return [Row(unit.subject(variant), fault) for variant in unit.variants
                for fault in (NORMAL, 'crash')]

    return [Unit(rows, FAMILIES, name, variants or (AS_IT_IS,)) for name in names]


def test_an_interrupted_run_goes_on(tmp_path: Path) -> None:
    path, done = tmp_path / 'rows.csv', tmp_path / 'done'
    first = experiment.run(counted_units(done, ('a', 'b')), path, 'plan', 2)
    assert [(row.subject.robot, row.fault) for row in first] == [
        ('a', NORMAL), ('a', 'crash'), ('b', NORMAL), ('b', 'crash')]
    for name in ('a', 'b'):
        (done / name).unlink()
    # Some of a unit was written when the run was interrupted.
    with open(path, 'a', encoding='utf-8') as file:
        file.write('families,c,2 x 60 s + 1 x 60 s,evidence,,,normal\nfamilies,c,2 x')
    more = replace(AS_IT_IS, change=f'without {SOME}')
    units = counted_units(done, ('c', 'a'), AS_IT_IS, more)
    rows = experiment.run(units, path, 'plan', 2)
    assert {file.name for file in done.iterdir()} == {'a', 'c'}
    assert [(row.subject.robot, row.subject.change) for row in rows if row.fault == NORMAL] == [
        ('c', ''), ('c', more.change), ('a', ''), ('a', more.change)]
    whole = path.read_text(encoding='utf-8')
    assert experiment.run(units, path, 'plan', 2) == rows
    assert path.read_text(encoding='utf-8') == whole


def test_rows_of_another_plan_or_method_are_refused(tmp_path: Path,
                                                    monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / 'rows.csv'
    experiment.KeptRows(path, 'plan').add([])
    experiment.KeptRows(path, 'plan')
    with pytest.raises(ValueError, match='rows.csv: of another plan'):
        experiment.KeptRows(path, 'other')
    monkeypatch.setattr(experiment, '_method', lambda: 'another method')
    with pytest.raises(ValueError, match='another build of the method; remove it'):
        experiment.KeptRows(path, 'plan')
    monkeypatch.undo()
    path.with_suffix('.plan').unlink()
    with pytest.raises(ValueError, match='rows.csv: of another plan'):
        experiment.KeptRows(path, 'plan')
