"""The tree is as the linters want it."""
from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def _run(program: str, *arguments: str) -> None:
    if shutil.which(program) is None:
        pytest.skip(f'{program} is not installed')
    done = subprocess.run((program, *arguments), cwd=ROOT, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    assert done.returncode == 0, done.stdout


def test_catkin_lint() -> None:
    _run('catkin_lint', '-W1', '--strict', str(ROOT))


def test_clang_format() -> None:
    if shutil.which('clang-format') is not None:
        version = subprocess.run(('clang-format', '--version'), stdout=subprocess.PIPE, text=True)
        if ' 14.' not in version.stdout:
            pytest.skip(f'the tree is formatted by version 14, this is {version.stdout.strip()}')
    files = [str(path) for folder in ('benchmark', 'include', 'src', 'test')
             for path in sorted((ROOT / folder).rglob('*')) if path.suffix in ('.h', '.cpp')]
    _run('clang-format', '--dry-run', '-Werror', *files)
