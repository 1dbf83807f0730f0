"""The line that tests end with: no result may get lost before it is counted."""
from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

PROGRAM = Path(__file__).parents[1] / 'count_results.py'
PASSED = '<testsuite tests="1"><testcase classname="a" name="b"/></testsuite>'
FAILED = ('<testsuite tests="1"><testcase classname="a" name="c"><error type="IndexError">no such '
          'index\n  File "a.py"</error></testcase></testsuite>')


@pytest.mark.parametrize('files, kinds, code, told', [
    ({'gtest-a': PASSED, 'pytest-b': PASSED}, ['gtest', 'pytest'], 0,
     '2 passed, 0 failed, 0 skipped\n'),
    ({'gtest-a': PASSED, 'pytest-b': FAILED}, [], 1,
     'FAILED: a c: IndexError no such index\n1 passed, 1 failed, 0 skipped\n'),
    ({'gtest-a': PASSED}, ['gtest', 'pytest'], 1,
     'FAILED: pytest: no results\n1 passed, 1 failed, 0 skipped\n'),
    ({'rosunit-a': '<testsuite tests="3"><testcase classname="a" name="b" time="2.25"/>'
      '<testcase classname="a" name="c" time="0.9"/><testcase classname="a" name="d" time="70"/>'
      '<system-out>once more: the machine stood still for 2.0 s</system-out></testsuite>'}, [], 0,
     '  70.0 s  a d\n   2.2 s  a b\n1 tests had a second try: the machine disturbed them\n'
     '3 passed, 0 failed, 0 skipped\n'),
    ({}, [], 1, '0 passed, 0 failed, 0 skipped\n')])
def test_what_passed_and_failed_is_counted(tmp_path: Path, files: dict, kinds: list, code: int,
                                           told: str) -> None:
    for name, text in files.items():
        (tmp_path / f'{name}.xml').write_text(text)
    done = subprocess.run([str(PROGRAM), str(tmp_path), *kinds], stdout=subprocess.PIPE,
                          universal_newlines=True)
    assert (done.returncode, done.stdout) == (code, told)
