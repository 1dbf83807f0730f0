"""What is accepted beside a model, and what a training makes of it."""
from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any, List, Tuple

import pytest
from conftest import error_of, printed_by, trained

from self_awareness import (Acceptance, BagError, EventType, TrainedModel, accepted_file,
                            read_accepted)
from self_awareness.commands import calibrate, train


def model(driver: int, replayed: int, base: int = 0) -> Any:
    """With the ends of the last recordings in which these came."""
    came = zip([EventType('/driver', '/scan', 'T'), EventType('', '/replayed', 'T'),
                EventType('/base', '/odom', 'T')], [driver, replayed, base])
    return SimpleNamespace(heard_in=[('', 0, until, {kind}) for kind, until in came if until],
                           subscriptions={('/base', '/cmd_vel')})


@pytest.fixture()
def entries() -> List[Acceptance]:
    return [Acceptance('/driver', '/scan', 'slow', 90, '/rqt'), Acceptance('/driver', at=110),
            Acceptance('/joystick', '/joy', 'stranger', 10), Acceptance('/dri*', at=10),
            Acceptance(topic='/replayed', at=100)]


@pytest.mark.parametrize('heard, places', [
    ((100, 100), [0, 4]), ((0, 0), []), ((50, 50, 1000), []), ((50, 100, 1000), [4])])
def test_what_was_heard_after_it_was_accepted_is_learned(
        entries: List[Acceptance], heard: Tuple[int, ...], places: List[int]) -> None:
    """The others: too late, not heard, and a pattern. That another one was heard teaches nothing.
    """
    learned = [entries[place] for place in places]
    assert accepted_file.learned(entries, model(*heard)) == (
        learned, [each for each in entries if each not in learned])


def test_who_does_not_subscribe_is_learned_once_it_is_not_expected() -> None:
    entries = [Acceptance('/base', '/cmd_vel', 'not subscribed', 10),
               Acceptance('/base', '/stop', 'not subscribed', 10),
               Acceptance('/base', '', 'not subscribed', 10)]
    assert accepted_file.learned(entries, model(0, 0, 20)) == ([entries[1]],
                                                               [entries[0], entries[2]])
    assert accepted_file.learned(entries, model(20, 20, 5))[0] == []


def test_of_two_files_each_is_kept_once_and_the_outputs_wins(entries: List[Acceptance],
                                                             tmp_path) -> None:
    source, output = str(tmp_path / 'source'), str(tmp_path / 'output')
    accepted_file.keep(entries[:2], source)
    assert accepted_file.of_either(source, output) == entries[:2]
    newer = Acceptance('/driver', '/scan', 'slow', 200, '/top')
    accepted_file.keep([newer, entries[2]], output)
    assert accepted_file.of_either(source, output) == [newer, entries[2], entries[1]]
    assert accepted_file.of_either(output, str(tmp_path / '.' / 'output')) == [newer, entries[2]]
    (tmp_path / 'output.accepted').write_text('what is this')
    with pytest.raises(BagError, match='output.accepted'):
        accepted_file.of_either(source, output)


def test_of_two_files_there_may_be_too_many(tmp_path) -> None:
    for name in ('source', 'output'):
        accepted_file.keep([Acceptance(f'/{name}{k}') for k in range(600)], str(tmp_path / name))
    with pytest.raises(ValueError, match='1200 are accepted'):
        accepted_file.of_either(str(tmp_path / 'source'), str(tmp_path / 'output'))


def test_it_is_kept_beside_the_model(entries: List[Acceptance], tmp_path) -> None:
    path = str(tmp_path / 'robot.model')
    assert accepted_file.beside(path) == []
    accepted_file.keep([], path)
    assert not (tmp_path / 'robot.model.accepted').exists(), 'no file is made for nothing'
    mode = Acceptance(kind='new mode', at=90, by='/rqt', together=['/driver', '/base'])
    accepted_file.keep([*entries, mode], path)
    assert accepted_file.beside(path) == [*entries, mode]
    assert accepted_file.beside(path)[-1].together == ['/base', '/driver']
    accepted_file.keep([], path)
    assert accepted_file.beside(path) == []


def test_a_mode_is_learned_once_all_of_it_were_heard_after_it() -> None:
    entry = Acceptance(kind='new mode', at=90, by='/rqt', together=['/driver', '/base'])
    assert accepted_file.in_words(entry) == '/base /driver (new mode)'
    assert accepted_file.learned([entry], model(100, 0, 100)) == ([entry], [])
    assert accepted_file.learned([entry], model(100, 0, 80)) == ([], [entry])
    other = Acceptance(kind='new mode', at=90, by='/rqt', together=['/driver', '/laser'])
    assert accepted_file.learned([other], model(100, 0, 100)) == ([], [other])
    assert entry != other


Bags = Tuple[str, str]
OF_SOURCE = Acceptance('/joystick', '/joy', 'stranger', 10, '/rqt')
OF_OUTPUT = Acceptance('/camera', '/image', 'slow', 20, '/top')


@pytest.fixture(name='source')
def _source(long_bags: Bags, tmp_path: Path) -> str:
    """A trained model, beside which something is accepted."""
    source = str(tmp_path / 'source')
    trained([long_bags[0]], tmp_path / 'source')
    accepted_file.keep([OF_SOURCE], source)
    return source


def heard(model: str) -> Acceptance:
    """Something that the model has learned, once it is accepted."""
    known = TrainedModel.load(model)
    return Acceptance(known.event_types[0].source, '', 'slow',
                      min(end for _, _, end, _ in known.heard_in))


@pytest.mark.parametrize('program, options', [(train, ['--add-to', '{}']),
                                              (calibrate, ['--model', '{}', '--normal'])])
def test_what_is_accepted_beside_the_output_is_kept_or_damaged_before_anything_is_written(
        program: Any, options: List[str], source: str, long_bags: Bags, tmp_path: Path) -> None:
    output = str(tmp_path / 'output')
    command = [*(each.format(source) for each in options), long_bags[1], '-o', output]
    (tmp_path / 'output.accepted').write_text('what is this')
    assert 'output.accepted' in error_of(program, command)
    assert not (tmp_path / 'output').exists()
    (tmp_path / 'output.accepted').unlink()
    learned, nobody = heard(source), Acceptance('/nobody', '/nobody', 'silent', 5)
    accepted_file.keep([OF_OUTPUT, nobody, learned], output)
    said = printed_by(program, command)
    assert read_accepted(output + '.accepted') == [OF_OUTPUT, nobody, OF_SOURCE]
    assert read_accepted(source + '.accepted') == [OF_SOURCE]
    assert f'learned now, so it is judged again: {learned.component} (slow)' in said
    for words in ('/joystick on /joy (stranger)', '/camera on /image (slow)',
                  '/nobody (silent)'):
        assert f'accepted, and not learned: {words}' in said


def test_calibrate_in_place_leaves_the_file_alone(source: str, long_bags: Bags) -> None:
    accepted = [OF_SOURCE, heard(source)]
    accepted_file.keep(accepted, source)
    assert calibrate.main(['--model', source, '--normal', long_bags[1], '-o', source]) == 0
    assert read_accepted(source + '.accepted') == accepted
