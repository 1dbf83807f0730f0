"""Finds names that have another number at every start of the robot, and takes each as one.

Some nodes, such as MATLAB's, draw a number for their name when they start. What differs by a
number alone from start to start, and never stands beside itself, is one. What is numbered on
purpose has the same numbers in all starts, or stands beside others of its kind.
"""
from __future__ import annotations

import re
from collections import Counter, defaultdict
from contextlib import closing
from dataclasses import dataclass
from typing import (DefaultDict, Dict, FrozenSet, Iterable, Iterator, List, Optional, Sequence,
                    Set, Tuple)

from self_awareness import (BagError, EncodingRules, EventType, TrainedModel, recorded_types,
                            summarise_bag)
from self_awareness.parts import BagPart
from self_awareness.reporting.text import first_of
from self_awareness.training.counting import Counting
from self_awareness.workers import Workers

Renames = List[Tuple[str, str]]  # patterns and names, as in EncodingRules.rename

_DIGITS = re.compile('[0-9]+')
_LETTER = re.compile('[A-Za-z]')
_ANY = '#'  # stands for a number in a name; no topic has it
_MOST_NUMBERS = 4  # in a part of a name between two slashes; what has more is no name of a person
_MOST_SHOWN = 3
_REST, _REST_TAKEN = '(/.*)?', r'\1'
"""What follows a name: topics in a node's namespace have its number, too."""


@dataclass(frozen=True)
class Heard:
    """What was heard in a recording."""

    robot: str  # its name; empty: not known
    start: str  # of the robot; recordings of one start have the same
    # What its events call nodes and topics.
    sources: FrozenSet[str]
    scopes: FrozenSet[str]

    @classmethod
    def of(cls, robot: str, start: str, types: Set[EventType]) -> Heard:
        """Return what a recording of these event types has heard."""
        return cls(robot, start, frozenset(each.source for each in types),
                   frozenset(each.scope for each in types))

    def renamed(self, renames: Renames) -> Heard:
        """Return the same by other names."""
        rules = EncodingRules()
        rules.rename = renames
        return Heard(self.robot, self.start,
                     frozenset(rules.sources_of(set(self.sources)).values()),
                     frozenset(rules.scopes_of(set(self.scopes)).values()))

    def stays_apart(self, renames: Renames) -> bool:
        """Return whether no two nodes, and no two topics, become one."""
        renamed = self.renamed(renames)
        return (len(renamed.sources), len(renamed.scopes)) == (len(self.sources), len(self.scopes))


@dataclass(frozen=True)
class Numbered:
    """Names that differ by a number alone."""

    rename: Tuple[str, str]  # that makes one of them
    examples: Tuple[str, ...]  # the names, in order

    def __str__(self) -> str:
        return f'{first_of(self.examples, _MOST_SHOWN)}: differ by a number alone'


def of_training(counting: Counting, parts: Sequence[BagPart], workers: Workers,
                base: Optional[TrainedModel]) -> Tuple[Renames, List[str]]:
    """Find what a training takes as one.

    Args:
        counting: how recordings are counted.
        parts: of the training.
        workers: who reads them; what cannot be read is left out: who counts it tells of it.
        base: a model that is added to, whose names are changed likewise.

    Returns:
        rules to rename, after those of the counting; and what is to be told.
    """
    recorded = _recorded(counting, parts, workers)
    found = find([*([] if base is None else _of_model(base)), *recorded])
    if not found:
        return [], []
    renames = [*counting.rename, *(each.rename for each in found)]
    # The first rule that matches counts, so a name that is renamed already keeps its number.
    without_effect = {each.rename for each in find(_recorded(
        Counting(counting.encoding, rename=tuple(renames)), parts, workers))}
    taken: Renames = []
    lines = []
    for each in found:
        why = ('their names are renamed already: let that rule take the number away, too'
               if each.rename in without_effect else _change(base, each))
        if not why:
            taken.append(each.rename)
        lines.append(f'{each}; {why}' if why else _told(each))
    return taken, lines


def of_models(models: Iterable[TrainedModel]) -> Tuple[Renames, List[str]]:
    """Find what models that are to be merged take as one.

    Returns:
        the rules of all of them, where the others' begin with those of each; and what is to be
        told.
    """
    known = [(model.encoding.rename, _of_model(model)) for model in models]
    rules = max((rename for rename, _ in known), key=len)
    found = find([each.renamed(left(rename, rules)) for rename, heard in known for each in heard])
    return [*rules, *(each.rename for each in found)], [_told(each) for each in found]


def left(done: Renames, rules: Renames) -> Renames:
    """Return the rules after those that are done; none where these are others."""
    return rules[len(done):] if rules[:len(done)] == done else []


def find(recordings: Sequence[Heard]) -> List[Numbered]:
    """Find what has another number in each start; the longest names first.

    Where robots are known by name, a number that is the same in all starts of a robot is its own.
    """
    paths = [{path for names in (each.sources, each.scopes) for name in names
              for path in _paths(name)} for each in recordings]
    templates = {'': ''}  # by path
    members: DefaultDict[str, Set[str]] = defaultdict(set)
    for depth in range(1, 1 + max((path.count('/') for of in paths for path in of), default=0)):
        here = [{path for path in of if path.count('/') == depth} for of in paths]
        by_template: DefaultDict[str, Dict[int, Set[str]]] = defaultdict(dict)
        for index, of_recording in enumerate(here):
            for path in of_recording:
                for template in _open(path, templates):
                    by_template[template].setdefault(index, set()).add(path)
        changing = {template for template, each in by_template.items()
                    if _changes(each, recordings)}
        for path in set().union(*here):
            before, last = path.rsplit('/', 1)
            template = next(filter(changing.__contains__, _open(path, templates)), '')
            templates[path] = template or f'{templates[before]}/{last}'
            if template:
                members[template].add(path)
    found: List[Numbered] = []
    for template in sorted(members, key=lambda each: (-each.count('/'), each)):
        for name in (_without(template), template.replace(_ANY, 'N')):
            rename = _pattern(template), name.replace('\\', r'\\') + _REST_TAKEN
            renames = [*(each.rename for each in found), rename]
            if all(each.stays_apart(renames) for each in recordings):
                found.append(Numbered(rename, tuple(sorted(members[template]))))
                break
    return found


def _of_model(model: TrainedModel) -> List[Heard]:
    """Return what was heard in each recording that a model was trained on."""
    return [Heard.of(robot, str(start), types) for robot, start, _, types in model.heard_in]


def _told(numbered: Numbered) -> str:
    name = numbered.rename[1][:-len(_REST_TAKEN)]
    return f'{numbered} from start to start: taken as one, {name} (--rename gives another name)'


def _recorded(counting: Counting, parts: Sequence[BagPart], workers: Workers) -> List[Heard]:
    whole = list(dict.fromkeys(part.whole() for part in parts))
    with closing(workers.map(_heard, counting, whole, 'bags, for names')) as heard:
        return [each for each in heard if each is not None]


def _heard(counting: Counting, part: BagPart) -> Optional[Heard]:
    try:
        types = recorded_types(part.files, counting.encoding_of(part), part.recording)
        if part.recording is None:
            return Heard.of(part.robot, part.path, types)
        summary = summarise_bag(part.files, part.recording)
    except (BagError, ValueError):
        return None
    start = str(summary.robot_start) if summary.robot_start else str(part)
    return Heard.of(summary.robot or part.robot, start, types)


def _change(base: Optional[TrainedModel], numbered: Numbered) -> str:
    """Rename what a model has learned; return why it cannot be."""
    if base is None:
        return ''
    try:
        base.add_renames([numbered.rename])
    except ValueError:
        return 'the model knows several of them, as earlier versions learned them: train it again'
    return ''


def _paths(name: str) -> Iterator[str]:
    """Return a name up to each of its slashes, and all of it."""
    if name.startswith('/') and _ANY not in name:
        yield from (name[:match.start()] for match in re.finditer('/', name) if match.start())
        yield name


def _open(path: str, templates: Dict[str, str]) -> Iterator[str]:
    """Return a path with each of the numbers in its last part open, then with all of them."""
    before, last = path.rsplit('/', 1)
    if not _LETTER.search(last):
        return  # a number alone is no name with a number
    begin = templates[before] + '/'
    numbers = list(_DIGITS.finditer(last))[:_MOST_NUMBERS]
    for number in numbers:
        yield begin + last[:number.start()] + _ANY + last[number.end():]
    if len(numbers) > 1:
        yield begin + _DIGITS.sub(_ANY, last)


def _changes(paths: Dict[int, Set[str]], recordings: Sequence[Heard]) -> bool:
    """Return whether most starts of a robot have a path of their own, and never two at once."""
    if any(len(each) > 1 for each in paths.values()):
        return False
    starts: DefaultDict[Tuple[str, str], Set[str]] = defaultdict(set)
    for index, each in paths.items():
        starts[recordings[index].robot, recordings[index].start] |= each
    robots = Counter(robot for robot, _ in starts)
    known = Counter(path for each in starts.values() for path in each)
    compared = [start for start in starts if robots[start[0]] > 1]
    own = [start for start in compared if all(known[path] == 1 for path in starts[start])]
    return 2 * len(own) > len(compared)


def _pattern(template: str) -> str:
    return '[0-9]+'.join(re.escape(part) for part in template.split(_ANY)) + _REST


def _without(template: str) -> str:
    """Return a name without its numbers, and what joins them to the rest."""
    return '/'.join(re.sub(f'[_-]?{_ANY}', '', re.sub(f'^{_ANY}[_-]', '', part))
                    for part in template.split('/'))
