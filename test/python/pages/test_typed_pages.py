"""README.md and docs: what they tell to type is typed as it is written."""
from __future__ import annotations

import re
from pathlib import Path

from conftest import wait_until
from page_reader import BACKGROUND, DOCS, README, Reader, blocks, types, write_recording


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
