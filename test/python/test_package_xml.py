"""package.xml names all that CMake, the Python code and the tests need.

rosdep and bloom read nothing else, and no machine of the tests has the keys of rosdep: what is
missing here would be noticed on a robot.
"""
from __future__ import annotations

import ast
import re
import sys
from pathlib import Path
from typing import Dict, Iterable, Iterator, List, Set
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).resolve().parents[2]

# By the name that CMake, C++, Python or a shell knows something by, the key of package.xml, where
# it is not the same name, or python3-NAME of a Python module.
KEYS: Dict[str, str] = {
    'Boost': 'libboost-filesystem-dev',
    'Eigen': 'eigen',
    'Eigen3': 'eigen',
    'GTest': 'gtest',
    'PkgConfig': 'pkg-config',
    'Python': 'python3-dev',
    'boost': 'libboost-filesystem-dev',
    'catkin_pkg': 'catkin',
    'dot': 'graphviz',
    'genpy': 'message_runtime',
    'nlohmann': 'nlohmann-json-dev',
    'nlohmann_json': 'nlohmann-json-dev',
    'pybind11': 'pybind11-dev',
    're2': 'libre2-dev',
    'ros': 'roscpp',
    'rosbag.h': 'rosbag_storage',
    'roscore': 'roslaunch',
    'rospack': 'roslib',
    'rosrun': 'rosbash',
    'xmlrpcpp': 'roscpp',
}

# What programs and tests do without, and say so.
OPTIONAL = {
    'distributed',          # train --scheduler
    'plotly',               # score --report; rosdep has no key
    'selenium',             # the test of the report in a browser
    'dynamic_reconfigure',  # the evaluation, which is not installed
}
OF_THE_SYSTEM = {'arpa', 'linux', 'netinet', 'sys'}  # folders of C headers
PROGRAMS = ('dot', 'rosbag', 'roscore', 'roslaunch', 'rosmaster', 'rosnode', 'rospack', 'rosparam',
            'rosrun', 'rosservice', 'rostopic')

BUILD = ('buildtool_depend', 'build_depend', 'depend')
RUN = ('exec_depend', 'depend')
TEST = (*BUILD, *RUN, 'test_depend')


def _named(*kinds: str) -> Set[str]:
    """Return the keys of package.xml of some kinds."""
    package = ElementTree.parse(str(ROOT / 'package.xml')).getroot()
    return {str(element.text) for kind in kinds for element in package.findall(kind)}


def _missing(needed: Iterable[str], *kinds: str) -> List[str]:
    """Return what is needed, and has no key among those of some kinds."""
    named = _named(*kinds)
    return sorted(name for name in needed
                  if not {KEYS.get(name, name), f'python3-{name}'} & named)


def _files(*patterns: str) -> List[Path]:
    found = sorted(path for pattern in patterns for path in ROOT.glob(pattern) if path.is_file())
    assert found
    return found


def _found_by_cmake(*patterns: str) -> Set[str]:
    """Return what CMake must find: packages, components of catkin, modules of pkg-config."""
    found: Set[str] = set()
    for path in _files(*patterns):
        text = re.sub(r'#.*', '', path.read_text(encoding='utf-8'))
        for name, options in re.findall(r'find_package\((\w+)([^)]*)\)', text):
            if 'QUIET' not in options.split():
                found.add(name)
            if name == 'catkin':
                found |= set(options.partition('COMPONENTS')[2].split())
        found |= set(re.findall(r'pkg_check_modules\(\w+ REQUIRED IMPORTED_TARGET (\w+)', text))
    return found


def _included(*folders: str) -> Set[str]:
    """Return the folders of other projects' headers that C++ includes."""
    found: Set[str] = set()
    for path in _files(*(f'{folder}/**/*.{end}' for folder in folders for end in ('h', 'cpp'))):
        found |= set(re.findall(r'^#include <(\w+)/', path.read_text(encoding='utf-8'),
                                re.MULTILINE))
    return {'rosbag.h' if name == 'rosbag' else name for name in found} - OF_THE_SYSTEM


def _python(*patterns: str) -> Iterator[Path]:
    """Yield the modules and programs in Python."""
    for path in _files(*patterns):
        if path.suffix == '.py' or path.read_bytes().startswith(b'#!/usr/bin/python3'):
            yield path


def _imported(*patterns: str) -> Set[str]:
    """Return other projects' packages that Python code imports, wherever in it."""
    found: Set[str] = set()
    for path in _python(*patterns):
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
            if isinstance(node, ast.Import):
                found |= {alias.name.partition('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                found.add(str(node.module).partition('.')[0])
    own = {path.stem for path in _files('test/**/*.py')} | {path.name for path in
                                                            (ROOT / 'src').iterdir()}
    return {name for name in found - own - OPTIONAL
            if name not in sys.builtin_module_names and not _of_python(name)}


def _of_python(name: str) -> bool:
    """Return whether a module comes with Python itself."""
    names = getattr(sys, 'stdlib_module_names', None)
    if names is None:
        pytest.skip('Python 3.10 is the first to say which modules are its own')
    return name in names


def _started(*patterns: str) -> Set[str]:
    """Return the programs of others that Python code starts, or names so."""
    text = '\n'.join(path.read_text(encoding='utf-8') for path in _python(*patterns))
    return {name for name in PROGRAMS if f"'{name}'" in text}


INSTALLED = ('src/self_awareness/**/*.py', 'src/self_awareness_follow_me/**/*.py', 'scripts/*',
             'nodes/*')
TESTS = ('src/self_awareness_evaluation/**/*.py', 'test/packaging/*.py', 'test/python/**/*.py',
         'test/rostest/*.py')


def test_what_cmake_needs_to_build() -> None:
    needed = _found_by_cmake('src/core/CMakeLists.txt')
    of_all = (ROOT / 'CMakeLists.txt').read_text(encoding='utf-8')
    # The only block of the file is that of the tests.
    tests = set(re.findall(r'find_package\((\w+)', ''.join(
        re.findall(r'^if\(CATKIN_ENABLE_TESTING\).*?^endif', of_all, re.MULTILINE | re.DOTALL))))
    needed |= _found_by_cmake('CMakeLists.txt') - tests
    assert {'Boost', 'Eigen3', 'PkgConfig', 'Python', 'pybind11', 're2', 'roscpp'} <= needed
    assert _missing(needed, *BUILD) == []
    assert {'roslaunch', 'rostest'} == tests
    assert _missing(tests, 'test_depend') == []


def test_what_the_sources_include() -> None:
    assert _missing(_included('include', 'src') - {'self_awareness'}, *BUILD) == []


def test_what_python_imports_when_it_runs() -> None:
    needed = _imported(*INSTALLED) | _started(*INSTALLED)
    assert {'dot', 'jinja2', 'matplotlib', 'numpy', 'rospy', 'rosrun', 'tqdm', 'yaml'} <= needed
    assert _missing(needed, *RUN) == []


def test_what_launch_files_start() -> None:
    text = ''.join(path.read_text(encoding='utf-8') for path in _files('launch/*.launch'))
    assert _missing(set(re.findall(r'pkg="(\w+)"', text)) - {'self_awareness'}, *RUN) == []


def test_what_the_tests_need() -> None:
    needed = (_found_by_cmake('test/**/CMakeLists.txt') | _included('test') | _imported(*TESTS)
              | _started(*TESTS)) - {'self_awareness', 'benchmark'}
    commands = (ROOT / 'test/CMakeLists.txt').read_text(encoding='utf-8')
    needed |= set(re.findall(r'-m (pytest)\b', commands))
    if re.search(r' -n \d', commands):
        needed.add('pytest-xdist')
    assert {'gtest', 'hypothesis', 'nlohmann_json', 'pytest', 'pytest-xdist', 'rostopic'} <= needed
    assert _missing(needed, *TEST) == []
