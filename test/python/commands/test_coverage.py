"""How soon the death of each component is found, and who is not watched: said by all programs."""
from __future__ import annotations

import json
import re
from pathlib import Path
from typing import List, Tuple

import pytest
import rosbag
from conftest import Message, jittery_robot, printed_by, write_bag

from self_awareness.commands import calibrate, info, score, train

MISSING = '1 of 4 components are not watched: /rare'


def with_rare(start: float, length: float, seed: int) -> List[Message]:
    """A robot with a component that speaks every 20 s."""
    return sorted([*jittery_robot(start, length, seed),
                   *((start + 5.0 + 20.0 * i, '/rare', '/seldom')
                     for i in range(int(length / 20.0)))])


@pytest.fixture(name='half_blind', scope='module')
def _half_blind(tmp_path_factory: pytest.TempPathFactory) -> Tuple[str, str]:
    """A model that cannot watch one of four components, and a normal recording."""
    folder = tmp_path_factory.mktemp('half_blind')
    bags = [write_bag(folder / f'{number}.bag', with_rare(10000.0 * number, 120.0, number))
            for number in (1, 2)]
    path = str(folder / 'robot.model')
    assert train.main([bags[0], '-o', path]) == 0
    assert calibrate.main(['--model', path, '--normal', bags[1], '-o', path]) == 0
    return path, bags[1]


def test_who_is_not_watched_is_named_with_what_is_missing(half_blind: Tuple[str, str],
                                                          capsys) -> None:
    model, normal = half_blind
    assert info.main([model, '--json']) == 0
    found = {each['component']: each for each in json.loads(
        capsys.readouterr().out)['evidence']['calibration']['coverage']}
    assert not found['/rare']['watched'] and found['/rare']['death_found_after'] is None
    assert found['/laser']['watched'] and 0 < found['/laser']['death_found_after'] < 2
    gaps = found['/rare']['gaps']
    for program, arguments in ((info, [model]),
                               (calibrate, ['--model', model, '--normal', normal, '-o', model])):
        verdict = printed_by(program, arguments).splitlines()[0]
        assert 'deaths of 3 of 4 nodes found within ' in verdict
        assert verdict.endswith(f'; /rare is not watched: {gaps + 1} messages in training, more '
                                'than 8 are needed')
        lines = [line.strip() for line in printed_by(program, [*arguments,
                                                               '--details']).splitlines()]
        row, = (line for line in lines if line.startswith('/rare  '))
        assert f'not watched: {gaps} gaps in training, 8 ' in row
        assert MISSING in lines
        watched, = (line for line in lines if line.startswith('/laser  '))
        assert 'not watched' not in watched


def test_several_that_are_not_watched_are_a_table(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / 'b.bag', sorted([*with_rare(1000.0, 120.0, 1),
                                                (1010.0, '/door', '/open')]))
    path = str(tmp_path / 'm')
    lines = printed_by(train, [bag, '-o', path]).splitlines()
    assert lines[0].endswith('; 2 are not watched')
    assert lines[1:4] == [
        '  not watched  why',
        '  /door        1 message in training, more than 8 are needed',
        '  /rare        6 messages in training, more than 8 are needed']
    assert lines[4].startswith('record next: ')
    assert re.search(r'  1  +[\d.]+  -  +/door /open std_msgs/String  \(too rare to judge',
                     printed_by(info, [path, '--details']))


def test_no_result_is_green_where_nobody_looks(half_blind: Tuple[str, str],
                                               tmp_path: Path) -> None:
    model, normal = half_blind
    page, results = tmp_path / 'report.html', tmp_path / 'results.bag'
    out = printed_by(score, [normal, '--model', model, '--report', str(page), '--result-bag',
                             str(results)])
    assert out.startswith(f'{model}: {MISSING}\n{normal}: 2 min, nothing abnormal\n')
    text = page.read_text()
    assert f'Nothing abnormal, but {MISSING}.' in text
    assert 'Who is watched' in text and '<td>/rare</td><td>20 s</td><td>not watched: ' in text
    with rosbag.Bag(str(results)) as bag:
        *_, (_, message, _) = bag.read_messages('/diagnostics')
    last, = (status for status in message.status if status.name.endswith('communication'))
    assert last.level == 0 and last.message.endswith('1 of 4 components are not watched')
    assert {each.key: each.value for each in last.values}['not watched'] == '/rare'
    after = {status.name.split(': ')[1]: each.value for status in message.status
             for each in status.values if each.key == 'death found after [s]'}
    assert after['/rare'] == 'not watched' and 0 < float(after['/laser']) < 2
    why, = (each.value for status in message.status for each in status.values
            if each.key == 'why not watched')
    assert re.fullmatch(r'too few messages in training: \d+ gaps', why)
