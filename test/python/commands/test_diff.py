"""`diff`: what changed is at the top, and what did not is not there."""
from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Callable, Iterable, List, Tuple

import pytest
from browser import opened
from conftest import Message, error_of, jittery_robot, write_bag

from self_awareness import TrainedModel
from self_awareness.commands import diff, train
from self_awareness.training.robot_graph import RobotGraph, graph_file

LASER = '/laser /scan std_msgs/String'
SLAM = '/slam /map std_msgs/String'


def starts(first: float, seed: int) -> List[Tuple[float, int]]:
    return [(first + 10_000.0 * number + 0.0137 * number, seed + number) for number in range(4)]


@pytest.fixture(scope='module')
def trained(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., str]:
    """Return a function that trains on four starts of the robot, each message changed."""
    folder = tmp_path_factory.mktemp('diff')

    def make(name: str, change: Callable[[Message], Iterable[Message]]) -> str:
        bags = [write_bag(folder / f'{name}{start:.0f}.bag',
                          sorted(new for message in jittery_robot(start, 120.0, seed)
                                 for new in change(message)))
                for start, seed in starts(10_000.0 if name == 'before' else 900_000.0, len(name))]
        for bag in bags:
            RobotGraph({'/scan': {'/laser'}}, {'/scan': {'/slam'}}).save(graph_file(bag))
        assert train.main([*bags, '-o', str(folder / name)]) == 0
        return str(folder / name)
    return make


@pytest.fixture(scope='module')
def before(trained: Callable[..., str]) -> str:
    return trained('before', lambda message: [message])


@pytest.fixture(scope='module')
def sooner(trained: Callable[..., str]) -> str:
    """Slam answers 12 ms sooner."""
    return trained('sooner', lambda message: [
        (message[0] - 0.012, *message[1:]) if message[1] == '/slam' else message])


def changes(capsys: pytest.CaptureFixture, *arguments: str) -> List[str]:
    """Return the lines about changes."""
    capsys.readouterr()
    assert diff.main(list(arguments)) == 0
    out = capsys.readouterr().out
    assert out.startswith('before  ') and '\nafter   ' in out
    found = re.findall(r'^(?:gone|ended|new|rate|gap|delay) .*$', out, re.MULTILINE)
    assert bool(found) != ('nothing changed by more than chance' in out)
    return found


def test_a_model_does_not_differ_from_itself(before: str, capsys) -> None:
    assert changes(capsys, before, before) == []


def test_another_day_of_the_same_robot_is_no_change(before: str, trained, make_bag,
                                                    capsys) -> None:
    assert changes(capsys, before, trained('another_day', lambda message: [message])) == []
    bag = make_bag('today.bag', jittery_robot(3000.0, 120.0, 77))
    assert changes(capsys, before, bag) == []
    assert changes(capsys, before, f'{bag}@10-100') == []
    assert changes(capsys, bag, before) == []


def test_a_missing_node_is_at_the_top(before: str, trained, capsys) -> None:
    after = trained('missing', lambda message: [] if message[1] == '/battery' else [message])
    found, = changes(capsys, before, after)
    assert re.match(r'gone +/battery /charge std_msgs/String: 2\.7\d? Hz, as all of its source',
                    found)
    found, = changes(capsys, after, before)
    assert found.startswith('new ') and '/battery' in found


def test_a_new_topic_of_a_known_node(before: str, make_bag, capsys) -> None:
    messages = sorted(new for m in jittery_robot(3000.0, 120.0, 5)
                      for new in ([m, (m[0] + 0.001, m[1], '/status')] if m[1] == '/battery'
                                  else [m]))
    found, = changes(capsys, before, make_bag('new.bag', messages))
    assert re.match(r'new +/battery /status std_msgs/String: 2\.7\d? Hz$', found)


def test_half_the_rate(before: str, trained, capsys) -> None:
    kept = iter(range(10**9))
    after = trained('half', lambda m: [m] if m[1] != '/battery' or next(kept) % 2 else [])
    found = changes(capsys, before, after)
    assert re.match(r'rate +/battery /charge std_msgs/String: 2\.7\d? Hz, now 1\.3\d? Hz '
                    r'\(0\.50 times\)', found[0])
    assert len(found) == 1  # its gaps are explained by that


def test_a_node_that_ended_has_no_other_rate(before: str, make_bag, tmp_path: Path,
                                             capsys) -> None:
    bag = make_bag('ended.bag', [m for m in jittery_robot(3000.0, 120.0, 5)
                                 if m[1] != '/battery' or m[0] < 3060.0])
    found, = changes(capsys, before, bag)
    assert re.match(r'ended +/battery /charge std_msgs/String: last heard at (59|60)\.\d s, '
                    r'(59|60)\.\d s before the end, as all of its source$', found)
    page = tmp_path / 'd.html'
    assert diff.main([before, bag, '--json', '--html', str(page)]) == 0
    change, = json.loads(capsys.readouterr().out)['changes']
    assert (change['change'], change['last_heard_s']) == ('ended', pytest.approx(60.0, abs=0.5))
    assert '/battery ended' in page.read_text()


def test_a_folder_stands_for_its_bags(before: str, tmp_path: Path, capsys) -> None:
    folder = tmp_path / 'week'
    folder.mkdir()
    for number in range(3):
        write_bag(folder / f'{number}.bag', jittery_robot(5000.0 * (number + 1), 60.0, number))
    assert changes(capsys, before, str(folder)) == []
    assert diff.main([before, str(folder)]) == 0
    assert f'{folder}: 3 recordings, 1' in capsys.readouterr().out


def test_what_could_not_be_compared_is_not_called_unchanged(model_file: str, make_bag,
                                                            tmp_path: Path, capsys) -> None:
    """All answers of this recording are 60 ms late, and no pair is compared."""
    bag = make_bag('late.bag', sorted(
        (m[0] + 0.06, *m[1:]) if m[1] == '/slam' else m
        for m in jittery_robot(3000.0, 120.0, 5)))
    page = tmp_path / 'd.html'
    assert diff.main([model_file, bag, '--html', str(page)]) == 0
    out = capsys.readouterr().out
    text = page.read_text()
    assert 'of what was compared, nothing changed' in out
    assert 'summary unknown' in text and 'Rates and gaps are as before' in text
    assert 'summary quiet' not in text
    assert 'delays between event types were not compared' in out
    assert 'no model is calibrated' in out and 'calibrate one' in out


def test_another_delay_of_an_answer(before: str, sooner: str, capsys) -> None:
    found, = changes(capsys, before, sooner)
    assert re.match(f'delay +{LASER} -> {SLAM}: 3\\d.* ms, now 2\\d.* ms \\(-1', found)
    found, = changes(capsys, sooner, before)
    assert re.match(f'delay +{LASER} -> {SLAM}: 2\\d.* ms, now 3\\d.* ms \\(\\+1', found)


def test_longer_pauses_at_about_the_same_rate(before: str, trained, capsys) -> None:
    """Every 40th charge comes 200 ms late: the rate stays, the longest usual gap grows."""
    number = iter(range(10**9))
    after = trained('pauses', lambda m: [
        (m[0] + (0.2 if next(number) % 40 == 0 else 0.0), *m[1:]) if m[1] == '/battery' else m])
    found = changes(capsys, before, after)
    assert re.match(r'gap +/battery /charge std_msgs/String: usually up to 3[78]\d ms, now up to '
                    r'5\d\d ms', found[0])


def test_what_is_too_rare_to_say_is_told_apart(before: str, make_bag, capsys) -> None:
    bag = make_bag('rare.bag', sorted([*jittery_robot(3000.0, 120.0, 5),
                                       (3060.0, '/operator', '/stop')]))
    assert changes(capsys, before, bag) == []
    assert diff.main([before, bag]) == 0
    assert 'too rare to say that it is not chance: /operator /stop' in capsys.readouterr().out


def test_the_root_comes_before_its_victims(before: str, trained, tmp_path: Path,
                                           capsys) -> None:
    """Both are at half their rate; messages of the laser get to slam."""
    ticks = {'/laser': iter(range(10**9)), '/slam': iter(range(10**9))}
    after = trained('both', lambda m: [m] if m[1] not in ticks or next(ticks[m[1]]) % 2 else [])
    model = TrainedModel.load(before)
    model.graph = {('/slam', '/x', '/zzz'), ('/laser', '/scan', '/slam')}
    model.save(str(tmp_path / 'graph.model'))
    found = changes(capsys, str(tmp_path / 'graph.model'), after)
    assert [line.split()[1] for line in found[:2]] == ['/laser', '/slam']


def test_json_and_page_say_the_same(before: str, sooner: str, tmp_path: Path, capsys) -> None:
    capsys.readouterr()
    page = tmp_path / 'd.html'
    assert diff.main([before, sooner, '--json', '--html', str(page)]) == 0
    values = json.loads(capsys.readouterr().out)
    assert values['before']['file'] == before and not values['after']['is_recording']
    first = values['changes'][0]
    assert [first['change'], first['source'], first['from']['source']] == ['delay', '/slam',
                                                                           '/laser']
    assert first['after'] - first['before'] == pytest.approx(-0.012, abs=0.004)
    text = page.read_text()
    assert '/slam (/map) answers after another delay' in text
    assert 'id="delays-0"' in text and len(text) < 10_000_000
    with opened(page) as browser:
        browser.wait('return document.querySelectorAll(".main-svg").length >= 2')
        assert browser.errors() == [] and browser.requests() == [page.as_uri()]


def test_bad_input_is_told(before: str, make_bag, tmp_path: Path, robot_bags, capsys) -> None:
    nameless = make_bag('nameless.bag', jittery_robot(10.0, 30.0, 1), sources=False)
    other = str(tmp_path / 'other.model')
    assert train.main([nameless, '-o', other]) == 0
    assert 'another encoding' in error_of(diff, [before, other], capsys)
    assert 'another encoding' in error_of(diff, [before, nameless], capsys)
    assert 'must be a model' in error_of(diff, robot_bags, capsys)
    assert 'no such file' in error_of(diff, [before, str(tmp_path / 'missing')], capsys)
    (tmp_path / 'text').write_text('something else')
    text = str(tmp_path / 'text')
    assert text in error_of(diff, [before, text], capsys)
    stranger = make_bag('other.bag', [(10.0 + 0.1 * i, '/x', '/y') for i in range(99)])
    assert stranger in error_of(diff, [before, stranger], capsys)
    paper = str(tmp_path / 'paper.model')
    assert train.main([robot_bags[0], '--detector', 'paper', '-o', paper]) == 0
    assert paper in error_of(diff, [before, paper], capsys)
