"""Data that threads share is in a Guarded, and can only be reached through its lock."""
from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
GUARDED = ROOT / 'include/self_awareness/ros/guarded.h'
PROGRAM = """
#include "self_awareness/ros/guarded.h"
struct Counts {{ int dropped = 0; }};
void use(self_awareness::ros1::Guarded<Counts>& counts,
         const self_awareness::ros1::Guarded<Counts>& constant) {{
  (void)counts;
  (void)constant;
  {statement}
}}
"""


@pytest.mark.parametrize('statement, error', [
    ('++counts.lock()->dropped;', ''),
    ('const auto held = counts.lock(); ++held->dropped; Counts& same = *held; ++same.dropped;',
     ''),
    ('int dropped = constant.lock()->dropped; (void)dropped;', ''),
    ('++counts.data_.dropped;', 'is private within this context'),
    ('++counts->dropped;', "has non-pointer type|base operand of '->'"),
    ('Counts& counted = *counts.lock(); ++counted.dropped;', 'use of deleted function'),
    ('auto held = counts.lock(); auto moved = std::move(held);', 'use of deleted function'),
    ('++constant.lock()->dropped;', 'read-only object')])
def test_only_who_holds_the_lock_reaches_the_data(tmp_path: Path, statement: str,
                                                  error: str) -> None:
    program = tmp_path / 'program.cpp'
    program.write_text(PROGRAM.format(statement=statement))
    compiled = subprocess.run(['g++', '-std=c++17', '-fsyntax-only', '-I', str(ROOT / 'include'),
                               str(program)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, check=False)
    assert (compiled.returncode == 0) == (error == ''), compiled.stdout
    assert re.search(error, compiled.stdout.replace('‘', "'").replace('’', "'")), compiled.stdout


def test_there_is_no_other_lock() -> None:
    locks = re.compile(r'#include <(mutex|shared_mutex)>|boost::\w*mutex'
                       r'|pthread_(mutex|rwlock|spin)')
    sources = [path for folder in ('src/monitor', 'src/ros', 'include/self_awareness/ros')
               for path in sorted((ROOT / folder).rglob('*')) if path.suffix in ('.h', '.cpp')]
    assert [str(path) for path in sources
            if locks.search(path.read_text())] == [str(GUARDED)]
