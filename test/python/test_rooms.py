"""The rooms of the Python packages: what is installed, and what may import what."""
from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import Dict, List, Set

import pytest

ROOT = Path(__file__).resolve().parents[2]
SRC = ROOT / 'src'
LIBRARY, ROBOT, EVALUATION = (
    'self_awareness', 'self_awareness_follow_me', 'self_awareness_evaluation')
PROGRAMS = 'self_awareness.commands'


def _modules() -> Dict[str, Path]:
    """Return all modules of the packages by their dotted names."""
    modules = {}
    for path in SRC.rglob('*.py'):
        parts = path.relative_to(SRC).with_suffix('').parts
        modules['.'.join(parts[:-1] if parts[-1] == '__init__' else parts)] = path
    return modules


def _package(module: str) -> str:
    return module.partition('.')[0]


def _imports(path: Path, modules: Dict[str, Path]) -> Set[str]:
    """Return the modules of the packages that a module imports, wherever in it."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names} & set(modules)
        if isinstance(node, ast.ImportFrom):
            names = {f'{node.module}.{alias.name}' for alias in node.names}
            found |= (names & set(modules)) or ({str(node.module)} & set(modules))
    return found


@pytest.fixture(scope='module')
def graph() -> Dict[str, Set[str]]:
    """By module, which ones it imports."""
    modules = _modules()
    found = {name: _imports(path, modules) for name, path in modules.items()}
    found[LIBRARY].remove(f'{LIBRARY}.library')  # when it is first used: the others are there then
    return found


def _circle(graph: Dict[str, Set[str]]) -> List[str]:
    """Return modules that import each other, and what needs them; empty: there are none."""
    left = dict(graph)
    while True:
        free = [name for name, needed in left.items() if not needed & set(left)]
        if not free:
            return sorted(left)
        for name in free:
            del left[name]


def test_all_but_the_evaluation_is_installed() -> None:
    packages = {name for name, path in _modules().items() if path.name == '__init__.py'}
    assert {_package(name) for name in packages} == {LIBRARY, ROBOT, EVALUATION}
    listed = set(re.findall(r"'(self_awareness[\w.]*)'", (ROOT / 'setup.py').read_text()))
    assert listed == {name for name in packages if _package(name) != EVALUATION}


def test_packages_need_only_what_they_may(graph: Dict[str, Set[str]]) -> None:
    """What is installed no evaluation; only programs the simulated robot, or other programs."""
    for name, needed in graph.items():
        packages, is_program = {_package(each) for each in needed}, name.startswith(PROGRAMS)
        if _package(name) != EVALUATION:
            assert EVALUATION not in packages, name
        if _package(name) == LIBRARY and not is_program:
            assert ROBOT not in packages, name
        if _package(name) != EVALUATION and not is_program:
            assert not [module for module in needed if module.startswith(PROGRAMS)], name


def test_no_module_needs_one_that_needs_it(graph: Dict[str, Set[str]]) -> None:
    assert _circle(graph) == []
