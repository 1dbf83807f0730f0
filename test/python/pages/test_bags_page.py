"""docs/bags.md and docs/robots.md: their commands are typed as they are written."""
from __future__ import annotations

from page_reader import Reader, blocks, types, write_recording


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
