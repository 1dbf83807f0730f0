"""What the rooms of the C++ sources may include (docs/developers.md)."""
from __future__ import annotations

import re
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
    'what is counted': {'kAhead', 'kAttributesFrom', 'kDelayBins', 'kFirstEdge', 'kLongestGaps',
                        'kPriorCount', 'kRateSpan', 'kSpan', 'kSpanOfAge'},
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
