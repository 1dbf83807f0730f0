"""The tree is as the linters want it, and mypy knows the C++ module as it is."""
from __future__ import annotations

import ast
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Iterator, List, Sequence, Tuple

import pytest
import yaml

from self_awareness import _core

ROOT = Path(__file__).resolve().parents[2]
LINT = 'scripts/lint.sh'
CANNOT_RUN = 3
QUICK = ('catkin_lint', 'clang-format', 'flake8', 'mypy')


def _lint(check: str, **environment: str) -> subprocess.CompletedProcess[str]:
    done = subprocess.run((LINT, check), cwd=ROOT, env={**os.environ, **environment}, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode == CANNOT_RUN:
        pytest.skip(done.stdout)
    return done


# There is time for clang-tidy on a part of the C++ only; scripts/lint.sh runs it on all.
@pytest.mark.parametrize('check', (*QUICK, 'clang-tidy-core'))
def test_the_tree_is_clean(check: str) -> None:
    done = _lint(check)
    assert done.returncode == 0, done.stdout


def test_clang_tidy_finds_what_is_wrong_in_sources_and_headers(tmp_path: Path) -> None:
    header = tmp_path / 'src' / 'core' / 'wrong.h'
    source = header.with_suffix('.cpp')
    header.parent.mkdir(parents=True)
    (tmp_path / '.clang-tidy').write_bytes((ROOT / '.clang-tidy').read_bytes())
    header.write_text('inline int* nothing() { return 0; }\n', encoding='utf-8')
    source.write_text('#include "wrong.h"\nint answer() { int x; return x = 42; }\n',
                      encoding='utf-8')
    (tmp_path / 'compile_commands.json').write_text(json.dumps([{
        'directory': str(source.parent), 'command': f'g++ -std=c++17 -c {source}',
        'file': str(source)}], indent=1), encoding='utf-8')
    done = _lint('clang-tidy', SELF_AWARENESS_BUILD=str(tmp_path))
    assert done.returncode == 1
    assert f'{header}:1:' in done.stdout and 'modernize-use-nullptr' in done.stdout
    assert f'{source}:2:' in done.stdout and 'cppcoreguidelines-init-variables' in done.stdout


def test_a_check_that_does_not_exist_is_an_error() -> None:
    assert _lint('clang-tidy-everything').returncode == 2


def test_the_hooks_of_git_run_the_same_without_a_network() -> None:
    config = yaml.safe_load((ROOT / '.pre-commit-config.yaml').read_text(encoding='utf-8'))
    assert [repository['repo'] for repository in config['repos']] == ['local']
    hooks = config['repos'][0]['hooks']
    assert [hook['entry'] for hook in hooks] == [f'{LINT} {check}' for check in QUICK]
    assert {hook['language'] for hook in hooks} == {'system'}


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
