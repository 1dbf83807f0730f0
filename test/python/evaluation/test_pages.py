"""What is written of rows and measurements: pages, with which method, numbers of the README."""
from __future__ import annotations

import csv
import re
from dataclasses import replace
from pathlib import Path
from typing import Any, List, Optional

import pytest

from self_awareness import METHOD, Tuning
from self_awareness_evaluation import evaluate, pages
from self_awareness_evaluation.evaluate import PAGE, SECTION, Number, cell, measured
from self_awareness_evaluation.families.scene import CRASH, LATE, RESTART
from self_awareness_evaluation.figures import cells, rate_interval
from self_awareness_evaluation.pages import RESEARCH, RESULTS
from self_awareness_evaluation.records import FAMILIES, NORMAL, OWN, REAL
from self_awareness_evaluation.rows import Row, Subject
from self_awareness_evaluation.sections import ablation, families, recordings, simulated
from self_awareness_evaluation.variants import Variant, number_set

ROOT = Path(__file__).resolve().parents[3]
DOCS = ROOT / 'docs'

# What the README says with digits outside of its measured section, and is not measured: versions,
# what the package is made to do, and the report in the picture.
GIVEN = ROOT / 'test' / 'data' / 'readme_numbers_given.txt'


def _readme() -> str:
    return (ROOT / 'README.md').read_text(encoding='utf-8')


def test_the_numbers_of_the_readme_are_those_of_the_pages() -> None:
    """`rosrun self_awareness evaluate numbers` writes them again."""
    found = re.search(f'<!-- {SECTION} -->\n(.*?)\n<!-- /{SECTION} -->', _readme(), re.DOTALL)
    assert found is not None and found[1] == measured(DOCS)


def test_the_readme_has_no_other_number_that_could_be_measured() -> None:
    text = re.sub(f'<!-- {SECTION} -->.*?<!-- /{SECTION} -->', '', _readme(), flags=re.DOTALL)
    text = re.sub(r'```.*?```|`[^`\n]*`|\]\([^)]*\)', '', text, flags=re.DOTALL)
    given = GIVEN.read_text(encoding='utf-8').splitlines()
    for phrase in given:
        assert phrase in text, f'{GIVEN.name}: not in the README: {phrase}'
        text = text.replace(phrase, '')
    others: List[str] = re.findall(r'^.*\d.*$', text, re.MULTILINE)
    assert others == [], 'measured: name its cell in evaluate.py; else, in ' + GIVEN.name


@pytest.mark.parametrize('change, error', [
    ({'heading': 'Gone'}, "no heading 'Gone'"), ({'column': 'x'}, "no column 'x'"),
    ({'row': 'x'}, "no row 'x'")])
def test_a_cell_that_is_not_there_is_named(change: 'dict[str, str]', error: str) -> None:
    values = {'what': 'it', 'heading': 'Table', 'row': 'b', 'column': 'two'}
    page = ('# Page\n\n| | one | two |\n|---|---|---|\n\n'
            '## Table\n\n| | two |\n|---|---|\n| b | 7 |\n')
    assert cell(page, Number(**values)) == '7'
    with pytest.raises(ValueError, match=f'{PAGE}: {error}'):
        cell(page, Number(**{**values, **change}))


def test_a_number_that_changes_on_its_page_changes_in_the_readme(tmp_path: Path) -> None:
    (tmp_path / PAGE).parent.mkdir()
    (tmp_path / PAGE).write_text((DOCS / PAGE).read_text(encoding='utf-8').replace(
        '| silence | 100 %', '| silence | 12 %'))
    readme = tmp_path / 'README.md'
    readme.write_text(f'before\n<!-- {SECTION} -->\nold\n<!-- /{SECTION} -->\nafter\n')
    assert evaluate.main(['numbers', '--docs', str(tmp_path), '--readme', str(readme)]) == 0
    text = readme.read_text()
    assert '| all nodes fall silent | 12 %' in text and 'old' not in text
    assert text.startswith('before\n') and text.endswith('\nafter\n')


def test_pages_of_an_older_method_are_listed(tmp_path: Path, capsys) -> None:
    below = tmp_path / 'evaluation'
    below.mkdir()
    (below / 'new.md').write_text(f'# New\n\n{pages.written_by("evaluate new", "2026-11-23")}\n')
    (below / 'old.md').write_text('Written by `evaluate old --seed 1`; do not edit.\n')
    (tmp_path / 'other.md').write_text(
        f'{pages.written_by("evaluate soak").replace(str(METHOD), "1")} Seed 1.\n')
    (tmp_path / 'performance').mkdir()
    (tmp_path / 'performance' / 'core.json').write_text('{"date": "2026-11-22"}')
    (tmp_path / 'by_hand.md').write_text('# Nothing\n')
    assert evaluate.main(['pages', '--docs', str(tmp_path)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        f'ok   evaluation/new.md: method {METHOD}',
        'old  evaluation/old.md: an older method; measure it again: evaluate old --seed 1',
        'old  other.md: method 1; measure it again: evaluate soak',
        'old  performance/core.json: an older method; measure it again: scripts/benchmark core']
    assert evaluate.main(['pages', '--docs', str(below / 'nowhere')]) == 1


def test_every_part_of_the_evaluation_says_what_wrote_it() -> None:
    found = [(each.page, each.command.split()[3]) for each in pages.find(DOCS)
             if each.command.startswith('rosrun self_awareness evaluate ')]
    assert {(f'evaluation/{RESEARCH}', part) for part in (
        'simulated', 'families', 'recordings', 'ablation')} <= set(found)
    assert {(f'evaluation/{RESULTS}', part) for part in (
        'simulated', 'families', 'recordings')} <= set(found)


def test_the_numbers_of_the_readme_are_of_this_method() -> None:
    """They come from two of the parts of their page."""
    old = [each.command for each in pages.find(DOCS) if each.page == PAGE and each.is_old]
    assert [command for command in old if command.split()[3] in ('simulated', 'families')] == []


def test_more_knowledge_makes_no_robot_louder() -> None:
    """More starts, or the graph, and more false alarms than by chance, is a rule too many."""
    with open(DOCS / 'evaluation' / 'families.csv', encoding='utf-8') as file:
        rates = {(each['of'], each['learning'], each['system']):
                 (float(each['per_hour_low']), float(each['per_hour_high']))
                 for each in csv.DictReader(file) if each['system'].startswith('evidence')}
    few, many = sorted({learning for _, learning, _ in rates})
    pairs = [((of, few, system), (of, many, system))
             for of, learning, system in rates if learning == few]
    pairs += [((of, learning, system), (of, learning, 'evidence'))
              for of, learning, system in rates if system == 'evidence_no_graph']
    assert len(pairs) > 100
    louder = [(less, more) for less, more in pairs if rates[more][0] > rates[less][1]]
    assert louder == []


LEARNING = '2 x 150 s + 1 x 150 s'


def row(part: str, fault: str = NORMAL, latency_s: Optional[float] = None,
        first: Optional[bool] = None, system: str = 'evidence', seed: int = 1, change: str = '',
        learning: str = LEARNING, **more: Any) -> Row:
    subject = Subject(part, f'timers {seed}', learning, system, change)
    found = Row(subject, fault, '' if fault == NORMAL else '/a', latency_s=latency_s,
                noticed_s=latency_s, first=first, among_three=None if first is None else True,
                level='' if latency_s is None else 'ERROR',
                culprit='' if latency_s is None else '/a')
    return replace(found, **({'hours': 2.0} if fault == NORMAL else {}), **more)


def test_the_own_robot() -> None:
    rows = [row(OWN, watched=14, components=15), row(OWN, 'cc1', 0.2, True),
            row(OWN, 'cc1', 0.4, False, seed=2), row(OWN, 'crash:motors', None),
            row(OWN, 'extra', None, noticed_s=0.1), row(OWN, 'silence', 2.0, source=''),
            *(row(OWN, each, system='paper') for each in (
                NORMAL, 'cc1', 'crash:motors', 'extra', 'silence'))]
    section = simulated(rows)
    research, results = section.pages[RESEARCH], section.pages[RESULTS]
    for line in ('| fault | evidence | paper |', '| cc1 | 100 %, 0.20 s | – |',
                 '| crash:motors | – | – |', '| silence | 100 %, 2.00 s | – |',
                 '| every crash | – | – |', '| components watched | 14 of 15 | – |',
                 '| false alarms an hour (95 %) | 0 (0 to 1.9) | 0 (0 to 1.9) |',
                 '| cc1 | 50 % / 100 % / 100 % | – / – / – |',
                 '| extra | 5 s | 100 %, 0.10 s | 0 %, – |'):
        assert line in research, line
    assert '| all nodes fall silent | 100 % (21–100 %) | 2.00 s | – / 0 % |' in results
    assert results[-1] == 'False alarms an hour: 0 (0 to 1.9).'


def test_the_families() -> None:
    rows = [row(FAMILIES, alarms=12, evidence=('answers',) * 12, standing_hours=0.012,
                warnings=24, expected=0.25), row(FAMILIES, seed=2, expected=0.5),
            row(FAMILIES, CRASH, 0.4, True), row(FAMILIES, CRASH, 4.0, False),
            row(FAMILIES, CRASH), row(FAMILIES, LATE, 0.1, True),
            row(FAMILIES, RESTART, 0.4, True, after=0), row(FAMILIES, RESTART, after=3),
            row(FAMILIES, system='gaps', alarms=1)]
    section = families(rows)
    low, high = rate_interval([(12, 2.0), (0, 2.0)])
    told = f'3 ({low:.2g} to {high:.0f})'
    research = section.pages[RESEARCH]
    for name in ('timers', 'all'):
        assert (f'| {name} | {told} | 0.3 % | 6 | 33 / 67 / 67 %, first 50 %, end 100 % | – '
                '| 100 %, 0.10 s, first 100 %, end 100 % | – | – | – | – | – | – | – | – | – | – '
                '| – | – | – | – | 3 after 2 | – of – | answers 12 |') in research
    pooled = [line for line in research if line.startswith('| evidence | 2 starts | –')]
    assert pooled and f'| {told} | 0.38 | 50 % | 6 |' in pooled[0]
    assert any(line.startswith('| gaps | 2 starts | – | 0.5 (') for line in research)
    results = section.pages[RESULTS]
    assert f'| false alarms an hour (95 %) | {told} | – |' in results
    assert '| crashes | 66.7 % (21–94 %), 4.00 s | 50 % / 100 % |' in results
    assert results[-1] == 'Alarms that name a node which has nothing to do with the fault: 0 of 0.'


def of_case(fault: str, system: str = 'evidence', **more: Any) -> Row:
    return Row(Subject(REAL, 'wheeled, 1', '', system), fault, watched=5, **more)


def test_the_recordings() -> None:
    rows = [of_case(NORMAL, hours=0.01, alarms=1, standing_hours=0.001),
            of_case('outage', latency_s=0.9, level='ERROR', kind='silent', culprit='/a'),
            of_case(NORMAL, 'paper', hours=0.01), of_case('outage', 'paper', stood_before=True)]
    section = recordings(rows)
    evidence = ('| wheeled, 1 | evidence | 5 | found | 0.90 s | ERROR, silent, /a | 1 '
                '| 3.6 of 36.0 s |')
    assert evidence in section.pages[RESULTS] and evidence in section.pages[RESEARCH]
    assert ('| wheeled, 1 | paper | 5 | found, stood before | – | – | 0 | 0.0 of 36.0 s |'
            in section.pages[RESEARCH])
    refused = recordings([of_case(NORMAL, refused='too short'),
                          of_case('outage', refused='too short')])
    assert '| wheeled, 1 | evidence | – | too short | – | – | – | – |' in refused.pages[RESULTS]


def test_the_ablation_marks_what_differs() -> None:
    number, same = Tuning.numbers()[:2]
    default = [row(FAMILIES), row(FAMILIES, CRASH, 0.25, True)]
    late = [row(FAMILIES), row(FAMILIES, CRASH, 7.0, False)]
    changes = {'': (False, default), 'without pairs': (False, default), 'x=0': (False, late),
               number_set(number.name, number.most): (True, late),
               number_set(same.name, same.most): (True, default)}
    rows = [replace(each, subject=replace(each.subject, change=change))
            for change, (_, of_change) in changes.items() for each in of_change]
    rows.append(row(FAMILIES, change='x=0', refused='too short'))
    variants = [Variant('evidence', change=change, is_number=is_number)
                for change, (is_number, _) in changes.items()]
    lines = ablation(rows, variants).pages[RESEARCH]
    nothing = ' | '.join('–' * 11)
    for told in ('as it is', 'without pairs'):
        assert (f'| {told} | 0 in 2.0 h | 0 | 1 / 1 of 1, 0.25 s | {nothing} | 1 of 1 | 1 of 1 |'
                in lines)
    assert any(line.startswith('| x=0 |') and '| **0 / 1 of 1, 7.00 s** |' in line
               and '| **0 of 1** | 1 of 1 |' in line for line in lines)
    changed = next(line for line in lines if line.startswith(f'| `{number.name}`'))
    assert 'crashes 0 / 1 of 1, 7.00 s, guilty first 0 of 1' in changed
    assert f'Changed nothing: `{same.name}` ({same.most:g}).' in lines
    assert '- x=0: timers 1: too short' in lines


@pytest.mark.parametrize('median, differs', [(0.54, False), (0.6, True), (None, True)])
def test_small_differences_are_told_as_the_same(median: Optional[float], differs: bool) -> None:
    found = [cells([row(FAMILIES), row(FAMILIES, 'flood', each)], {})['other faults']
             for each in (0.5, median)]
    assert found[1].differs(found[0]) == differs


def test_sections_are_put_in_their_place(tmp_path: Path) -> None:
    readme = tmp_path / RESULTS
    readme.write_text('# Mine\n\n<!-- families -->\nold\n<!-- /families -->\n\nMore.\n')
    rows = [row(FAMILIES), row(FAMILIES, CRASH, 0.4, True)]
    written = pages.write(tmp_path, families(rows), rows, 'evaluate families')
    assert [path.name for path in written] == ['families.csv', 'families.csv', RESULTS, RESEARCH]
    text = readme.read_text(encoding='utf-8')
    assert text.startswith('# Mine\n\n<!-- families -->\nWritten by `evaluate families`')
    assert text.endswith('<!-- /families -->\n\nMore.\n') and 'old' not in text
    assert len(pages.written((tmp_path / RESEARCH).read_text(encoding='utf-8'))) == 1
    table = (tmp_path / 'families.csv').read_text(encoding='utf-8').splitlines()
    assert len(table) == 3 and table[1].startswith(f'families,{LEARNING},evidence,,,all,2,0,0,')
    assert 'crash: at_end' in table[0]
