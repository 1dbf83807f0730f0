"""What the rooms of the C++ sources may include (docs/architecture.md)."""
from __future__ import annotations

import re
from pathlib import Path
from typing import Dict, List, Set

import pytest

ROOT = Path(__file__).resolve().parents[2]

# By room, what it may include of core's rooms besides itself.
CORE: Dict[str, Set[str]] = {
    'stream': set(),
    'verdict': {'stream'},
    'paper': {'stream', 'verdict'},
    'evidence': {'stream', 'verdict'},
}
INCLUDE = re.compile(r'^#include ["<]([^">]+)[">]', re.MULTILINE)


def _sources(*folders: str) -> List[Path]:
    return [path for folder in folders for path in sorted((ROOT / folder).rglob('*'))
            if path.suffix in ('.h', '.cpp')]


def _included(path: Path) -> List[str]:
    return INCLUDE.findall(path.read_text(encoding='utf-8'))


def _core_rooms(path: Path) -> Set[str]:
    found = (re.fullmatch(r'(?:self_awareness/)?core/(?:(\w+)/)?\w+\.h', name)
             for name in _included(path))
    return {match.group(1) or 'training' for match in found if match}


@pytest.mark.parametrize('room', sorted(CORE))
def test_rooms_of_the_core_include_what_lies_below(room: str) -> None:
    sources = _sources(f'include/self_awareness/core/{room}', f'src/core/{room}')
    assert sources
    for path in sources:
        assert _core_rooms(path) <= CORE[room] | {room}, path


def test_the_core_knows_no_ros() -> None:
    for path in _sources('include/self_awareness/core', 'src/core'):
        for name in _included(path):
            assert re.match(r'core/|self_awareness/core/|Eigen/|\w+$', name), (path, name)


def test_public_headers_include_no_others() -> None:
    for path in _sources('include'):
        for name in _included(path):
            assert not re.match(r'(core|ros|monitor)/', name) or not (
                ROOT / 'src' / name).exists(), (path, name)


def test_ros_knows_neither_the_monitor_nor_python() -> None:
    for path in _sources('include/self_awareness/ros', 'src/ros'):
        for name in _included(path):
            assert not re.match(r'(monitor|python)/', name), (path, name)
