"""Pages that commands write: their sections, with which version of the method, and two versions of
it side by side."""
from __future__ import annotations

import argparse
import json
import os
import platform
import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

from self_awareness import METHOD
from self_awareness.output_files import replacing, save_table
from self_awareness_evaluation import options
from self_awareness_evaluation.figures import NONE, cells, columns, grouped, table
from self_awareness_evaluation.records import NORMAL
from self_awareness_evaluation.rows import Row, load

# The page that is read in two minutes, and the one for who wants to know more.
RESULTS, RESEARCH = 'README.md', 'research.md'
# Folder below that of the pages for the rows of all records, which is not kept in the repository.
FULL = 'full'

_WRITTEN = re.compile(r'^Written by `(?P<command>.+?)`( on [\d-]+)?'
                      r'(, method (?P<method>\d+))?; do not edit', re.MULTILINE)
_FOLDERS = re.compile(r' (-o|--output|--data)[ =]\S+')

_INTRODUCTION = """\
# Before and after

{written}

What two versions of the detector say of the same records: same commands, same seeds. A cell with
one value is the same in both; else it is before → **after**. Counts are of records: found within
5 s, and at all; the time is the median latency of all of them, and is left out where fewer than
half were found. False alarms and WARN are those without a fault, before onsets included.
"""


def machine() -> Dict[str, Any]:
    """Return the properties of this machine that numbers depend on."""
    return {'cores': os.cpu_count(), 'machine': platform.machine(), 'kernel': platform.release()}


def write_section(page: Path, name: str, text: str, title: str = '') -> None:
    """Replace the text between the markers `<!-- NAME -->` and `<!-- /NAME -->` of a page. A page
    that is not there is made, and one without the section gets it at its end, below a title if
    there is one; without one, raise ValueError."""
    told = '# Measured\n' if title and not page.is_file() else page.read_text(encoding='utf-8')
    if title and f'<!-- {name} -->' not in told:
        told += f'\n## {title}\n\n<!-- {name} -->\n<!-- /{name} -->\n'
    before, opening, rest = told.partition(f'<!-- {name} -->')
    _, closing, after = rest.partition(f'<!-- /{name} -->')
    if not (opening and closing):
        raise ValueError(f'{page} has no section {name}')
    with replacing(str(page)) as temporary:
        Path(temporary).write_text(f'{before}{opening}\n{text}\n{closing}{after}',
                                   encoding='utf-8')


@dataclass(frozen=True)
class Section:
    """What a measurement writes."""

    name: str  # of the section, and of the files
    title: str  # above it, on a page that does not have it yet
    pages: Dict[str, List[str]]  # by page, the lines of the section
    # Of a row in the file of figures: its name; None: there is none but all together.
    group: Optional[Callable[[Row], str]] = None


def rows_path(folder: Path, name: str) -> Path:
    """Return where the rows of a measurement are kept."""
    return folder / FULL / f'{name}.csv'


def write(folder: Path, section: Section, rows: Sequence[Row], command: str) -> List[Path]:
    """Write a section of the pages, and the figures; return the names of the files."""
    figures = folder / f'{section.name}.csv'
    kinds = sorted({row.fault.partition(':')[0] for row in rows} - {NORMAL})
    # Those of each subject, of all groups together and of each group.
    groups: List[Callable[[Row], str]] = [lambda _: 'all']
    groups += [] if section.group is None else [section.group]
    table = [{**{name: getattr(subject, name) for name in
                 ('part', 'learning', 'system', 'change', 'budget')},
              'of': name, **columns(of_group, kinds)}
             for group in groups for (name, subject), of_group in grouped(
                 rows, lambda row: (group(row), replace(row.subject, robot=''))).items()]
    save_table(str(figures), list(table[0]), [list(each.values()) for each in table])
    for page, lines in section.pages.items():
        text = '\n'.join([written_by(command), '', *lines])
        write_section(folder / page, section.name, text, section.title)
    return [rows_path(folder, section.name), figures, *(folder / page for page in section.pages)]


@dataclass(frozen=True)
class Written:
    """A page, or a section of one: its path from the folder of all, the command that wrote it, and
    the version of the method that was measured; None: of before versions were told."""

    page: str
    command: str
    method: Optional[int]

    @property
    def is_old(self) -> bool:
        """Whether another method was measured than that of this version."""
        return self.method != METHOD


def written_by(command: str, date: str = '') -> str:
    """Return the line by which a page says what wrote it, and when, if that matters."""
    return (f'Written by `{command}`' + (f' on {date}' if date else '')
            + f', method {METHOD}; do not edit.')


def written(text: str, page: str = '') -> List[Written]:
    """Return what commands wrote of a page."""
    return [Written(page, found['command'], int(found['method']) if found['method'] else None)
            for found in _WRITTEN.finditer(text)]


def find(docs: Path) -> List[Written]:
    """Return all that commands wrote in a folder and those below it."""
    found = [each for path in sorted(docs.rglob('*.md'))
             for each in written(path.read_text(encoding='utf-8'), str(path.relative_to(docs)))]
    return found + [Written(str(path.relative_to(docs)), f'scripts/benchmark {path.stem}',
                            json.loads(path.read_text(encoding='utf-8')).get('method'))
                    for path in sorted(docs.glob('performance/*.json'))]


def check(docs: Path) -> List[str]:
    """Return a line for each page; raise ValueError if no command wrote one there."""
    found = find(docs)
    if not found:
        raise ValueError(f'{docs}: holds no page that `evaluate` wrote')
    return [f'{"old" if each.is_old else "ok "}  {each.page}: '
            + ('an older method' if each.method is None else f'method {each.method}')
            + (f'; measure it again: {each.command}' if each.is_old else '') for each in found]


def add_compare(parts: Any) -> None:
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
    """Write the page; raise ValueError if a folder holds no results, or the two were measured by
    other commands."""
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
            ours, theirs = (load(top / name / FULL / path, Row) for top in (before, after))
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
    return [_FOLDERS.sub('', each.command) for each in written(text)]


def _section(before: List[Row], after: List[Row]) -> List[str]:
    """Return the lines of two files of rows: all together, and each family."""
    ours, theirs = (grouped(rows, lambda row: (row.subject, row.fault, row.source))
                    for rows in (before, after))  # a run that went on has another order
    same = sum(one == other for key in ours for one, other in zip(ours[key], theirs.get(key, [])))
    lines = [f'Rows that are the same to the last digit: {same} of '
             f'{max(len(before), len(after))}.', '']
    kinds = {row.fault: [row.fault] for row in [*before, *after] if row.fault != NORMAL}
    if any(name.startswith('crash:') for name in kinds):
        kinds['crash'] = ['crash']
    # Who judged is a column here, and below a row for each family.
    rows = list(zip(*_compared(before, after, kinds, lambda _: '')))[1:]
    lines += table(rows[0], rows[1:])
    if len({row.subject.family for row in before}) > 1:
        head, *body = _compared(before, after, kinds, lambda row: row.subject.family)
        lines += ['', *table(head, body)]
    return lines


def _compared(before: List[Row], after: List[Row], kinds: Dict[str, List[str]],
              group: Callable[[Row], str]) -> List[List[str]]:
    """Return a row of titles, and one for the records of each group and for who judged them."""
    def judged_by(row: Row) -> Tuple[str, str]:
        subject = row.subject
        told = (subject.system, subject.change, subject.learning,
                '' if subject.budget is None else f'budget {subject.budget:g}')
        return group(row), ', '.join(filter(None, told))

    sides = [{key: cells(of_key, kinds) for key, of_key in grouped(rows, judged_by).items()}
             for rows in (before, after)]
    keys = list(dict.fromkeys([*sides[0], *sides[1]]))
    titles = [title for title in next(iter(sides[0].values()))
              if any(side[key][title].text != NONE for side in sides for key in side)]

    def cell(key: Tuple[str, str], title: str) -> str:
        one, other = (side[key][title].text if key in side else NONE for side in sides)
        return one if one == other else f'{one} → **{other}**'

    return [['records', 'judged by', *titles],
            *([*key, *(cell(key, title) for title in titles)] for key in keys)]
