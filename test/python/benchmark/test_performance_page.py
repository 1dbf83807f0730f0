"""docs/performance.md says what the measurements found, and how it is written."""
from __future__ import annotations

import importlib
import json
import re
import sys
from pathlib import Path
from types import ModuleType
from typing import Iterator

import pytest

from self_awareness import METHOD, EvidenceModel, TrainedModel

ROOT = Path(__file__).resolve().parents[3]
DOCS = ROOT / 'docs'
REPORTS = ('core', 'models', 'bags', 'live', 'report', 'event_logs')


@pytest.fixture(autouse=True)
def benchmark_folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let the programs of the benchmarks be found, and leave nothing of them behind."""
    monkeypatch.syspath_prepend(str(ROOT / 'benchmark'))
    before = set(sys.modules)
    yield
    for name in set(sys.modules) - before:
        if str(ROOT / 'benchmark') in str(getattr(sys.modules[name], '__file__', '')):
            del sys.modules[name]


def module(name: str) -> ModuleType:
    return importlib.import_module(name)


@pytest.mark.parametrize('section', REPORTS)
def test_tables_are_those_of_the_committed_numbers(section: str) -> None:
    result = json.loads((DOCS / 'performance' / f'{section}.json').read_text())
    page = (DOCS / 'performance.md').read_text()
    written = re.search(f'<!-- {section} -->\n(.*)\n<!-- /{section} -->', page, re.DOTALL)
    name = 'core_report' if section == 'core' else section
    assert written and written[1] == module(name).markdown(result)


def test_model_files_of_the_benchmark_watch_something(tmp_path: Path) -> None:
    path = str(tmp_path / 'model')
    row = module('models')._train(15, path)
    assert row['events'] > 1000 and row['train_s'] > 0
    assert module('models')._load(path, watched_only=True)['types'] == 15
    assert {track.channel for track in EvidenceModel(TrainedModel.load(path)).tracks} >= {
        'overdue', 'pairs'}


def test_a_live_model_without_limits_gets_some_that_are_never_reached(tmp_path: Path) -> None:
    live_robot = module('live_robot')
    live_robot.write_synthetic_model(tmp_path / 'model', 12)
    model = TrainedModel.load(str(tmp_path / 'model'))
    live_robot.judge_without_alarms(model)
    model.save(str(tmp_path / 'model'))
    limits = TrainedModel.load(str(tmp_path / 'model')).calibration.limits
    assert limits and set(limits) == {1e6}


def test_publishing_replaces_a_section_and_nothing_else(tmp_path: Path) -> None:
    (tmp_path / 'performance.md').write_text('a\n<!-- x -->\nold\n<!-- /x -->\nb\n')
    module('page').publish('x', {'cores': 2}, 'new', tmp_path)
    assert (tmp_path / 'performance.md').read_text() == 'a\n<!-- x -->\nnew\n<!-- /x -->\nb\n'
    assert json.loads((tmp_path / 'performance' / 'x.json').read_text()) == {
        'method': METHOD, 'cores': 2}


def test_a_page_without_the_section_is_an_error(tmp_path: Path) -> None:
    (tmp_path / 'performance.md').write_text('a\n<!-- x -->\n')
    with pytest.raises(ValueError, match='no section x'):
        module('page').publish('x', {}, 'new', tmp_path)
