"""`rosrun self_awareness diff`: tells what changed from a model to another, or to a recording."""
from __future__ import annotations

import argparse

from self_awareness.commands import cli
from self_awareness.comparison.changes import compare
from self_awareness.comparison.sides import read_sides
from self_awareness.output_files import PAGE, check_outputs
from self_awareness.parts import BagPart
from self_awareness.reporting import diff_text
from self_awareness.reporting.report.diff_page import save_diff
from self_awareness.reporting.report.page import check_installed

_EPILOG = """\
Give two models, or a model and recordings: a bag, a part of it (BAG@START-END), or a folder of
bags. Recordings are counted with the encoding of the model. What matters most comes first: what is
gone, ended or new, then the largest changes of rates, gaps and delays. Changes are left out that
could be chance, or are less than the model's least effect (info --tuning).
examples:
  diff before_update.model after_update.model
  diff robot.model today.bag --html today.html
"""


def _diff(arguments: argparse.Namespace) -> None:
    check_outputs([(arguments.html, PAGE)],
                  [BagPart.parse(name).path for name in (arguments.before, arguments.after)])
    if arguments.html is not None:
        check_installed()
    before, after, bad = read_sides(arguments.before, arguments.after, arguments.skip_bad)
    comparison = compare(before, after)
    cli.show(arguments.json, diff_text.as_values(comparison), diff_text.lines(comparison))
    if arguments.html is not None:
        save_diff(arguments.html, comparison)
    cli.say_skipped('diff', bad)


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('before', metavar='A', help='how it was')
    parser.add_argument('after', metavar='B', help='how it is')
    parser.add_argument('--json', action='store_true', help='print JSON, for programs')
    parser.add_argument('--html', type=cli.page_file, metavar='FILE.html',
                        help='write a page for a browser, too')
    cli.add_skip_bad(parser)


main = cli.Program('diff', __doc__, _EPILOG, _arguments, _diff)
