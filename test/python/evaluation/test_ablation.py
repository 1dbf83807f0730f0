"""`evaluate ablation`: the variants, the rows that are kept, and the page."""
from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path
from typing import Any, List

import numpy as np
import pytest

from self_awareness import Tuning
from self_awareness.stamps import SECOND_NS
from self_awareness.workers import InProcess
from self_awareness_evaluation import evaluate, row_files
from self_awareness_evaluation.ablation import bench as benches, experiment, figures, report
from self_awareness_evaluation.ablation.bench import (FAMILIES, OTHER, OWN, Bench, Fault, Plan,
                                                      Robot)
from self_awareness_evaluation.ablation.rows import Row, RowFile, judge
from self_awareness_evaluation.ablation.variants import (CHANNEL, DEFAULT, NUMBER, RULE, Variant,
                                                         variants)
from self_awareness_evaluation.detectors import Evidence
from self_awareness_evaluation.families.protocol import Learning, Records
from self_awareness_evaluation.families.robot import CRASH, RESTART
from self_awareness_evaluation.simulated.measures import NORMAL
from self_awareness_evaluation.systems import Judged, SystemAlarm

from evaluation_robot import START, robot

PLAN = Plan(('events_only',), (1,), (1,), (Learning.of(1, 60.0, 60.0),), 0.05, 1, None)
AS_IT_IS = Variant(DEFAULT)

# Whatever the method has: a channel, a rule, and numbers that can be halved and doubled.
SOME = Tuning.channels()[-1]
OFF = next(number for number in Tuning.numbers() if number.off is not None)
FIRST, SECOND = [number for number in Tuning.numbers() if number.off is None
                 and number.least < 0.5 * number.default < 2.0 * number.default < number.most
                 and number.default % 2.0 == 0.0][:2]


def test_the_method_as_it_is_comes_first_then_channels_rules_and_numbers() -> None:
    found = variants()
    kinds = [variant.kind for variant in found]
    assert kinds == sorted(kinds, key=(DEFAULT, CHANNEL, RULE, NUMBER).index)
    assert found[0] == AS_IT_IS and found[0].tuning() == Tuning()
    assert [variant.name for variant in found if variant.kind == CHANNEL] == Tuning.channels()
    assert ([variant.name for variant in found if variant.kind == RULE]
            == [each.name for each in Tuning.numbers() if each.off is not None])
    assert len({str(variant) for variant in found}) == len(found)


def test_every_variant_is_a_method_of_its_own() -> None:
    for variant in variants()[1:]:
        assert variant.tuning() != Tuning(), variant
    assert Variant(CHANNEL, SOME).tuning().without == [SOME]
    assert Variant(NUMBER, FIRST.name, FIRST.most).tuning().get(FIRST.name) == FIRST.most


def test_numbers_are_halved_and_doubled_within_their_range() -> None:
    for each in Tuning.numbers():
        values = [variant.value for variant in variants([], [each.name])
                  if variant.kind == NUMBER]
        assert len(values) <= 2 and each.default not in values and each.off not in values
        assert all(each.least <= value <= each.most for value in values)
        if not each.unit and float(each.default).is_integer():
            assert all(value.is_integer() for value in values)
    assert variants([], [FIRST.name])[1:] == [
        Variant(NUMBER, FIRST.name, factor * FIRST.default) for factor in (0.5, 2.0)]


def test_only_what_is_asked_for_is_changed() -> None:
    assert variants([], []) == [AS_IT_IS]
    assert variants([SOME], []) == [AS_IT_IS, Variant(CHANNEL, SOME)]
    assert {variant.kind for variant in variants(kinds=[RULE])} == {DEFAULT, RULE}
    with pytest.raises(ValueError, match='smell'):
        variants(['smell'], [])
    with pytest.raises(ValueError, match='luck'):
        variants([], ['luck'])


def small_bench() -> Bench:
    """Return a robot whose fast topic falls silent."""
    silent = robot(40.0, 4, silent=((20.0, 40.0),))
    return Bench([Robot(FAMILIES, 'small 1', set(), 'two', [robot(60.0, 1), robot(60.0, 2)],
                        [robot(60.0, 3)], [robot(60.0, 5)],
                        [Fault(CRASH, 'player', ('/player',), silent,
                               START + 20 * SECOND_NS)])], None)


def test_a_variant_is_measured_on_every_record() -> None:
    normal, crash = judge(small_bench(), AS_IT_IS)
    assert (normal.variant, normal.part, normal.robot, normal.learning, normal.kind) == (
        'default', FAMILIES, 'small 1', 'two', NORMAL)
    assert normal.hours == pytest.approx(55.0 / 3600.0, rel=0.01)
    assert (normal.alarms, normal.latency_s, normal.refused) == (0, None, '')
    assert (crash.kind, crash.name, crash.first) == (CRASH, 'player', True)
    assert crash.latency_s is not None and 0.0 < crash.latency_s < 1.0
    assert crash.hours == pytest.approx(15.0 / 3600.0, rel=0.02)  # what was before the onset
    _, blind = judge(small_bench(), Variant(CHANNEL, 'overdue'))
    assert blind.latency_s is None or blind.latency_s > crash.latency_s


def test_alarms_for_who_is_back_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = small_bench()
    crash = replace(bench.robots[0].faults[0], back=START + 22 * SECOND_NS)
    late = [SystemAlarm(START + second * SECOND_NS, START + 39 * SECOND_NS, True, ['/player'])
            for second in (21, 26, 28)]
    monkeypatch.setattr(Evidence, 'judge', lambda self, recording: Judged(
        np.arange(2), np.zeros(2, bool), np.zeros(2), np.zeros(2, bool), late, -1.0,
        np.zeros(2, bool)))
    _, found = judge(Bench([replace(bench.robots[0], faults=[crash])], None), AS_IT_IS)
    assert (found.latency_s, found.after) == (1.0, 1)
    cells = figures.cells([found, row(kind=RESTART, after=2)])
    assert cells['alarms after a restart'].text == '3 after 2'


def test_where_no_limits_can_be_found_nothing_is_judged() -> None:
    few = replace(small_bench().robots[0], training=[robot(8.0, 1)], calibration=[robot(8.0, 3)])
    rows = judge(Bench([few], None), AS_IT_IS)
    assert len(rows) == 2 and all(row.refused and row.latency_s is None for row in rows)
    assert figures.refused(rows) == [f'small 1, two: {rows[0].refused}']


def row(variant: str = 'default', **changed: Any) -> Row:
    return replace(Row(variant, FAMILIES, 'small 1', 'two', NORMAL, hours=1.0), **changed)


def test_rows_are_kept_and_a_torn_line_is_not(tmp_path: Path) -> None:
    path = tmp_path / 'rows.csv'
    some = Variant(CHANNEL, SOME)
    rows = RowFile(path)
    rows.add(AS_IT_IS, [row(), row(kind=CRASH, latency_s=0.25, first=True)])
    rows.add(some, [row(str(some), refused='too short; or so')])
    again = RowFile(path)
    assert again[AS_IT_IS] == rows[AS_IT_IS] and again[some] == rows[some]
    text = path.read_text(encoding='utf-8')
    path.write_text(text[:-20], encoding='utf-8')
    torn = RowFile(path)
    assert torn[some] == [] and torn[AS_IT_IS] == rows[AS_IT_IS]
    torn.add(some, rows[some])
    assert path.read_text(encoding='utf-8') == text
    torn.add(some, [row(str(some))])  # those of before are replaced
    assert RowFile(path)[some] == [row(str(some))]


def test_a_file_of_something_else_is_told(tmp_path: Path) -> None:
    path = tmp_path / 'rows.csv'
    path.write_text('a,b\n1,2\n', encoding='utf-8')
    with pytest.raises(ValueError, match='rows.csv, line 2'):
        RowFile(path)


@pytest.fixture(name='judged')
def _judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Let variants leave a file in this folder when they judge, in whichever process."""
    folder = tmp_path / 'judged'
    folder.mkdir()

    def told(_: Bench, variant: Variant) -> List[Row]:
        (folder / str(variant)).touch()
        return [row(str(variant)), row(str(variant), kind=CRASH, latency_s=0.25)]

    monkeypatch.setattr(benches, 'make', lambda plan, jobs: small_bench())
    monkeypatch.setattr(experiment, 'judge', told)
    return folder


def test_an_interrupted_run_goes_on(judged: Path, tmp_path: Path) -> None:
    path = tmp_path / 'ablation.csv'
    three = [AS_IT_IS, Variant(CHANNEL, SOME), Variant(NUMBER, FIRST.name, FIRST.most)]
    experiment.run(PLAN, three[:2], path, 2)
    for file in judged.iterdir():
        file.unlink()
    results = experiment.run(PLAN, three, path, 2)
    # The method as it is was judged again, to see that it is the same.
    assert {file.name for file in judged.iterdir()} == {'default', str(three[2])}
    assert list(results) == three and all(len(rows) == 2 for rows in results.values())


def test_rows_of_another_plan_or_method_are_refused(judged: Path, tmp_path: Path,
                                                    monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / 'ablation.csv'
    experiment.run(PLAN, [AS_IT_IS], path, 1)
    with pytest.raises(ValueError, match='ablation.csv: of another plan'):
        experiment.run(replace(PLAN, hours=0.1), [AS_IT_IS], path, 1)
    monkeypatch.setattr(experiment, 'judge', lambda *_: [row(alarms=1)])
    with pytest.raises(ValueError, match='ablation.csv: the method was another one'):
        experiment.run(PLAN, [AS_IT_IS], path, 1)
    assert judged.is_dir()


def test_the_page_marks_what_differs() -> None:
    default = [row(), row(kind=CRASH, hours=0.0, latency_s=0.25, first=True)]
    late = [row(), replace(default[1], latency_s=7.0, first=False)]
    half, double = (factor * FIRST.default for factor in (0.5, 2.0))
    results = {AS_IT_IS: default, Variant(CHANNEL, SOME): default,
               Variant(RULE, OFF.name, OFF.off): late, Variant(NUMBER, FIRST.name, half): late,
               Variant(NUMBER, FIRST.name, double): default,
               Variant(NUMBER, SECOND.name, SECOND.most): default}
    page = report.page(PLAN, results, 'rosrun self_awareness evaluate ablation')
    lines = page.splitlines()
    crash = '1 / 1 of 1, 0.25 s'
    nothing = ' | '.join('–' * 9)
    for told in ('as it is', f'without {SOME}'):
        assert (f'| {told} | 0 in 1.0 h | 0 in 1.0 h | {crash} | {nothing} | 1 of 1 |'
                in lines)
    assert (f'| {OFF.name} off | 0 in 1.0 h | 0 in 1.0 h | **0 / 1 of 1, 7.00 s** '
            f'| {nothing} | **0 of 1** |' in lines)
    changed = next(line for line in lines if line.startswith(f'| `{FIRST.name}`'))
    assert changed.endswith(
        f' | {half:g}: crashes, within 5 s / at all 0 / 1 of 1, 7.00 s, guilty first 0 of 1 '
        f'| {double:g}: – |')
    assert f'Changed nothing: `{SECOND.name}` ({SECOND.most:g}).' in lines


def test_figures_tell_small_differences_as_the_same() -> None:
    default = [row(), row(kind=OTHER, latency_s=0.5)]
    for changed, differs in ((0.54, False), (0.6, True), (None, True)):
        other = [default[0], replace(default[1], latency_s=changed)]
        cells = [figures.cells(rows)['other faults'] for rows in (default, other)]
        assert cells[1].differs(cells[0]) == differs


def test_faults_are_spread_over_the_components() -> None:
    records = Records('bursty', 3)
    every = [fault.source for fault in records.faults((CRASH,))]
    some = [fault.source for fault in records.faults((CRASH,), 3)]
    assert some == [every[0], every[len(every) // 3], every[2 * len(every) // 3]]
    assert [fault.source for fault in records.faults((CRASH,), 1000)] == every


def test_robots_learn_in_turn_from_few_starts_and_many(monkeypatch: pytest.MonkeyPatch) -> None:
    wanted = []

    def simulated(_: Plan, robot_wanted: Any) -> Robot:
        wanted.append((robot_wanted.name, robot_wanted.seed, robot_wanted.learning.starts))
        return small_bench().robots[0]

    monkeypatch.setattr(benches, '_robot', simulated)
    monkeypatch.setattr(benches, 'Processes', lambda jobs: InProcess())
    two, four = (Learning.of(starts, 60.0, 60.0) for starts in (2, 4))
    benches.make(Plan(('timers', 'bursty', 'wander'), (1, 2), (7,), (two, four), 0.05, 1, None), 1)
    assert wanted == [(OWN, 7, 2), ('timers', 1, 2), ('bursty', 1, 4), ('wander', 1, 2),
                      ('timers', 2, 4), ('bursty', 2, 2), ('wander', 2, 4)]


def test_the_command_writes_a_page_and_its_figures(tmp_path: Path,
                                                   monkeypatch: pytest.MonkeyPatch) -> None:
    own = replace(small_bench().robots[0], part=OWN, name='own robot 3')
    monkeypatch.setattr(benches, '_own', lambda wanted: own)
    output = tmp_path / 'new'
    arguments = ['ablation', '--families', 'events_only', '--seed', '3', '--own-seeds', '1',
                 '--starts', '1', '--training', '60', '--calibration', '60', '--hours', '0.1',
                 '--faults', '1', '--channels', 'overdue', '--numbers', FIRST.name,
                 '--jobs', '2', '-o', str(output)]
    assert evaluate.main(arguments) == 0
    page = (output / 'ablation.md').read_text(encoding='utf-8')
    assert 'evaluate ablation --families events_only --seed 3' in page
    assert '| without overdue |' in page and f'`{FIRST.name}`' in page
    assert 'nan' not in page and 'inf' not in page.replace('info', '')
    with open(output / 'ablation.csv', encoding='utf-8', newline='') as file:
        rows = list(csv.DictReader(file))
    assert [(each['variant'], each['part']) for each in rows] == [
        (str(variant), part) for variant in variants(['overdue'], [FIRST.name])
        for part in (FAMILIES, OWN)]
    assert rows[1]['crash_found'] == rows[1]['crash_records'] == '1'
    before = row_files.load(output / 'full' / 'ablation.csv', Row)
    assert evaluate.main(arguments) == 0  # all is done already
    assert row_files.load(output / 'full' / 'ablation.csv', Row) == before


@pytest.mark.parametrize('wrong', [['--channels', 'smell'], ['--numbers', 'luck'],
                                   ['--families', 'cars'], ['--data', '/nowhere']])
def test_wrong_arguments_are_refused(wrong: List[str], tmp_path: Path, capsys: Any) -> None:
    assert evaluate.main(['ablation', '-o', str(tmp_path / 'out'), *wrong]) in (1, 2)
    assert wrong[1] in capsys.readouterr().err
    assert not (tmp_path / 'out').exists()
