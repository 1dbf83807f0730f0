"""The rooms of the Python package: what is installed, and what may import what."""
from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import Dict, List, Set

ROOT = Path(__file__).resolve().parents[2]
SRC = ROOT / 'src'
EVALUATION = 'self_awareness.evaluation'


def _modules() -> Dict[str, Path]:
    """Return all modules of the package by their dotted names."""
    modules = {}
    for path in (SRC / 'self_awareness').rglob('*.py'):
        parts = path.relative_to(SRC).with_suffix('').parts
        modules['.'.join(parts[:-1] if parts[-1] == '__init__' else parts)] = path
    return modules


def _imports(path: Path, modules: Dict[str, Path]) -> Set[str]:
    """Return the modules of the package that a module imports, wherever in it."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if isinstance(node, ast.ImportFrom):
            names = {f'{node.module}.{alias.name}' for alias in node.names}
            found |= (names & set(modules)) or ({str(node.module)} & set(modules))
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
    listed = set(re.findall(r"'(self_awareness[\w.]*)'", (ROOT / 'setup.py').read_text()))
    assert listed == {name for name in packages if not name.startswith(EVALUATION)}


def test_what_is_installed_needs_no_evaluation() -> None:
    modules = _modules()
    for name, path in modules.items():
        if not name.startswith(EVALUATION):
            assert not [needed for needed in _imports(path, modules)
                        if needed.startswith(EVALUATION)], name


def test_no_module_needs_one_that_needs_it() -> None:
    modules = _modules()
    assert _circle({name: _imports(path, modules) for name, path in modules.items()}) == []


def test_the_search_for_circles_finds_one() -> None:
    assert _circle({'a': {'b'}, 'b': {'c'}, 'c': {'b'}, 'd': {'a'}}) == ['a', 'b', 'c', 'd']
    assert _circle({'a': {'b', 'c'}, 'b': {'c'}, 'c': set()}) == []
