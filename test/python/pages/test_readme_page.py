"""README.md and docs/developers.md: their commands are typed as they are written."""
from __future__ import annotations

from conftest import wait_until
from page_reader import BACKGROUND, README, Reader, blocks, types, write_recording


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
