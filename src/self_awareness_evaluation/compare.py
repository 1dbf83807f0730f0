"""Two versions of the detectors side by side, by what the same commands measured of each."""
from __future__ import annotations

import re
from functools import partial
from pathlib import Path
from typing import Callable, Dict, List, Sequence, TypeVar

from self_awareness.output_files import replacing
from self_awareness_evaluation import pages, row_files
from self_awareness_evaluation.figures import (SOON_S, WITHIN_S, Found, Quiet, grouped, normal,
                                               of_fault)
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.records import NORMAL, OWN, REAL
from self_awareness_evaluation.robots import family_of
from self_awareness_evaluation.rows import Row
from self_awareness_evaluation.sections.page import FULL, RESEARCH
from self_awareness_evaluation.tables import NONE, alarms, counts, part, table

NAME = 'before_after'

_FOLDERS = re.compile(r' (-o|--output|--data)[ =]\S+')

_INTRODUCTION = """\
# Before and after

{written}

What two versions of the detector say of the same records: same commands, same seeds. A cell with
one value is the same in both; else it is before → **after**. Counts are of records; the time is
the median latency of all of them, and is left out where fewer than half were found.
"""

_Key = TypeVar('_Key')
_Rows = List[Row]
_Part = Callable[[Sequence[Row]], str]


def write(output: Path, before: Path, after: Path, command: str) -> Path:
    """Write the page; return its name.

    Raises:
        ValueError: a folder holds no results, or the two were measured by other commands.
        OSError: a folder or a file cannot be read or written.
    """
    text = page(before, after, command)
    path = output / f'{NAME}.md'
    with replacing(str(path)) as temporary:
        Path(temporary).write_text(text, encoding='utf-8')
    return path


def page(before: Path, after: Path, command: str) -> str:
    """Return the page; see write()."""
    lines = [_INTRODUCTION.format(written=written_by(command))]
    names = _folders(before)
    missing = sorted(set(names) ^ set(_folders(after)))
    if missing:
        raise ValueError(f'{missing[0]}: only one of {before} and {after} has results there; '
                         'run the same commands for both')
    for name in names:
        commands = [_commands(top / name) for top in (before, after)]
        if commands[0] != commands[1]:
            differing = next(pair for pair in zip([*commands[0], ''], [*commands[1], ''])
                             if pair[0] != pair[1])
            raise ValueError(f'{before / name} was written by "{differing[0]}", and '
                             f'{after / name} by "{differing[1]}"; run the same commands')
        lines += ['## Of the commands', '', *(f'    {each}' for each in commands[0]), '']
        for path in _files(before / name):
            ours, theirs = (row_files.load(top / name / FULL / path, Row)
                            for top in (before, after))
            lines += [f'### {path}', '', *_section(ours, theirs), '']
    return '\n'.join(lines)


def _folders(top: Path) -> List[str]:
    """Return the folder and those in it that hold rows, as paths from it.

    Raises:
        ValueError: there is none.
        OSError: it cannot be read.
    """
    found = [name for name in ('.', *sorted(path.name for path in top.iterdir() if path.is_dir()))
             if _files(top / name)]
    if not found:
        raise ValueError(f'{top}: holds no results; name a folder that `evaluate families`, '
                         '`simulated`, `ablation` or `recordings` wrote to (-o)')
    return found


def _files(folder: Path) -> List[str]:
    return sorted(path.name for path in (folder / FULL).glob('*.csv'))


def _commands(folder: Path) -> List[str]:
    text = (folder / RESEARCH).read_text(encoding='utf-8')
    return [_FOLDERS.sub('', each.command) for each in pages.written(text)]


def _section(before: _Rows, after: _Rows) -> List[str]:
    """Return the lines of two files of rows: all together, and each family."""
    ours, theirs = (grouped(rows, lambda row: (row.subject, row.fault, row.source))
                    for rows in (before, after))  # a run that went on has another order
    same = sum(one == other for key in ours for one, other in zip(ours[key], theirs.get(key, [])))
    lines = [f'Rows that are the same to the last digit: {same} of '
             f'{max(len(before), len(after))}.', '']
    kinds = list(grouped([row for row in [*before, *after] if row.fault != NORMAL],
                         lambda row: row.fault))
    if any(kind.startswith('crash:') for kind in kinds):
        kinds.append('crash')
    parts = _parts(kinds)
    sides = [grouped(rows, _subject) for rows in (before, after)]
    subjects = list(dict.fromkeys([*sides[0], *sides[1]]))
    columns = [[_both(told, sides, subject) for told in parts.values()] for subject in subjects]
    lines += table(['', *subjects], [[name, *cells] for name, *cells in zip(parts, *columns)])
    of_families = [grouped(rows, lambda row: (_family(row), _subject(row)))
                   for rows in (before, after)]
    keys = list(dict.fromkeys([*of_families[0], *of_families[1]]))
    if len({family for family, _ in keys}) > 1:
        lines += ['', *table(['records', 'judged by', *parts], [
            [*key, *(_both(told, of_families, key) for told in parts.values())] for key in keys])]
    return lines


def _parts(kinds: Sequence[str]) -> Dict[str, _Part]:
    """Return what is told of rows, by title."""
    found: Dict[str, _Part] = {
        'false alarms': lambda rows: alarms(_quiet(rows).alarms, _quiet(rows).hours),
        'WARN': lambda rows: alarms(_quiet(rows).warnings, _quiet(rows).hours),
        'alarm stands': lambda rows: f'{60.0 * sum(row.standing_hours for row in rows):.3g} min'}
    for kind in kinds:
        within_s = WITHIN_S if kind == 'crash' else (SOON_S, float('inf'))
        found[kind] = _of_kind(kind, partial(_counts, within_s))
        found[f'{kind}: guilty first'] = _of_kind(
            kind, lambda each: part(each.first, in_percent=False))
    found['guilty first, all'] = _of_kind('', lambda each: part(each.first, in_percent=False))
    found['guilty at the end, all'] = _of_kind('', lambda each: part(each.at_end,
                                                                     in_percent=False))
    found['alarms after a restart'] = _of_kind(
        '', lambda each: f'{each.after[0]} after {each.after[1]}' if each.after[1] else NONE)
    return found


def _counts(within_s: Sequence[float], found: Found) -> str:
    return counts(found, *within_s)


def _of_kind(kind: str, told: Callable[[Found], str]) -> _Part:
    return lambda rows: told(Found.of(of_fault(rows, kind)))


def _quiet(rows: Sequence[Row]) -> Quiet:
    return Quiet.of(rows if rows[0].subject.part == OWN else normal(rows))


def _subject(row: Row) -> str:
    subject = row.subject
    told = [subject.system, subject.change, subject.learning,
            '' if subject.budget is None else f'budget {subject.budget:g}']
    return ', '.join(each for each in told if each)


def _family(row: Row) -> str:
    return row.subject.robot if row.subject.part == REAL else family_of(row.subject.robot)


def _both(told: _Part, sides: Sequence[Dict[_Key, _Rows]], key: _Key) -> str:
    before, after = (told(side[key]) if key in side else NONE for side in sides)
    return before if before == after else f'{before} → **{after}**'
