"""docs/learn.md: its commands are typed as they are written, and the ones that they print."""
from __future__ import annotations

import random
import re
from pathlib import Path

from conftest import wait_until
from page_reader import BACKGROUND, Reader, blocks, types
from recorded_logs import write_log

from self_awareness import TrainedModel

HOUR_S = 3600


def write_hour(path: Path, start: int) -> None:
    """Write an event log of a slow robot: what the page records in an hour."""
    rng = random.Random(start)
    messages = []
    for source, topic, period in (('/base', '/odom', 1.0), ('/battery', '/charge', 3.0)):
        stamp = start + rng.uniform(0.0, period)
        while stamp < start + HOUR_S:
            messages.append((stamp, source, topic))
            stamp += period * rng.uniform(0.9, 1.1)
    messages.append((start + HOUR_S + 1.0, '/base', '/odom'))
    write_log(path, sorted(messages), start)


@types('learn.md', 0, 1)
def test_two_hours_are_learned_and_learned_again_by_the_commands_that_are_printed(
        reader: Reader) -> None:
    launch, reload, *_ = blocks('learn.md')
    model = reader.folder / 'robot.model'
    logs = reader.folder / 'robot.model.logs'
    logs.mkdir()
    for number in range(2):
        write_hour(logs / f'normal_{number}.bag', HOUR_S * 3 * (number + 1))
    reader.type(f'{BACKGROUND}\n{launch}')
    wait_until(model.exists, f'{model}, or {reader.logs()}')
    said = reader.folder / 'terminal0.log'
    printed = re.findall(r'^\+ (rosrun .*)$', said.read_text(), re.MULTILINE)
    assert [command.split()[2] for command in printed] == ['train', 'calibrate']
    assert TrainedModel.load(str(model)).calibration.budget == 0.5
    train, calibrate = printed
    reader.type(train)
    reader.type(calibrate.replace('--budget 0.5', '--budget 0.1'))
    assert TrainedModel.load(str(model)).calibration.budget == 0.1
    reader.type('until rosservice type /self_awareness/reload; do sleep 0.1; done')
    assert 'success: True' in reader.type(reload)


@types('learn.md', *range(2, 9))
def test_step_by_step_and_months_later(reader: Reader) -> None:
    """All other commands, on days of the simulated robot."""
    _, _, record, train, inject, paper, monitor, later, changed = blocks('learn.md')
    reader.type('rosrun self_awareness simulate -o days --runs 6 --duration 150')
    days = sorted((reader.folder / 'days').glob('*.bag'))
    for name, day in zip(('monday', 'tuesday', 'wednesday', 'today'), days):
        for file in day.parent.glob(f'{day.stem}.*'):
            file.rename(reader.folder / file.name.replace(day.stem, name))
    (reader.folder / 'days').rename(reader.folder / 'robot.model.kept')

    reader.type(record)
    reader.type(train)
    model = str(reader.folder / 'robot.model')
    assert TrainedModel.load(model).calibration is not None
    assert re.search(r'^faults: found \d+ of 18,', reader.type(inject), re.MULTILINE)
    reader.type(paper)
    assert TrainedModel.load(str(reader.folder / 'both.model')).paper_calibration is not None

    reader.type(monitor)
    reader.type('until rosservice type /self_awareness/reload; do sleep 0.1; done')
    said = reader.type(later)
    for text in ('nothing drifts', 'taken: robot.model', 'success: True'):
        assert text in said
    assert len(TrainedModel.load(model).recordings) == 4
    said = reader.type(changed)
    assert 'before  robot.model.before' in said and 'after   today.bag' in said
    assert 'today.bag' in (reader.folder / 'today.html').read_text()
    wait_until(lambda: list(reader.folder.glob('normal_*.bag*')), 'what the recorder writes')
