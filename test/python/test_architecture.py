"""What may include or import what, in C++ and Python, and who reaches what threads share."""
from __future__ import annotations

import ast
import re
import subprocess
from pathlib import Path
from typing import Dict, List, Set

import pytest

ROOT = Path(__file__).resolve().parents[2]

# By room, what it may include of the others.
ROOMS: Dict[str, Set[str]] = {
    'core/stream': set(),
    'core/verdict': {'stream'},
    'core/paper': {'stream', 'verdict'},
    'core/evidence': {'stream', 'verdict'},
    # What lies beside the rooms of core/evidence (judge, lanes) may include all of them; of it,
    # the rooms may include the tuning.
    'core/evidence/count': set(),
    'core/evidence/watch': {'count', 'tuning'},
    'core/evidence/channel': {'count', 'watch', 'tuning'},
    'core/evidence/limits': {'count', 'watch', 'channel', 'tuning'},
    'core/evidence/explain': {'count', 'watch', 'channel', 'tuning'},
    'core/evidence/excuse': {'count', 'watch', 'channel', 'tuning', 'explain'},
    'core/evidence/presence': {'count', 'watch', 'channel', 'tuning', 'explain', 'excuse'},
    'ros': {'core'},
    'node': {'core', 'ros'},
    'monitor': {'core', 'ros', 'node'},
    'recorder': {'core', 'ros', 'node'},
    'python': {'core', 'ros'},
}
# Numbers of core/evidence beside its tuning. None of them is one of the method: what training
# counts, and with it the format of models, is fixed; the promise is a formula; the rest is how
# something is computed, or put in words.
BESIDE_TUNING: Dict[str, Set[str]] = {
    'what is counted': {'kAhead', 'kDelayBins', 'kFirstEdge', 'kLongestGaps', 'kPriorCount',
                        'kRateSpan', 'kSettled', 'kSpan', 'kSpanOfAge'},
    'what is promised': {'kBudget', 'kHoursOfRobots', 'kQuantile', 'kQuietest', 'kRaised'},
    'what info says': {'kFalseAlarms', 'kFarLater', 'kFoundLate', 'kGoesOver', 'kLongestPause'},
    'multiples of kRateSpan': {'kHold', 'kKept', 'kLongEnough', 'kOneCause', 'kRestart'},
    'bins': {'kBias', 'kClasses', 'kExponents', 'kFirstExponent', 'kLast', 'kLateGap',
             'kMostBins', 'kSlightly', 'kClassBack'},
    'bounds of a computation': {'kMost', 'kMostDoublings', 'kMostParts', 'kMostStarts',
                                'kMostSum', 'kMostTypesOfAllPairs', 'kTailPoints', 'kTogether'},
    'beyond all values': {'kEnough', 'kForEver', 'kLeastTime', 'kNotSeen', 'kUnused'},
    'words and scores': {'kDay', 'kMostNamed', 'kMostTopics', 'kStillBusy', 'kThreshold'},
}
NUMBER = re.compile(r'constexpr [\w:]+ (k\w+) = ([^;]*\d[^;]*);')
CHANNEL = 'src/core/evidence/channel'
LIST_OF_CHANNELS = 'channels_of_the_method.cpp'
INCLUDE = re.compile(r'^#include ["<]([^">]+)[">]', re.MULTILINE)


def _sources(*folders: str) -> List[Path]:
    return [path for folder in folders for path in sorted((ROOT / folder).rglob('*'))
            if path.suffix in ('.h', '.cpp')]


def _included(path: Path) -> List[str]:
    return INCLUDE.findall(path.read_text(encoding='utf-8'))


def _rooms(path: Path, beside: str) -> Set[str]:
    """Return what a source includes of the rooms in a folder ('': of src)."""
    found = set()
    for name in _included(path):
        match = re.match(rf'(?:self_awareness/)?{beside}(\w+)[/.]', name)
        # Of roscpp, headers begin with ros/ as well.
        if match and ((ROOT / 'src' / name).exists() or (ROOT / 'include' / name).exists()):
            found.add(match[1])
    return found


def _channels() -> List[Path]:
    """Return the headers of the channels."""
    return [path for path in _sources(CHANNEL)
            if re.search(r': public Channel {', path.read_text(encoding='utf-8'))]


@pytest.mark.parametrize('room', sorted(ROOMS))
def test_rooms_include_what_lies_below(room: str) -> None:
    sources = _sources(f'include/self_awareness/{room}', f'src/{room}')
    assert sources
    folder, _, name = room.rpartition('/')
    for path in sources:
        assert _rooms(path, f'{folder}/' if folder else '') <= ROOMS[room] | {name}, path


def test_the_evidence_has_no_other_rooms() -> None:
    for folder in ('include/self_awareness/core/evidence', 'src/core/evidence'):
        assert {path.name for path in (ROOT / folder).iterdir() if path.is_dir()
                } <= {room.rpartition('/')[2] for room in ROOMS}


def test_no_number_of_the_method_lies_beside_its_tuning() -> None:
    found = {name for path in _sources('src/core/evidence', 'include/self_awareness/core/evidence')
             for name, value in NUMBER.findall(path.read_text(encoding='utf-8'))
             if 'numeric_limits' not in value}
    assert found == set.union(*BESIDE_TUNING.values()), 'put it into tuning.h'


def test_no_channel_knows_another_one() -> None:
    headers = _channels()
    assert len(headers) >= 5
    for header in headers:
        own = f'{CHANNEL[4:]}/{header.name}'
        known_to = {path.relative_to(ROOT / CHANNEL).as_posix() for path in _sources(CHANNEL)
                    if own in _included(path)}
        assert known_to == {f'{header.stem}.cpp', LIST_OF_CHANNELS}, header
        assert not [path for path in _sources('include', 'src')
                    if own in _included(path) and path.parent != ROOT / CHANNEL], header


def test_a_channel_is_named_in_its_own_file() -> None:
    """Others go by what a channel finds, not by which one it is."""
    named = r'\bname\(\) const override {([^}]*)}'
    names = {name for header in _channels()
             for text in re.findall(named, header.read_text(encoding='utf-8'))
             for name in re.findall(r'"[^"]+"', text)}
    assert len(names) > len(_channels()), names
    # A number of the method, and a field in a bag, have such a name.
    allowed = {ROOT / 'src/core/evidence/tuning.cpp', ROOT / 'src/ros/bag/bag_records.cpp',
               ROOT / 'src/ros/bag/bag_writer.cpp', *_channels()}
    for path in _sources('include', 'src/core', 'src/ros', 'src/node', 'src/monitor',
                         'src/recorder'):
        if path not in allowed:
            text = path.read_text(encoding='utf-8')
            assert not [name for name in names if name in text], path


def test_the_core_knows_no_ros() -> None:
    for path in _sources('include/self_awareness/core', 'src/core'):
        for name in _included(path):
            assert re.match(r'core/|self_awareness/core/|Eigen/|\w+$', name), (path, name)


def test_public_headers_include_no_others() -> None:
    for path in _sources('include'):
        for name in _included(path):
            assert not re.match(r'(core|ros|monitor)/', name) or not (
                ROOT / 'src' / name).exists(), (path, name)


def test_no_part_of_the_monitor_knows_another_one() -> None:
    """What a part overrides, others call by `Part`; parameters and reports are of all."""
    folder = ROOT / 'src/monitor'
    parts = {path.name for path in folder.glob('*.h')
             if ': public Part {' in path.read_text(encoding='utf-8')}
    assert len(parts) >= 10
    for path in _sources('src/monitor'):
        known = set(_included(path)) & parts - {path.with_suffix('.h').name}
        if path.stem not in ('monitor', 'parameters', 'diagnostics'):
            assert not known, path


def test_the_monitor_is_its_wiring() -> None:
    code = (ROOT / 'src/monitor/monitor.cpp').read_text(encoding='utf-8')
    assert len(code.splitlines()) <= 250


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
