"""The tree is as the linters want it."""
from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import List, Sequence

import pytest

ROOT = Path(__file__).resolve().parents[2]

# Tests and benchmarks take for granted what they have just set up, and fail by themselves where it
# is None, or no more than what a base class says.
LENIENT = ('--no-strict-optional', '--disable-error-code=override',
           '--disable-error-code=union-attr', '--disable-error-code=var-annotated')


def _version(program: str) -> str:
    if shutil.which(program) is None:
        pytest.skip(f'{program} is not installed')
    done = subprocess.run((program, '--version'), stdout=subprocess.PIPE, text=True, check=True)
    return ' '.join(done.stdout.split())


def _python_programs() -> List[str]:
    """Return the programs, which have no extension that tells their language."""
    files = [path for folder in ('nodes', 'scripts') for path in sorted((ROOT / folder).iterdir())]
    return [str(path) for path in files
            if path.is_file() and path.read_bytes().startswith(b'#!/usr/bin/python3')]


def _check(*command: str) -> None:
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True)
    assert done.returncode == 0, done.stdout


def _run_module(module: str, *arguments: str) -> None:
    """Run a linter that is written in Python, whose settings are in setup.cfg."""
    pytest.importorskip(module, reason=f'{module} is not installed')
    _check(sys.executable, '-m', module, *arguments)


def test_catkin_lint() -> None:
    _version('catkin_lint')
    _check('catkin_lint', '-W1', '--strict', str(ROOT))


def test_clang_format() -> None:
    version = _version('clang-format')
    if ' 14.' not in version:
        pytest.skip(f'the tree is formatted by version 14, this is {version}')
    files = [str(path) for folder in ('benchmark', 'examples', 'include', 'src', 'test')
             for path in sorted((ROOT / folder).rglob('*')) if path.suffix in ('.h', '.cpp')]
    _check('clang-format', '--dry-run', '-Werror', *files)


def test_flake8() -> None:
    _run_module('flake8', 'benchmark', 'setup.py', 'src', 'test', *_python_programs())


@pytest.mark.parametrize('options', [
    ('src', *_python_programs()),
    (*LENIENT, 'benchmark', 'test/count_results.py', 'test/python', 'test/rostest',
     'test/sanitizers', 'test/data'),
], ids=['package', 'tests'])
def test_mypy(options: Sequence[str], tmp_path: Path) -> None:
    pytest.importorskip('mypy', reason='mypy is not installed')
    from mypy.version import __version__ as version
    if not version.startswith('1.'):
        pytest.skip(f'the tree is checked by mypy 1, this is {version}')
    _run_module('mypy', '--cache-dir', str(tmp_path), *options)
