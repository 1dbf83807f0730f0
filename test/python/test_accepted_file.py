"""What is accepted beside a model, and what a training makes of it."""
from __future__ import annotations

from types import SimpleNamespace
from typing import Any, List

import pytest

from self_awareness import Acceptance, BagError, EventType, accepted_file


def model(*ends: int) -> Any:
    return SimpleNamespace(event_types=[EventType('/driver', '/scan', 'T'),
                                        EventType('', '/replayed', 'T')],
                           recordings=[SimpleNamespace(end=end) for end in ends])


@pytest.fixture()
def entries() -> List[Acceptance]:
    return [Acceptance('/driver', '/scan', 'slow', 90, '/rqt'), Acceptance('/driver', at=110),
            Acceptance('/joystick', '/joy', 'stranger', 10), Acceptance('/dri*', at=10),
            Acceptance(topic='/replayed', at=100)]


def test_what_was_heard_after_it_was_accepted_is_learned(entries: List[Acceptance]) -> None:
    learned, left = accepted_file.learned(entries, model(50, 100))
    assert learned == [entries[0], entries[4]]
    assert left == entries[1:4], 'too late, not heard, and a pattern'
    assert accepted_file.learned(entries, model())[0] == []


def test_it_is_kept_beside_the_model(entries: List[Acceptance], tmp_path) -> None:
    path = str(tmp_path / 'robot.model')
    assert accepted_file.beside(path) == []
    accepted_file.keep([], path)
    assert not (tmp_path / 'robot.model.accepted').exists(), 'no file is made for nothing'
    accepted_file.keep(entries, path)
    assert accepted_file.beside(path) == entries
    accepted_file.keep([], path)
    assert accepted_file.beside(path) == []


def test_a_damaged_file_is_named(tmp_path) -> None:
    (tmp_path / 'm.accepted').write_text('what is this')
    with pytest.raises(BagError, match='m.accepted'):
        accepted_file.beside(str(tmp_path / 'm'))


@pytest.mark.parametrize('entry, words', [
    (Acceptance('/a', '/t', 'slow'), '/a on /t (slow)'), (Acceptance('/a'), '/a'),
    (Acceptance('/t', '/t', 'died'), '/t (died)'), (Acceptance(topic='/t*'), '/t*')])
def test_it_is_said_as_the_monitor_says_it(entry: Acceptance, words: str) -> None:
    assert accepted_file.in_words(entry) == words


def test_there_are_no_other_kinds() -> None:
    with pytest.raises(ValueError, match='odd'):
        Acceptance('/a', kind='odd')
