"""The tree is as the linters want it."""
from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest
import yaml

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
