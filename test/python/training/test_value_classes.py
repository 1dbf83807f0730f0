"""Classes of numeric type fields, from bags to a model and what it judges."""
from __future__ import annotations

import random
from pathlib import Path
from typing import List

import numpy as np
import pytest
import rosbag
from conftest import error_of, printed_by, put, trained
from std_msgs.msg import Float32

from self_awareness import encoding_file, read_events
from self_awareness.commands import calibrate, convert, info, merge, score, train
from self_awareness.parts import BagPart
from self_awareness.training import value_classes
from self_awareness.workers import InProcess

ENCODING = 'type_fields: {std_msgs/Float32: {field: data, classes: 4}}\n'


def write(path: Path, start: float, values: List[float]) -> str:
    """Write a value ten times a second."""
    with rosbag.Bag(str(path), 'w') as bag:
        for step, value in enumerate(values):
            put(bag, '/arm', '/force', Float32(value), start + 0.1 * step)
    return str(path)


def forces(seed: int, number: int = 1200) -> List[float]:
    """Draw values that are 0 in a quarter of the time, and from 1 to 3 else."""
    chance = random.Random(seed)
    return [0.0 if chance.random() < 0.25 else chance.uniform(1.0, 3.0) for _ in range(number)]


@pytest.fixture(name='encoding')
def _encoding(tmp_path: Path) -> str:
    file = tmp_path / 'encoding.yaml'
    file.write_text(ENCODING)
    return str(file)


@pytest.fixture(name='bags')
def _bags(tmp_path: Path) -> List[str]:
    return [write(tmp_path / f'{number}.bag', 1000.0 * number, forces(number))
            for number in (1, 2, 3)]


def test_the_training_learns_them_and_all_use_them(bags: List[str], encoding: str,
                                                   tmp_path: Path) -> None:
    model = str(tmp_path / 'm')
    learned = trained(bags[:2], Path(model), '--encoding', encoding, '--jobs', '2')
    (number, bounds), = learned.encoding.classes.values()
    assert number == 4 and len(bounds) == 3
    kinds = [kind.type for kind in learned.event_types]
    assert len(kinds) == 4
    assert f'std_msgs/Float32[data={bounds[0]:g} to {bounds[1]:g}]' in kinds
    shares = [learned.event_count(index) for index in range(4)]
    assert max(shares) < 1.3 * min(shares), 'as many in each'
    assert calibrate.main(['--model', model, '--normal', bags[2], '-o', model]) == 0
    assert 'never seen' not in printed_by(score, ['--model', model, bags[2]])
    assert f'{bounds[0]:g}' in printed_by(info, [model, '--details'])
    # More bags are put into the same classes.
    assert trained(bags[2:], Path(model), '--add-to', model).encoding == learned.encoding


def test_the_rules_see_new_names(bags: List[str], tmp_path: Path) -> None:
    file = tmp_path / 'e.yaml'
    file.write_text(ENCODING + 'include_topics: [/load]\n')
    model = trained(bags[:1], tmp_path / 'm', '--encoding', str(file), '--rename', '/force',
                    '/load')
    assert {kind.scope for kind in model.event_types} == {'/load'}


def test_the_order_of_the_bags_changes_nothing(bags: List[str], encoding: str) -> None:
    rules = encoding_file.load(encoding)
    parts = [BagPart(bag) for bag in bags]
    one = value_classes.learned(rules, parts, InProcess(), False)
    other = value_classes.learned(rules, parts[::-1], InProcess(), False)
    assert one == other and one.classes != rules.classes
    assert value_classes.learned(one, [BagPart('missing.bag')], InProcess(), False) == one


def test_the_value_that_comes_most_may_be_the_least(tmp_path: Path, encoding: str) -> None:
    bag = write(tmp_path / 'rare.bag', 1000.0, [5.0] * 190 + [5.5, 7.0, np.nan, np.inf])
    rules = value_classes.learned(encoding_file.load(encoding), [BagPart(bag)], InProcess(), False)
    (_, bounds), = rules.classes.values()
    assert bounds == [5.5]
    events = read_events(bag, rules)
    names = [events.event_types[index].type.split('=')[1] for index in events.ids]
    assert names == ['below 5.5]'] * 190 + ['5.5 or more]'] * 2 + ['NaN]', '5.5 or more]']


def test_a_bound_has_the_digits_that_it_takes(tmp_path: Path, encoding: str) -> None:
    bag = write(tmp_path / 'near.bag', 1000.0, [1000.0] * 10 + [1000.25] * 10)
    rules = value_classes.learned(encoding_file.load(encoding), [BagPart(bag)], InProcess(), False)
    (_, bounds), = rules.classes.values()
    assert len(bounds) == 1 and 1000.0 < bounds[0] <= 1000.25
    assert len(set(read_events(bag, rules).ids)) == 2


@pytest.mark.parametrize('field, values, what', [
    ('data', [1.0] * 50, 'no two values'), ('other', [1.0, 2.0], 'has no field')])
def test_what_has_no_classes_is_named(tmp_path: Path, field: str, values: List[float],
                                      what: str) -> None:
    file = tmp_path / 'e.yaml'
    file.write_text(ENCODING.replace('data', field))
    bag = write(tmp_path / '1.bag', 1000.0, values)
    said = error_of(train, [bag, '--encoding', str(file), '-o', str(tmp_path / 'm')])
    assert what in said and f'std_msgs/Float32: {field}' in said


def test_event_logs_hold_no_values(bags: List[str], encoding: str, tmp_path: Path) -> None:
    log, options = str(tmp_path / 'log.bag'), ['--encoding', encoding, '-o']
    assert 'are not learned yet' in error_of(convert, [bags[0], *options, log])
    assert convert.main([bags[0], '-o', log]) == 0
    assert 'holds no values' in error_of(train, [log, *options, str(tmp_path / 'm')])


def test_models_of_other_classes_are_not_merged(bags: List[str], encoding: str,
                                                tmp_path: Path) -> None:
    models = [str(tmp_path / name) for name in ('a', 'b')]
    for bag, model in zip(bags, models):
        trained([bag], Path(model), '--encoding', encoding)
    assert 'classes' in error_of(merge, [*models, '-o', str(tmp_path / 'both')])
