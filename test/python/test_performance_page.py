"""docs/performance.md says what the measurements found, and how it is written."""
from __future__ import annotations

import importlib
import json
import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / 'docs'
REPORTS = {'core': 'core_report', 'models': 'models', 'bags': 'bags_report',
           'live': 'live_report', 'predecessors': 'predecessors'}


@pytest.fixture(autouse=True)
def benchmark_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the programs of the benchmarks be found, and leave nothing of them behind."""
    monkeypatch.syspath_prepend(str(ROOT / 'benchmark'))
    before = set(sys.modules)
    yield
    for name in set(sys.modules) - before:
        if str(ROOT / 'benchmark') in str(getattr(sys.modules[name], '__file__', '')):
            del sys.modules[name]


def module(name: str) -> ModuleType:
    return importlib.import_module(name)


@pytest.mark.parametrize('section', sorted(REPORTS))
def test_tables_are_those_of_the_committed_numbers(section: str) -> None:
    result = json.loads((DOCS / 'performance' / f'{section}.json').read_text())
    page = (DOCS / 'performance.md').read_text()
    written = re.search(f'<!-- {section} -->\n(.*)\n<!-- /{section} -->', page, re.DOTALL)
    assert written and written[1] == module(REPORTS[section]).markdown(result)


def test_publishing_replaces_a_section_and_nothing_else(tmp_path: Path) -> None:
    (tmp_path / 'performance.md').write_text('a\n<!-- x -->\nold\n<!-- /x -->\nb\n')
    module('page').publish('x', {'cores': 2}, 'new', tmp_path)
    assert (tmp_path / 'performance.md').read_text() == 'a\n<!-- x -->\nnew\n<!-- /x -->\nb\n'
    assert json.loads((tmp_path / 'performance' / 'x.json').read_text()) == {'cores': 2}


def test_a_page_without_the_section_is_an_error(tmp_path: Path) -> None:
    (tmp_path / 'performance.md').write_text('a\n<!-- x -->\n')
    with pytest.raises(ValueError, match='no section x'):
        module('page').publish('x', {}, 'new', tmp_path)
