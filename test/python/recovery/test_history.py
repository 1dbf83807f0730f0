"""The file of what was done."""
from __future__ import annotations

from pathlib import Path
from typing import Any, Dict

import pytest

from self_awareness.recovery import history
from self_awareness.recovery.history import MOST, Action, History, Hold


def action(incident: int = 7, **fields: Any) -> Action:
    values: Dict[str, Any] = {'begin': 1_600_000_000_000_000_001, 'dry_run': False, **fields}
    return Action(incident, '/player', 'silent', 1, 2, 'stop /player', **values)


def test_what_is_written_is_read(tmp_path: Path) -> None:
    path = str(tmp_path / 'new' / 'a.actions')
    assert history.load(path) == History(), 'there is no file yet'
    written = History([], Hold(5 * 10 ** 18))
    for number in range(3):
        written.begin(action(number))
        written.end(bool(number), f'"{number}": äß\U0001f600\nand more\x07')
        written.save(path)
        assert history.load(path) == written
    assert written.actions[0].result == '"0": äß\U0001f600 and more\ufffd'
    History().save(path)
    assert history.load(path) == History()


def test_the_steady_times_are_of_one_boot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = str(tmp_path / 'a.actions')
    written = History([action(steady=5)], Hold(7, 6))
    written.save(path)
    assert history.load(path) == written
    boot = tmp_path / 'boot_id'
    boot.write_text('another\n')
    for other in (boot, tmp_path / 'none'):
        monkeypatch.setattr(history, '_BOOT_ID', other)
        assert history.load(path) == History([action()], Hold(7))


def test_the_steady_clock_tells_the_time_of_this_boot() -> None:
    """The clock that all see may have been set."""
    hour = 3600 * 10 ** 9
    kept = History([action(begin=9 * hour, steady=2 * hour), action(begin=9 * hour)])
    assert kept.ages(3 * hour, 100 * hour) == [hour, 91 * hour]
    assert kept.ages(3 * hour, hour) == [hour, 0]
    assert kept.ages(hour, 10 * hour) == [hour, hour], 'it cannot be of this boot'
    hold = Hold(9 * hour, 5 * hour)
    assert hold.left(3 * hour, 100 * hour) == 2 * hour and hold.left(6 * hour, hour) == 0
    hold = Hold(9 * hour)
    assert hold.left(3 * hour, 8 * hour) == hour and hold.left(3 * hour, 100 * hour) == 0


def test_the_last_ones_are_kept_and_long_results_are_cut(tmp_path: Path) -> None:
    written = History()
    for number in range(MOST + 10):
        written.begin(action(number))
        written.end(False, 'x' * 10_000)
    assert [each.incident for each in written.actions] == list(range(10, MOST + 10))
    assert len(written.actions[0].result) == 500
    written.save(str(tmp_path / 'a.actions'))
    assert history.load(str(tmp_path / 'a.actions')) == written


@pytest.mark.parametrize('text, key', [
    ('{}}', 'not YAML'), ('[]', 'the file'), ('{"action": []}', 'action'),
    ('{"held_until": -1}', 'held_until'), ('{"actions": [{}]}', 'actions[0].incident'),
    ('{"actions": [{"incident": "1"}]}', 'actions[0].incident')])
def test_a_damaged_file_is_named(tmp_path: Path, text: str, key: str) -> None:
    path = tmp_path / 'a.actions'
    path.write_text(text)
    with pytest.raises(ValueError) as caught:
        history.load(str(path))
    assert f'a.actions: {key}: ' in str(caught.value)


def test_it_lies_where_the_monitor_keeps_its_incidents(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('HOME', '/home/me')
    monkeypatch.delenv('ROS_HOME', raising=False)
    default = '$ROS_HOME/self_awareness/$NAME'
    assert history.beside_incidents(default, '/r1/watch') == (
        '/home/me/.ros/self_awareness/r1_watch/r1_watch.actions')
    monkeypatch.setenv('ROS_HOME', '/ros')
    assert history.beside_incidents(default, '/watch') == '/ros/self_awareness/watch/watch.actions'
    assert history.beside_incidents('/data', '/watch') == '/data/watch.actions'
    assert history.beside_incidents('~/x', '/watch') == '/home/me/x/watch.actions'
