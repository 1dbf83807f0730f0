"""What mypy knows of the C++ module (src/self_awareness/_core.pyi) is what the module has."""
from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Iterator, List, Sequence, Tuple

import pytest

from self_awareness import _core

ROOT = Path(__file__).resolve().parents[2]
STUB = ROOT / 'src/self_awareness/_core.pyi'


def test_the_stubs_are_those_of_the_module() -> None:
    version = pytest.importorskip('mypy.version', reason='mypy is not installed').__version__
    if not version.startswith('1.'):
        pytest.skip(f'the stubs are compared by mypy 1, this is {version}')
    done = subprocess.run(
        (sys.executable, '-m', 'mypy.stubtest', 'self_awareness._core', '--concise',
         '--ignore-positional-only', '--mypy-config-file', str(ROOT / 'setup.cfg')),
        env={**os.environ, 'MYPYPATH': str(ROOT / 'src')}, cwd=ROOT, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, text=True)
    read_only = {f'self_awareness._core.{name} is read-only at runtime but not in the stub'
                 for name in _final()}  # which is what Final says
    assert [line for line in done.stdout.splitlines() if line not in read_only
            if not line.endswith(('metaclass differs',  # pybind11's own
                                  'stub does not have *args argument "args"'))] == []


def _final() -> Iterator[str]:
    """Return the attributes of classes that the stub says nobody sets."""
    for node in ast.walk(ast.parse(STUB.read_text(encoding='utf-8'))):
        if isinstance(node, ast.ClassDef):
            for each in node.body:
                if isinstance(each, ast.AnnAssign) and 'Final' in ast.dump(each.annotation):
                    yield f'{node.name}.{each.target.id}'


def _stub() -> Iterator[Tuple[str, List[str]]]:
    """Return functions of the stub by their names in the module, and their arguments."""
    for node in ast.parse(STUB.read_text(encoding='utf-8')).body:
        inside: Sequence[ast.stmt] = [node]
        prefix = ''
        if isinstance(node, ast.ClassDef):
            inside, prefix = node.body, f'{node.name}.'
        for each in inside:
            if isinstance(each, ast.FunctionDef):
                yield prefix + each.name, [argument.arg for argument in each.args.args
                                           if argument.arg != 'self']


def test_arguments_are_called_as_in_the_module() -> None:
    """The module tells them in its docstrings only."""
    compared = 0
    for name, arguments in _stub():
        if name == 'UnknownEvents.value' and not hasattr(_core.UnknownEvents, 'value'):
            continue  # pybind11 2.4 gives an enum none
        bound = _core
        for part in name.split('.'):
            bound = getattr(bound, part)
        told = re.match(r'\w+\((.*)\) -> ', getattr(bound, '__doc__', None) or '')
        if told and 'arg0' not in told[1] and '__' not in name.replace('__init__', ''):
            assert [argument for argument in re.findall(r'(?:^|, )(\w+): ', told[1])
                    if argument != 'self'] == arguments, name
            compared += 1
    assert compared > 60


def test_mypy_checks_what_crosses_the_border(tmp_path: Path) -> None:
    pytest.importorskip('mypy', reason='mypy is not installed')
    wrong = tmp_path / 'wrong.py'
    wrong.write_text('''import self_awareness as sa
alarms = sa.load('robot.model').judge('crash.bag')
culprit: int = alarms[0].culprit
alarms[0].started
sa.learn('monday.bag', budget='much')
''', encoding='utf-8')
    done = subprocess.run((sys.executable, '-m', 'mypy', '--config-file', str(ROOT / 'setup.cfg'),
                           '--cache-dir', str(tmp_path), str(wrong)),
                          env={**os.environ, 'MYPYPATH': str(ROOT / 'src')}, cwd=ROOT,
                          stdout=subprocess.PIPE, text=True)
    assert done.returncode == 1
    for line in (3, 4, 5):
        assert f'wrong.py:{line}: error: ' in done.stdout, done.stdout
