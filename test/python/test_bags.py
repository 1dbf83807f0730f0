"""What a program reads of bags: whole ones, copies, and those of one recording that were split."""
from __future__ import annotations

import random
from pathlib import Path
from typing import Any, Callable, Dict, Iterable, List, Optional, Sequence, Set, Tuple

import pytest
import rosbag
import rospy
from conftest import Message, error_of, printed_by, put, robot, trained, write_bag
from diagnostic_msgs.msg import DiagnosticArray
from rosbag import rosbag_main
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Image
from std_msgs.msg import String

from self_awareness import BagError, EncodingRules, EventLogWriter, read_events, summarise_bag
from self_awareness.commands import calibrate, convert, info, score, train
from self_awareness.msg import SelfAwareness
from self_awareness.parts import BagPart, look
from self_awareness.split_bags import Span, joined

_IMAGE_BYTES = 1_000_000


@pytest.fixture(scope='module')
def image_bag(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A camera's minute: an image and ten lines of its log every second."""
    path = str(tmp_path_factory.mktemp('images') / 'images.bag')
    image = Image(data=bytes(_IMAGE_BYTES))
    with rosbag.Bag(path, 'w') as bag:
        for i in range(600):
            for topic, message in [('/image', image)] * (i % 10 == 0) + [('/rosout', Log())]:
                put(bag, '/camera', topic, message, 1000 + 0.1 * i)
    return path


def _bytes_read() -> int:
    counts = dict(line.split(': ') for line in Path('/proc/self/io').read_text().splitlines())
    return int(counts['rchar'])


def test_events_outlive_what_they_were_read_with(image_bag: str) -> None:
    stamps = read_events(image_bag, EncodingRules.defaults()).stamps
    ids = read_events(image_bag, EncodingRules.defaults()).ids
    assert len(stamps) == len(ids) == summarise_bag(image_bag).messages
    assert stamps[0] == 1000 * 10**9
    assert (stamps[1:] >= stamps[:-1]).all()
    with pytest.raises(ValueError):
        stamps[0] = 0


def test_the_index_of_an_event_log_is_read_once_for_all_recordings(make_bag, tmp_path: Path
                                                                   ) -> None:
    bag, path = make_bag('robot.bag', robot(1000.0, 100.0)), str(tmp_path / 'many.events.bag')
    log = EventLogWriter(path)
    for _ in range(40):
        log.add_bag(bag, EncodingRules.defaults())
    log.close()
    before = _bytes_read()
    for recording in range(40):
        assert len(read_events(path, EncodingRules.defaults(), recording=recording).stamps) > 4000
    assert _bytes_read() - before < 8 * Path(path).stat().st_size  # not 40 times and more


def test_an_event_log_that_was_replaced_is_read_again(make_bag, tmp_path: Path) -> None:
    path = str(tmp_path / 'robot.events.bag')
    for length in (10.0, 20.0):
        log = EventLogWriter(path)
        log.add_bag(make_bag('robot.bag', robot(1000.0, length)), EncodingRules.defaults())
        log.close()
        events = read_events(path, EncodingRules.defaults(), recording=0)
        assert events.stamps[-1] - events.stamps[0] > (length - 1.0) * 1e9


def test_nodes_of_this_package_are_left_out_whatever_their_names(tmp_path: Path) -> None:
    """What they say in a recording is no communication of the robot."""
    path, encoding = str(tmp_path / 'a.bag'), EncodingRules.defaults()
    with rosbag.Bag(path, 'w') as bag:
        for tick in range(600):
            for source, topic, message in (
                    ('/watch', '/watch/status', SelfAwareness()), ('/watch', '/rosout', Log()),
                    ('/base', '/diagnostics', DiagnosticArray()), ('/watch', '/scan', String())):
                put(bag, source, topic, message, 1000.0 + 0.1 * tick)

    def heard() -> Set[Tuple[str, str]]:
        return {(kind.source, kind.scope) for kind in read_events(path, encoding).event_types}

    assert heard() == {('/base', '/diagnostics'), ('/watch', '/scan')}
    # Where all is under the name of a player, nobody can be told from the robot's nodes.
    encoding.source = 'none'
    assert heard() == {('', '/diagnostics'), ('', '/rosout'), ('', '/scan')}


_PERIODS_S = {('/arm', '/joints'): 0.1, ('/hand', '/joints'): 0.11, ('/hand', '/touch'): 0.2}


def _messages(start: float, length: float) -> Iterable[Tuple[float, str, str]]:
    return sorted((start + period * i, source, topic)
                  for (source, topic), period in _PERIODS_S.items()
                  for i in range(int(length / period)))


def _record(path: Path, start: float, length: float = 90.0) -> str:
    """Write a recording of two nodes that publish on the same topic."""
    connections: Dict[str, Any] = {}
    with rosbag.Bag(str(path), 'w') as bag:
        for stamp, source, topic in _messages(start, length):
            # rosbag itself has one connection for each topic, however many nodes publish there.
            bag._topic_connections = connections.setdefault(source, {})
            header = {'callerid': source, 'latching': '0', 'md5sum': String._md5sum,
                      'message_definition': String._full_text, 'topic': topic,
                      'type': String._type}  # in the order of `rosbag record`
            bag.write(topic, String('x'), rospy.Time.from_sec(stamp), connection_header=header)
    return str(path)


def _filtered(bag: str) -> str:
    copy = bag.replace('.bag', '_filtered.bag')
    rosbag_main.filter_cmd([bag, copy, 'True'])
    return copy


def _compressed(bag: str) -> str:
    rosbag_main.compress_cmd(['--quiet', bag])
    return bag


@pytest.fixture
def recorded(tmp_path: Path) -> str:
    """A recording."""
    return _record(tmp_path / 'recorded.bag', 1000.0)


@pytest.fixture
def model(recorded: str, tmp_path: Path) -> str:
    """A model of it, which knows both senders of a topic."""
    trained([recorded], tmp_path / 'm')
    return str(tmp_path / 'm')


@pytest.mark.parametrize('copy', [_filtered, _compressed])
def test_copies_of_recordings_are_told_from_recordings(recorded: str,
                                                       copy: Callable[[str], str]) -> None:
    before = summarise_bag(recorded)
    assert not before.one_sender_a_topic and not before.copied
    after = summarise_bag(copy(recorded))
    assert after.one_sender_a_topic and after.copied
    assert after.fingerprint == before.fingerprint


def test_training_says_so(recorded: str, tmp_path: Path, capsys) -> None:
    copy = _filtered(recorded)
    trained([recorded], tmp_path / 'm')
    assert 'warning' not in capsys.readouterr().out
    trained([copy], tmp_path / 'm')
    line, = [line for line in capsys.readouterr().out.splitlines() if 'warning' in line]
    assert line.startswith(f'{copy}: warning: a copy that rosbag filter, compress or decompress ')
    assert 'Use the bag as it was recorded' in line
    encoding = tmp_path / 'encoding.yaml'
    encoding.write_text('source: none\n')
    trained([copy], tmp_path / 'm', '--encoding', str(encoding))
    assert 'warning' not in capsys.readouterr().out, 'senders do not count'


def test_score_and_calibrate_name_the_topics(model: str, tmp_path: Path, capsys) -> None:
    other = _record(tmp_path / 'other.bag', 2000.0)
    assert score.main([other, '--model', model]) == 0
    assert 'warning' not in capsys.readouterr().err
    copy = _filtered(other)
    for program, arguments in ((score, [copy, '--model', model]),
                               (calibrate, ['--model', model, '--normal', copy, '-o', model])):
        assert program.main(arguments) == 0
        err = capsys.readouterr().err
        assert f': warning: {copy}: this bag names only one sender for each topic' in err
        assert ': /joints (here /arm only, in the model 2 senders); use the bag as it was' in err


def test_a_bag_that_is_no_copy_may_lack_a_sender(model: str, make_bag: Callable[..., str],
                                                 capsys) -> None:
    """A program of Python wrote it; the second sender was off, or is heard on another topic."""
    off = make_bag('off.bag', [m for m in _messages(2000.0, 30.0) if m[1] == '/arm'])
    merged = make_bag('merged.bag', _messages(2000.0, 30.0))
    assert score.main([off, '--model', model]) == 0
    assert 'warning' not in capsys.readouterr().err
    assert score.main([merged, '--model', model]) == 0
    assert f'{merged}: this bag names only one sender for each topic' in capsys.readouterr().err


DATED = 'run_2026-03-04-10-{:02d}-12_{}.bag'


def spans(*files: Tuple[str, Optional[float], float]) -> 'dict[str, Span]':
    """Return spans by name, from begin and end [s]; a begin of None: the bag is empty."""
    return {name: None if begin is None else (int(begin * 1e9), int(end * 1e9))
            for name, begin, end in files}


def recordings(*files: Tuple[str, Optional[float], float]) -> List[List[str]]:
    """Return what is joined, whatever the order in which files are named."""
    shuffled = list(files)
    random.Random(len(files)).shuffle(shuffled)
    found = sorted(joined(spans(*shuffled)).recordings)
    assert found == sorted(joined(spans(*files)).recordings)
    return found


def split(folder: Path, messages: Sequence[Message], length: float, name: str = 'run_{}.bag',
          first: int = 0) -> List[str]:
    """Write messages as `rosbag record --split --duration` does; return the files."""
    folder.mkdir(exist_ok=True)
    begin = min(stamp for stamp, _, _ in messages)
    parts: List[List[Message]] = []
    for message in sorted(messages):
        while message[0] >= begin + length * (len(parts)):
            parts.append([])
        parts[-1].append(message)
    return [write_bag(folder / name.format(number), part)
            for number, part in enumerate(parts, first)]


def test_files_are_joined_by_number_and_time() -> None:
    assert recordings(('run_0.bag', 0, 30), ('run_1.bag', 30.04, 60), ('run_2.bag', 60, 70)) == [
        ['run_0.bag', 'run_1.bag', 'run_2.bag']]
    # The first files may be gone (--max-splits), and 10 comes after 9.
    assert recordings(('run_9.bag', 0, 30), ('run_10.bag', 29.999, 60)) == [
        ['run_9.bag', 'run_10.bag']]
    # Each file has the date of its own begin.
    assert recordings((DATED.format(1, 0), 0, 60), (DATED.format(2, 1), 60.1, 120)) == [
        [DATED.format(1, 0), DATED.format(2, 1)]]


@pytest.mark.parametrize('files', [
    [('run_0.bag', 0, 30), ('run_2.bag', 30.04, 60)],  # one is missing
    [('run_1.bag', 0, 30), ('run_2.bag', 33, 60)],  # numbered by people
    [('run_1.bag', 0, 30), ('run_2.bag', 30.9, 60)],  # by a script
    [('run_1.bag', 0, 30), ('run_2.bag', 20, 60)],  # of two recorders
    [('run_0.bag', 0, 30), ('walk_1.bag', 30.04, 60)],
    [('a/run_0.bag', 0, 30), ('b/run_1.bag', 30.04, 60)],  # of two robots
    [('n1.bag', 0, 30), ('n2.bag', 30.04, 60)],
    [('run_0.bag', 0, 30), (DATED.format(1, 1), 30.04, 60)],
    [(DATED.format(1, 0), 0, 30), (DATED.format(9, 1), 300, 330)]])
def test_other_files_are_recordings_of_their_own(files: List[Tuple[str, float, float]]) -> None:
    assert recordings(*files) == [[files[0][0]], [files[1][0]]]


def test_a_hole_ends_a_recording_and_is_told() -> None:
    files = [(f'run_{i}.bag', 30.0 * i, 30.0 * i + 29.9) for i in (0, 1, 3, 4)]
    found = joined(spans(*files))
    assert found.recordings == [['run_0.bag', 'run_1.bag'], ['run_3.bag', 'run_4.bag']]
    assert 'run_3.bag: another recording than run_1.bag: number 2 is missing' in found.told
    found = joined(spans(('run_1.bag', 0, 30), ('run_2.bag', 33, 60)))
    assert found.told == ['run_2.bag: another recording than run_1.bag: begins 3.0 s after its '
                          'end']


def test_a_silent_robot_leaves_time_and_empty_files_between() -> None:
    assert recordings((DATED.format(1, 0), 0, 30), (DATED.format(2, 1), 45, 60)) == [
        [DATED.format(1, 0), DATED.format(2, 1)]]
    files = ((DATED.format(1, 0), 0, 30), (DATED.format(2, 1), None, 0),
             (DATED.format(3, 2), 95, 120), (DATED.format(4, 3), None, 0))
    assert recordings(*files) == [[DATED.format(1, 0), DATED.format(3, 2)]]
    assert joined(spans(*files)).empty == {DATED.format(2, 1)}


def test_two_starts_with_one_prefix_stay_two() -> None:
    files = [(DATED.format(hour * 20 + number, number), 3600.0 * hour + 30 * number,
              3600.0 * hour + 30 * number + 30) for hour in (0, 1) for number in (0, 1, 2)]
    assert recordings(*files) == sorted([[name for name, _, _ in files[:3]],
                                         [name for name, _, _ in files[3:]]])


def test_a_joined_recording_is_what_it_was_before_the_split(tmp_path: Path, capsys) -> None:
    messages = list(robot(1000.0, 40.0))
    whole = write_bag(tmp_path / 'whole.bag', messages)
    files = split(tmp_path / 'day', messages, 7.0)
    assert len(files) == 6
    models = [trained(named, tmp_path / 'm', '--start', '8')
              for named in ([whole], [str(tmp_path / 'day')], files[::-1])]
    assert [each.bag for each in models[1].recordings] == ['run_0.bag..5']
    one, *others = [[(each.start, each.end, each.events, each.fingerprint)
                     for each in model.recordings] for model in models]
    assert others == [one, one]
    assert all(model.event_types == models[0].event_types for model in models)
    assert f'{tmp_path}/day/run_0.bag..5: 6 files of one recording' in capsys.readouterr().out


def test_parts_are_of_the_recording_or_of_a_file(tmp_path: Path) -> None:
    day = tmp_path / 'day'
    files = split(day, list(robot(1000.0, 40.0)), 10.0)
    part, = look([BagPart.parse(f'{day}@15-25')]).parts
    assert str(part) == f'{files[0]}..3@15-25'
    assert look([BagPart.parse(str(part))]).parts == [part]
    found = read_events(part.files, EncodingRules(), [], part.start, part.end)
    assert (found.stamps[0] - found.summary.start) / 1e9 == pytest.approx(15.0, abs=0.05)
    write_bag(day / 'alone.bag', robot(9000.0, 40.0))
    assert list(map(str, look([BagPart.parse(f'{day}@5-20')]).parts)) == [
        f'{day}/alone.bag@5-20', f'{files[0]}..3@5-20']
    alone, = look([BagPart.parse(f'{files[1]}@2-5')]).parts
    assert alone.files == [files[1]]
    up_to, = look([BagPart.parse(f'{files[1]}..2')]).parts
    assert up_to.files == files[1:3]
    with pytest.raises(ValueError, match='no recording from this file to that of number 7'):
        look([BagPart.parse(f'{files[0]}..7')])
    assert 'name it once' in error_of(train, [str(day), files[1], '-o', str(tmp_path / 'm')])


def test_convert_and_info_take_them_as_one(tmp_path: Path, capsys) -> None:
    files = split(tmp_path / 'day', list(robot(1000.0, 40.0)), 10.0)
    log = str(tmp_path / 'log.bag')
    assert convert.main([str(tmp_path / 'day'), '-o', log]) == 0
    assert (read_events(log, EncodingRules.defaults(), recording=0).stamps
            == read_events(files, EncodingRules.defaults()).stamps).all()
    capsys.readouterr()
    assert info.main([log, '--details']) == 0
    assert '#1 run_0.bag..3: 40.0 s' in capsys.readouterr().out
    out = printed_by(info, files[::-1])
    assert '1 recording, 40 s' in out and 'from 20.0 s on: run_2.bag' in out


def test_score_says_in_which_file_it_was(tmp_path: Path, evidence_model: str) -> None:
    dead = [message for message in robot(5000.0, 60.0)
            if message[1] == '/battery' or message[0] < 5029.7]
    files = split(tmp_path / 'day', dead, 15.0)
    assert len(files) == 4
    page = tmp_path / 'r.html'
    out = printed_by(score, [str(tmp_path / 'day'), '--model', evidence_model, '--report',
                             str(page)])
    assert out.splitlines()[-1] == '1 recording, 60 s: 1 incident', out
    assert '/laser stopped sending at 29.7 s. (14.7 s of run_1.bag)' in out, out
    assert '14.7 s of run_1.bag' in page.read_text(encoding='utf-8')


def test_a_damaged_file_ends_the_recording(tmp_path: Path) -> None:
    files = split(tmp_path / 'day', list(robot(1000.0, 50.0)), 10.0)
    Path(files[2]).write_bytes(Path(files[2]).read_bytes()[:5000])
    named = look([BagPart(str(tmp_path / 'day'))])
    assert [part.files for part in named.parts] == [files[:2], files[3:]]
    assert [line.split(': ')[0] for line in named.bad] == [files[2]]
    with pytest.raises(BagError, match='run_2.bag'):
        read_events(files, EncodingRules())


def test_an_empty_file_within_is_no_bad_one(tmp_path: Path) -> None:
    name = 'run_2026-03-04-10-11-12_{}.bag'
    messages = list(robot(1000.0, 60.0))
    files = split(tmp_path / 'day', [each for each in messages if each[0] < 1020], 20.0, name)
    with rosbag.Bag(str(tmp_path / 'day' / name.format(1)), 'w'):
        pass
    files += split(tmp_path / 'day', [each for each in messages if each[0] >= 1042], 20.0, name, 2)
    named = look([BagPart(str(tmp_path / 'day'))])
    assert not named.bad
    assert [part.files for part in named.parts] == [files]
    assert 'nothing came in run_2026-03-04-10-11-12_1.bag' in named.told[0]
