"""`diff`: what changed is at the top, and what did not is not there."""
from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Callable, Iterable, List, Tuple

import pytest
from browser import opened
from conftest import Message, error_of, jittery_robot, printed_by, write_bag

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


def changes(*arguments: str) -> List[str]:
    """Return the lines about changes."""
    out = printed_by(diff, list(arguments))
    assert out.startswith('before  ') and '\nafter   ' in out
    found = re.findall(r'^(?:gone|ended|new|rate|gap|delay) .*$', out, re.MULTILINE)
    assert bool(found) != ('nothing changed by more than chance' in out)
    return found


def test_another_day_of_the_same_robot_is_no_change(before: str, trained, make_bag) -> None:
    assert changes(before, before) == []
    assert changes(before, trained('another_day', lambda message: [message])) == []
    bag = make_bag('today.bag', jittery_robot(3000.0, 120.0, 77))
    assert changes(before, bag) == []
    assert changes(before, f'{bag}@10-100') == []
    assert changes(bag, before) == []


def test_a_missing_node_is_at_the_top(before: str, trained) -> None:
    after = trained('missing', lambda message: [] if message[1] == '/battery' else [message])
    found, = changes(before, after)
    assert re.match(r'gone +/battery /charge std_msgs/String: 2\.7\d? Hz, as all of its source',
                    found)
    found, = changes(after, before)
    assert found.startswith('new ') and '/battery' in found


def test_a_new_topic_of_a_known_node(before: str, make_bag) -> None:
    messages = sorted(new for m in jittery_robot(3000.0, 120.0, 5)
                      for new in ([m, (m[0] + 0.001, m[1], '/status')] if m[1] == '/battery'
                                  else [m]))
    found, = changes(before, make_bag('new.bag', messages))
    assert re.match(r'new +/battery /status std_msgs/String: 2\.7\d? Hz$', found)


def test_half_the_rate(before: str, trained) -> None:
    kept = iter(range(10**9))
    after = trained('half', lambda m: [m] if m[1] != '/battery' or next(kept) % 2 else [])
    found = changes(before, after)
    assert re.match(r'rate +/battery /charge std_msgs/String: 2\.7\d? Hz, now 1\.3\d? Hz '
                    r'\(0\.50 times\)', found[0])
    assert len(found) == 1  # its gaps are explained by that


def test_a_node_that_ended_has_no_other_rate(before: str, make_bag, tmp_path: Path) -> None:
    bag = make_bag('ended.bag', [m for m in jittery_robot(3000.0, 120.0, 5)
                                 if m[1] != '/battery' or m[0] < 3060.0])
    found, = changes(before, bag)
    assert re.match(r'ended +/battery /charge std_msgs/String: last heard at (59|60)\.\d s, '
                    r'(59|60)\.\d s before the end, as all of its source$', found)
    page = tmp_path / 'd.html'
    change, = json.loads(printed_by(diff, [before, bag, '--json', '--html', str(page)]))['changes']
    assert (change['change'], change['last_heard_s']) == ('ended', pytest.approx(60.0, abs=0.5))
    assert '/battery ended' in page.read_text()


def test_what_could_not_be_compared_is_not_called_unchanged(model_file: str, make_bag,
                                                            tmp_path: Path) -> None:
    """All answers of this recording are 60 ms late, and no pair is compared."""
    bag = make_bag('late.bag', sorted(
        (m[0] + 0.06, *m[1:]) if m[1] == '/slam' else m
        for m in jittery_robot(3000.0, 120.0, 5)))
    page = tmp_path / 'd.html'
    out = printed_by(diff, [model_file, bag, '--html', str(page)])
    text = page.read_text()
    assert 'of what was compared, nothing changed' in out
    assert 'summary unknown' in text and 'Rates and gaps are as before' in text
    assert 'summary quiet' not in text
    assert 'delays between event types were not compared' in out
    assert 'no model is calibrated' in out and 'calibrate one' in out


def test_another_delay_of_an_answer(before: str, sooner: str) -> None:
    found, = changes(before, sooner)
    assert re.match(f'delay +{LASER} -> {SLAM}: 3\\d.* ms, now 2\\d.* ms \\(-1', found)
    found, = changes(sooner, before)
    assert re.match(f'delay +{LASER} -> {SLAM}: 2\\d.* ms, now 3\\d.* ms \\(\\+1', found)


def test_longer_pauses_at_about_the_same_rate(before: str, trained) -> None:
    """Every 40th charge comes 200 ms late: the rate stays, the longest usual gap grows."""
    number = iter(range(10**9))
    after = trained('pauses', lambda m: [
        (m[0] + (0.2 if next(number) % 40 == 0 else 0.0), *m[1:]) if m[1] == '/battery' else m])
    found = changes(before, after)
    assert re.match(r'gap +/battery /charge std_msgs/String: usually up to 3[78]\d ms, now up to '
                    r'5\d\d ms', found[0])


def test_what_is_too_rare_to_say_is_told_apart(before: str, make_bag) -> None:
    bag = make_bag('rare.bag', sorted([*jittery_robot(3000.0, 120.0, 5),
                                       (3060.0, '/operator', '/stop')]))
    assert changes(before, bag) == []
    assert 'too rare to say that it is not chance: /operator /stop' in printed_by(diff, [before,
                                                                                         bag])


def test_the_root_comes_before_its_victims(before: str, trained, tmp_path: Path) -> None:
    """Both are at half their rate; messages of the laser get to slam."""
    ticks = {'/laser': iter(range(10**9)), '/slam': iter(range(10**9))}
    after = trained('both', lambda m: [m] if m[1] not in ticks or next(ticks[m[1]]) % 2 else [])
    model = TrainedModel.load(before)
    model.graph = {('/slam', '/x', '/zzz'), ('/laser', '/scan', '/slam')}
    model.save(str(tmp_path / 'graph.model'))
    found = changes(str(tmp_path / 'graph.model'), after)
    assert [line.split()[1] for line in found[:2]] == ['/laser', '/slam']


def test_json_and_page_say_the_same(before: str, sooner: str, tmp_path: Path) -> None:
    page = tmp_path / 'd.html'
    values = json.loads(printed_by(diff, [before, sooner, '--json', '--html', str(page)]))
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


def test_bad_input_is_told(before: str, make_bag, tmp_path: Path, robot_bags) -> None:
    nameless = make_bag('nameless.bag', jittery_robot(10.0, 30.0, 1), sources=False)
    stranger = make_bag('other.bag', [(10.0 + 0.1 * i, '/x', '/y') for i in range(99)])
    other, paper, text, missing = (str(tmp_path / name) for name in ('o', 'p', 'text', 'missing'))
    assert train.main([nameless, '-o', other]) == 0
    assert train.main([robot_bags[0], '--detector', 'paper', '-o', paper]) == 0
    Path(text).write_text('something else')
    for named, told in ((other, 'another encoding'), (nameless, 'another encoding'),
                        (missing, 'no such file'), (text, text), (stranger, stranger),
                        (paper, paper)):
        assert told in error_of(diff, [before, named])
    assert 'must be a model' in error_of(diff, robot_bags)
