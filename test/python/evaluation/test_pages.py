"""What is written of measurements: with which method, and the README's numbers out of it."""
from __future__ import annotations

import re
from pathlib import Path
from typing import List

import pytest

from self_awareness import METHOD
from self_awareness_evaluation import evaluate, pages
from self_awareness_evaluation.pages import RESEARCH, RESULTS
from self_awareness_evaluation.readme_numbers import PAGE, SECTION, Number, cell, section

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
    assert found is not None and found[1] == section(DOCS)


def test_the_readme_has_no_other_number_that_could_be_measured() -> None:
    text = re.sub(f'<!-- {SECTION} -->.*?<!-- /{SECTION} -->', '', _readme(), flags=re.DOTALL)
    text = re.sub(r'```.*?```|`[^`\n]*`|\]\([^)]*\)', '', text, flags=re.DOTALL)
    given = GIVEN.read_text(encoding='utf-8').splitlines()
    for phrase in given:
        assert phrase in text, f'{GIVEN.name}: not in the README: {phrase}'
        text = text.replace(phrase, '')
    others: List[str] = re.findall(r'^.*\d.*$', text, re.MULTILINE)
    assert others == [], 'measured: name its cell in readme_numbers.py; else, in ' + GIVEN.name


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
