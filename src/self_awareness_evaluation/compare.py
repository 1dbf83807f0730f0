"""Two versions of the detectors side by side, by what the same commands measured of each."""
from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import Any, Callable, Dict, List, Sequence

from self_awareness.output_files import replacing
from self_awareness_evaluation import options, pages
from self_awareness_evaluation.figures import NONE, cells, grouped, table
from self_awareness_evaluation.pages import FULL, RESEARCH, written_by
from self_awareness_evaluation.records import NORMAL
from self_awareness_evaluation.rows import Row, load

_FOLDERS = re.compile(r' (-o|--output|--data)[ =]\S+')

_INTRODUCTION = """\
# Before and after

{written}

What two versions of the detector say of the same records: same commands, same seeds. A cell with
one value is the same in both; else it is before → **after**. Counts are of records: found within
5 s, and at all; the time is the median latency of all of them, and is left out where fewer than
half were found. False alarms and WARN are those without a fault, before onsets included.
"""

_Rows = List[Row]


def add(parts: Any) -> None:
    """Add the command to the parts of the program."""
    parser = parts.add_parser(
        'compare', help='two versions side by side, by what the same commands measured',
        description='Writes a page about two folders that families, simulated, ablation or '
        'recordings wrote to with -o, in two versions of this package.')
    parser.set_defaults(work=_compare)
    options.add_output(parser, 'the page')
    for name, told in (('before', 'of the one version'), ('after', 'of the other')):
        parser.add_argument(name, type=Path, metavar=name.upper(),
                            help=f'folder of the results {told}, or of folders with them')


def _compare(arguments: argparse.Namespace, command: str) -> None:
    """Write the page.

    Raises:
        ValueError: a folder holds no results, or the two were measured by other commands.
    """
    before, after = arguments.before, arguments.after
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
            ours, theirs = (load(top / name / FULL / path, Row)
                            for top in (before, after))
            lines += [f'### {path}', '', *_section(ours, theirs), '']
    arguments.output.mkdir(parents=True, exist_ok=True)
    path = arguments.output / 'before_after.md'
    with replacing(str(path)) as temporary:
        Path(temporary).write_text('\n'.join(lines), encoding='utf-8')
    print(f'written: {path}')


def _folders(top: Path) -> List[str]:
    """Return the folder and those in it that hold rows, as paths from it."""
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
    names = list(dict.fromkeys(row.fault for row in [*before, *after] if row.fault != NORMAL))
    kinds = {name: [name] for name in [*names, *(['crash'] if any(
        name.startswith('crash:') for name in names) else [])]}
    columns = _compared(before, after, kinds, lambda _: '')
    head, *body = ([column[row] for column in columns] for row in range(1, len(columns[0])))
    lines += table(head, body)
    if len({row.subject.family for row in before}) > 1:
        head, *body = _compared(before, after, kinds, lambda row: row.subject.family)
        lines += ['', *table(head, body)]
    return lines


def _compared(before: _Rows, after: _Rows, kinds: Dict[str, List[str]],
              group: Callable[[Row], str]) -> List[List[str]]:
    """Return a row of titles, and one for the records of each group and for who judged them."""
    sides = [{key: cells(of_key, kinds) for key, of_key in grouped(
        rows, lambda row: (group(row), _subject(row))).items()} for rows in (before, after)]
    keys = list(dict.fromkeys([*sides[0], *sides[1]]))
    titles = [title for title in next(iter(sides[0].values()))
              if any(side[key][title].text != NONE for side in sides for key in side)]
    return [['records', 'judged by', *titles],
            *([*key, *(_both([side[key][title].text if key in side else NONE for side in sides])
                       for title in titles)] for key in keys)]


def _subject(row: Row) -> str:
    subject = row.subject
    told = [subject.system, subject.change, subject.learning,
            '' if subject.budget is None else f'budget {subject.budget:g}']
    return ', '.join(each for each in told if each)


def _both(texts: Sequence[str]) -> str:
    before, after = texts
    return before if before == after else f'{before} → **{after}**'
