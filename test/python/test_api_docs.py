"""The pages about the headers for other programs (scripts/api_docs.sh)."""
from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
API_DOCS = 'scripts/api_docs.sh'
# Others warn of other things, or know other settings.
VERSION = '1.9.4'


def _run(argument: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run((API_DOCS, argument), cwd=ROOT, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def test_they_are_about_the_headers_that_the_page_names() -> None:
    page = (ROOT / 'docs' / 'library.md').read_text(encoding='utf-8')
    found = _run('--headers').stdout.split()
    assert set(found) == {f'include/self_awareness/{name}'
                          for name in re.findall(r'`(core/[^`]*\.h)`', page)}
    assert len(found) >= 9
    assert [name for name in found if not (ROOT / name).is_file()] == []


def test_everything_public_in_these_headers_has_a_comment(tmp_path: Path) -> None:
    if shutil.which('doxygen') is None:
        pytest.skip('doxygen is not installed')
    version = subprocess.run(('doxygen', '--version'), stdout=subprocess.PIPE, text=True,
                             check=True).stdout.strip()
    if not version.startswith(VERSION):
        pytest.skip(f'the comments are checked by doxygen {VERSION}, this is {version}')
    done = _run(str(tmp_path / 'api'))
    assert done.returncode == 0, done.stdout
    for name in ('classself__awareness_1_1core_1_1Detector.html',
                 'structself__awareness_1_1core_1_1Suspect.html', 'index.html'):
        assert (tmp_path / 'api' / name).is_file(), name
