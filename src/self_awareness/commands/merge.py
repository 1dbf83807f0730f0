"""`rosrun self_awareness merge`: adds models of robots of the same kind to one."""
from __future__ import annotations

import argparse

from self_awareness import TrainedModel
from self_awareness.commands import cli
from self_awareness.judging import PAPER
from self_awareness.output_files import MODEL, check_outputs
from self_awareness.recordings import DistinctRecordings
from self_awareness.reporting import verdict
from self_awareness.training import numbered_names
from self_awareness.training.numbered_names import Renames

_EPILOG = """\
Calibrate the result: limits and thresholds are not merged. What the models learned adds up, as if
one training had seen all of their recordings. They must agree in encoding, windows, bins and
horizon.
example:
  merge robot1.model robot2.model robot3.model -o fleet.model
"""


def _merge(arguments: argparse.Namespace) -> None:
    if len(arguments.models) < 2:
        raise ValueError(f'{arguments.models[0]}: one model only; name at least two')
    check_outputs([(arguments.output, MODEL)], arguments.models)
    known = DistinctRecordings()
    renames, told = numbered_names.of_models(
        TrainedModel.load(path, watched_only=True) for path in arguments.models)
    first, *others = arguments.models
    merged = _load(first, known, renames)
    tuning = merged.tuning
    same_tuning = True
    for path in others:
        model = _load(path, known, renames)
        same_tuning = same_tuning and model.tuning == tuning
        try:
            merged.merge(model)
        except ValueError as error:
            raise ValueError(f'{path}: does not fit {first}: {error}') from error
    if merged.detectors != PAPER:
        merged.watch()
    merged.save(arguments.output)
    cli.print_lines([*verdict.lines(merged), *told])
    if not same_tuning:
        print("the models' numbers of the method differ, as those of different versions do: the "
              'result has those of this version (rosrun self_awareness info --tuning)')
    cli.print_lines([f'written: {arguments.output}, without limits and threshold',
                     *verdict.next_steps(merged, arguments.output)])


def _load(path: str, known: DistinctRecordings, renames: Renames) -> TrainedModel:
    """Load a model with the rules that all models are to have, and add its recordings.

    Raises:
        ValueError: one of them is known already, or two of its event types become one.
    """
    model = TrainedModel.load(path)
    try:
        model.add_renames(numbered_names.left(model.encoding.rename, renames))
    except ValueError as error:
        raise ValueError(f'{path}: by the names of all models, {error}; train it again with '
                         'the others\' rules (train --rename)') from error
    for recording in model.recordings:
        other = known.same_as(path, recording)
        if other:
            raise ValueError(f'{path}: was trained on a recording ({recording.bag}) that '
                             f'{other} was trained on, too; it would count twice')
    return model


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('models', nargs='+', metavar='MODEL',
                        help='file written by train or merge, or by calibrate')
    parser.add_argument('-o', '--output', required=True, metavar='MODEL', help='file to write')


main = cli.Program('merge', __doc__, _EPILOG, _arguments, _merge)
