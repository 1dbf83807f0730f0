"""What README.md and docs tell to type, tests type."""
from __future__ import annotations

import importlib
import os
from pathlib import Path

from page_reader import DOCS, README, TYPED, blocks

EXCEPTIONS = {
    'scripts/demo.sh': 'they install packages, build all and take minutes',
    "bash -c 'source scripts/prepare.sh; install_packages": 'needs apt; every script begins so',
    'dask-scheduler': 'of several machines; one is a cluster in training/test_cluster.py',
    'cmake -S src/core': 'test/packaging/test_core_by_itself.py runs it',
    'rosrun self_awareness evaluate simulated': 'takes hours; test/python/evaluation has less',
}
"""How blocks begin that no test of a page types, and why."""


def test_every_block_of_commands_is_typed() -> None:
    for path in Path(__file__).parent.glob('test_*.py'):
        importlib.import_module(path.stem)
    pages = [README, *(os.path.relpath(path, DOCS) for path in sorted(DOCS.rglob('*.md')))]
    found = [(page, block) for page in pages for block in blocks(page)]
    left = [(page, block) for page, block in found if block not in TYPED]
    assert [each for each in left if not each[1].startswith(tuple(EXCEPTIONS))] == []
    assert len(left) == len(EXCEPTIONS)
