"""`rosrun self_awareness evaluate`: measures detectors on faults that are known, side by side."""
from __future__ import annotations

import argparse
import shlex
import sys
from pathlib import Path
from typing import Optional, Sequence

from self_awareness.commands import cli
from self_awareness.output_files import replacing
from self_awareness_evaluation import compare, offline, options, pages, readme_numbers
from self_awareness_evaluation.live import command as live


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program; return its exit code (see cli.run)."""
    given = sys.argv[1:] if argv is None else argv
    command = f'rosrun self_awareness evaluate {shlex.join(given)}'
    return cli.run(parser(), lambda arguments: arguments.work(arguments, command), argv)


def _compare(arguments: argparse.Namespace, command: str) -> None:
    text = compare.page(arguments.before, arguments.after, command)
    arguments.output.mkdir(parents=True, exist_ok=True)
    path = arguments.output / f'{compare.NAME}.md'
    with replacing(str(path)) as temporary:
        Path(temporary).write_text(text, encoding='utf-8')
    print(f'written: {path}')


def _pages(arguments: argparse.Namespace, _: str) -> None:
    print('\n'.join(pages.check(arguments.docs)))


def _numbers(arguments: argparse.Namespace, _: str) -> None:
    pages.write_section(arguments.readme, readme_numbers.SECTION,
                        readme_numbers.section(arguments.docs))
    print(f'written: {arguments.readme}')


def parser() -> argparse.ArgumentParser:
    """Return what parses the arguments."""
    parser = argparse.ArgumentParser(
        prog='evaluate', description=__doc__.split(': ', 1)[1])
    parts = parser.add_subparsers(metavar='PART', required=True)
    offline.add(parts)
    compared = parts.add_parser(
        'compare', help='two versions side by side, by what the same commands measured',
        description='Writes a page about two folders that families, simulated, ablation or '
        'recordings wrote to with -o, in two versions of this package.')
    compared.set_defaults(work=_compare)
    options.add_output(compared, 'the page')
    for name, told in (('before', 'of the one version'), ('after', 'of the other')):
        compared.add_argument(name, type=Path, metavar=name.upper(),
                              help=f'folder of the results {told}, or of folders with them')
    live.add(parts)
    listed = parts.add_parser(
        'pages', help='which pages were measured with an older method',
        description='Lists the pages that a measurement wrote, with the version of the method, '
        'and the command that measures those of an older method again.')
    listed.set_defaults(work=_pages)
    numbers = parts.add_parser(
        'numbers', help='copy the numbers of the README out of these pages',
        description='Writes the measured numbers of the README again. They are cells of the '
        'tables of the pages; src/self_awareness_evaluation/readme_numbers.py says which.')
    numbers.set_defaults(work=_numbers)
    for each in (listed, numbers):
        options.add(each, '--docs', Path, Path('docs'), 'DIR', 'folder of the pages')
    options.add(numbers, '--readme', Path, Path('README.md'), 'FILE', 'the README')
    return parser
