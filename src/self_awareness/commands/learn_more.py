"""`rosrun self_awareness learn_more`: trains and calibrates again, with what came since."""
from __future__ import annotations

import argparse
import os

from self_awareness.calibration.heads_and_tails import START_UP_S
from self_awareness.commands import cli
from self_awareness.comparison.changes import compare
from self_awareness.comparison.sides import with_recordings
from self_awareness.judging import load_model
from self_awareness.learning import age, more, programs
from self_awareness.output_files import MODEL, check_outputs
from self_awareness.reporting import age_text, diff_text

_EPILOG = """\
What the model was learned from is not learned twice. Recordings in which it finds an alarm or a
suspicion are left out: accept what is normal first (~accept). Two thirds of each other one are
trained on, and the limits are found on the rest; recordings that the model was calibrated on are
calibrated on again if you name them, too. Read what changed before you take the new model.
examples:
  learn_more --model robot.model                 with the logs of robot.model.kept
  learn_more --model robot.model normal_*.bag -o new.model
  learn_more --model robot.model --take          the old one stays, as robot.model.before
"""


def _learn_more(arguments: argparse.Namespace) -> None:
    new = arguments.output or f'{arguments.model}.new'
    if arguments.take and not arguments.logs and os.path.exists(new):
        _take(new, arguments.model)
        return
    named = age.logs_of(arguments.model, arguments.logs)
    cli.say_found(named, arguments.skip_bad)
    check_outputs([(new, MODEL)], [arguments.model, *(file for part in named.parts
                                                      for file in part.files)])
    trained = load_model(arguments.model, 'evidence')
    found = age.age_of(arguments.model, trained, named, arguments.skip_bad)
    cli.print_lines(age_text.lines(found))
    division = more.divided(trained, found, arguments.start_up)
    if not division.training:
        raise ValueError('no recording is left to learn from (the reasons are above); name '
                         'others, or accept first what is normal now (~accept)')
    cli.stand_back()
    programs.train_and_calibrate(division, new, os.path.dirname(os.path.abspath(new)),
                                 arguments.budget or found.budget, lambda: False, arguments.model)
    print('what changed, in the logs:')
    learned = list(dict.fromkeys(part.whole() for part in division.training))
    for line in diff_text.lines(compare(*with_recordings(arguments.model, 'the logs', learned))):
        print(f'  {line}')
    cli.say_skipped('learn_more', named.bad)
    if arguments.take:
        _take(new, arguments.model)
    else:
        print(f'written: {new}; {arguments.model} is as it was (--take takes the new one)')


def _take(new: str, model: str) -> None:
    check_outputs([(model, MODEL)], [new])
    before = more.take(new, model)
    print(f'taken: {model} is the new one now, and {before} the old one; a monitor takes it with '
          '~reload')


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('logs', nargs='*', metavar='LOG',
                        help='a recording of normal operation since, or a folder of them '
                             '(default: MODEL.kept)')
    parser.add_argument('--model', required=True, metavar='MODEL', help='to add to')
    parser.add_argument('-o', '--output', metavar='NEW',
                        help='file to write (default: MODEL.new)')
    parser.add_argument('--budget', type=cli.budget, metavar='N',
                        help='false alarms an hour that the limits allow (default: that of '
                             'MODEL)')
    parser.add_argument('--start-up', type=cli.offset, default=START_UP_S, metavar='S',
                        help='leave out so much after each start of the robot, in s (default: '
                             f'{START_UP_S:g})')
    cli.add_skip_bad(parser)
    parser.add_argument('--take', action='store_true',
                        help='let the new model take the place of MODEL, which is kept; without '
                             'LOG, the one that is written already')


main = cli.Program('learn_more', __doc__, _EPILOG, _arguments, _learn_more)
