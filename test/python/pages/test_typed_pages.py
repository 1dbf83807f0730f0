"""README.md and docs: what they tell to type is typed as it is written."""
from __future__ import annotations

import random
import re
from pathlib import Path
from typing import Any, Dict, List, Tuple

import yaml
from conftest import wait_until
from page_reader import BACKGROUND, DOCS, NODES, README, Reader, blocks, types, write_recording
from recorded_logs import write_log

from self_awareness import TrainedModel


@types(README, 1)
def test_a_robot_is_learned_and_seen_as_the_readme_says(reader: Reader) -> None:
    learn, aggregate, top = blocks(README)[1].splitlines()
    (reader.folder / 'data').mkdir()
    reader.launch(learn, '/self_awareness/finish')
    reader.type(f'{BACKGROUND}\n{aggregate}')
    reader.type("""rostopic echo -n 1 --filter "any('nothing is heard' in each.message """
                'for each in m.status)" /diagnostics_agg')
    reader.type(f'{BACKGROUND}\nenv TERM=xterm script -qefc '
                f"'stty rows 24 cols 80; {top}' /dev/null")
    seen = reader.folder / 'terminal2.log'
    wait_until(lambda: 'nothing is heard' in seen.read_text(), 'what top shows')


@types(README, 2)
def test_bags_are_learned_and_judged_as_the_readme_says(reader: Reader) -> None:
    for number, name in enumerate(('data/normal/monday', 'data/normal/tuesday', 'crash')):
        write_recording(reader.folder / f'{name}.bag', 1000.0 * (number + 1))
    assert 'crash.bag: ' in reader.type(blocks(README)[2])
    assert (reader.folder / 'crash.html').is_file()


@types('developers.md')
def test_the_simulated_robot_is_launched_broken_and_recorded(reader: Reader) -> None:
    live, recorded = blocks('developers.md')
    launch, induce = live.splitlines()
    reader.launch(launch, '/slam/get_loggers')
    assert 'slam killed' in reader.type(induce)
    reader.type(recorded)
    assert len(list((reader.folder / 'bags').glob('*.bag'))) == 8


@types('alarm.md', 2, 3)
def test_the_simulated_alarm_is_as_the_page_says(reader: Reader) -> None:
    said = ''.join(reader.type(block) for block in blocks('alarm.md', '## A simulated one'))
    expected = [line for line in (DOCS / 'alarm.md').read_text(encoding='utf-8').splitlines()
                if line.startswith(('half.bag: ', '  /slam', '    1. /slam', '    2. /navigation',
                                    'late.bag: ', '  /leg_', '    1. /leg_', '    since 32'))]
    assert len(expected) == 8
    for line in expected:
        assert line.split(', ...')[0] in said
    assert '/slam' in (reader.folder / 'half.html').read_text()


@types('alarm.md', 1)
def test_the_real_alarm_is_as_the_page_says(reader: Reader, shared: Path) -> None:
    for bag in (shared / 'data' / 'wheeled_robot').glob('feb13_*.bag'):
        (reader.folder / bag.name).symlink_to(bag)
    said = ''.join(reader.type(block) for block in blocks('alarm.md', '## A real one'))
    page = (DOCS / 'alarm.md').read_text(encoding='utf-8')
    expected = re.findall(r'^(?:feb13_outage.bag: .*|  /.*|    (?:[1-4]\.|since \S+ s) /.*)$',
                          page[page.index('## A real one'):page.index('## A simulated')],
                          re.MULTILINE)
    assert len(expected) == 5
    for line in expected:
        assert line in said


@types('bags.md', 0, 2)
def test_bags_are_learned_judged_and_made_logs_as_the_page_says(reader: Reader) -> None:
    for number, day in enumerate(('monday', 'tuesday', 'wednesday', 'crash')):
        write_recording(reader.folder / f'{day}.bag', 1000.0 * (number + 1))
    learn, _, convert = blocks('bags.md')[:3]
    assert 'crash.bag: ' in reader.type(learn)
    assert (reader.folder / 'crash.html').is_file()
    said = reader.type(convert)
    assert 'monday.bag: ' in said and 'written: old.bag' in said


@types('robots.md')
def test_robots_are_learned_together_as_the_page_says(reader: Reader) -> None:
    for folder, begin in (('fleet', 1000.0), ('later', 20000.0)):
        for robot in range(1, 4):
            write_recording(reader.folder / folder / f'r{robot}' / '0.bag',
                            begin + 1000.0 * robot, f'/r{robot}')
    learn, merge, accept = blocks('robots.md')
    train, calibrate, monitor = learn.splitlines()
    reader.type(f'{train}\n{calibrate}')
    reader.launch(monitor, '/self_awareness/accept')
    assert reader.type(accept).count('success: False') == 2  # nothing stands
    for number in (1, 2):
        reader.type(f'rosrun self_awareness train fleet/r{number} --robots-by-folder --rename '
                    f"'/r[0-9]+/(.*)' '/\\1' -o robot{number}.model")
    assert 'written: fleet.model' in reader.type(merge)


@types('monitor.md')
@types('alarm.md', 0)
@types('recovery.md')
def test_the_monitor_its_files_and_the_recovery(reader: Reader) -> None:
    reader.learn()
    reader.type('mkdir data && cp robot.model data/')
    launch, report = blocks('monitor.md')
    reader.launch(launch, '/self_awareness/reload')
    for block in (report, blocks('alarm.md')[0]):
        file, = re.findall(r'alarm_\S+\.bag', block)
        reader.type('mkdir -p ~/.ros/self_awareness/self_awareness && rosrun self_awareness '
                    f'convert 1.bag -o ~/.ros/self_awareness/self_awareness/{file}')
        assert f'{file}: ' in reader.type(block)
        (reader.folder / 'alarm.html').unlink()
    copy, launch = blocks('recovery.md')[0].splitlines()
    reader.type(copy)
    reader.launch(launch, '/self_awareness_recovery/hold')


ID = re.compile(r'\b\d{19}\b')


def calls(service: str) -> List[str]:
    """Return the lines of the page's table that call a service of the monitor."""
    lines = re.findall(r'^\| .* \| `(ros.*)` \|$', (DOCS / 'live.md').read_text(encoding='utf-8'),
                       re.MULTILINE)
    return [line for line in lines
            if line.startswith(f'rosservice call /self_awareness/{service}')]


def answer(reader: Reader, call: str) -> Tuple[bool, str]:
    """Return what a call says; too many in a row are refused for some seconds."""
    said: List[Dict[str, Any]] = []

    def is_served() -> bool:
        said.append(yaml.safe_load(reader.type(call)))
        return 'too many calls' not in said[-1]['message']

    wait_until(is_served, call)
    return said[-1]['success'], said[-1]['message']


def test_all_that_somebody_wants_is_done_as_the_page_says(reader: Reader) -> None:
    reader.learn()
    reader.type(f'{BACKGROUND}\nroslaunch self_awareness monitor.launch model:=robot.model')
    for name, topic, rate in reversed(NODES):
        reader.type(f'{BACKGROUND}\nrosrun self_awareness talker __name:={name[1:]} '
                    f'_output:={topic} _rate:={rate} _variation:=0.3')
    reader.type('rostopic echo -n 1 --filter "not m.settling and m.events > 1" '
                '/self_awareness/status')
    reader.kill_last()
    alarm = re.search(r'^alarm: (\d+)$', reader.type(
        """rostopic echo -n 1 --filter 'm.level == 2 and m.component == "/camera"' """
        '/self_awareness/alarm'), re.MULTILINE)
    assert alarm is not None
    ask, *accept, ask_back, undo = [ID.sub(alarm[1], call) for call in calls('accept')]
    assert len(accept) == 5
    done, message = answer(reader, ask)
    assert not done and f'"{{alarm: {alarm[1]}}}" for /camera on /image (silent)' in message
    for call in accept:
        done, message = answer(reader, call)
        assert done and 'normal from now on' in message, call
    done, message = answer(reader, ask_back)
    assert not done and '/rostopic_12 on /cmd_vel, /camera (slow) and /joystick' in message
    done, message = answer(reader, undo)
    assert done and 'judged again' in message
    *mutes, told_again = calls('mute')
    assert len(mutes) == 4
    for call in mutes:
        done, message = answer(reader, call)
        assert done and 'not told until' in message, call
    done, message = answer(reader, told_again)
    assert done and 'told again: /camera' in message
    for service, said in (('clear', 'alarm'), ('dump', 'dump_')):
        call, = calls(service)
        done, message = answer(reader, call)
        assert done and said in message, message


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
