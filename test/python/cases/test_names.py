"""Names in recordings of other people: without a slash, and with a number that changes."""
from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Dict, List, Tuple

import pytest

from self_awareness import load
from self_awareness.commands import train

WANTED = {
    '05_topics_recorded_without_slash': ['n1', 'n2', 'normal_with_slash', 'crash_with_slash'],
    '23_node_with_a_short_random_number': ['n1', 'n2', 'crash']}
"""The bags of each case that are used: to write all of them takes twice as long."""

_MAKE = """
import os, runpy, sys
make, *wanted = sys.argv[1:]
sys.argv = [make]
sys.path.insert(0, os.path.join(os.path.dirname(make), '..', 'lib'))
import robot
write = robot.write
robot.write = lambda made, path, *given, **more: (
    os.path.basename(path)[:-4] in wanted and write(made, path, *given, **more))
runpy.run_path(make)
"""


@pytest.fixture(scope='session', name='made')
def _made(shared: Path, tmp_path_factory: pytest.TempPathFactory) -> Dict[str, Path]:
    """The folders with the bags of the cases, by the cases' numbers."""
    makers = {case: shared / 'cases' / case / 'make.py' for case in WANTED}
    missing = [str(maker) for maker in makers.values() if not maker.is_file()]
    if missing:
        pytest.skip(f'no {", ".join(missing)}')
    folders = {case: tmp_path_factory.mktemp(case) for case in WANTED}
    running = [subprocess.Popen([sys.executable, '-c', _MAKE, str(makers[case]), *bags],
                                env={**os.environ, 'OUT': str(folders[case])},
                                stdout=subprocess.DEVNULL) for case, bags in WANTED.items()]
    assert [maker.wait() for maker in running] == [0, 0]
    return {case[:2]: folder for case, folder in folders.items()}


def trained(bags: Path, model: Path) -> str:
    assert train.main([str(bags / 'n1.bag'), str(bags / 'n2.bag'), '-o', str(model)]) == 0
    return str(model)


def errors(model: str, bag: Path) -> List[Tuple[str, str, float]]:
    """Return kind, culprit and begin [s] of each alarm."""
    return [(each['kind'], each['culprit'], each['begin_s'])
            for each in load(model).judge(str(bag)).table() if each['level'] == 'ERROR']


def test_scan_and_slash_scan_are_one_topic(made, tmp_path: Path) -> None:
    model = trained(made['05'], tmp_path / 'm')
    assert errors(model, made['05'] / 'normal_with_slash.bag') == []
    assert errors(model, made['05'] / 'crash_with_slash.bag') == [
        ('silent', '/lidar', pytest.approx(40.5, abs=0.5))]


def test_a_node_with_a_short_random_number_is_one(made, tmp_path: Path, capsys) -> None:
    model = trained(made['23'], tmp_path / 'm')
    assert 'differ by a number alone' in capsys.readouterr().out
    assert '/matlab_global_node' in [each.component for each in load(model).coverage()]
    assert errors(model, made['23'] / 'crash.bag') == [
        ('silent', '/matlab_global_node', pytest.approx(50.5, abs=0.5))]
