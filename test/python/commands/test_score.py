"""`score` by either detector: alarms and suspects, what is new, parts, tables, result bags."""
from __future__ import annotations

import csv
import json
import os
import re
import shutil
from pathlib import Path
from typing import Any, Callable, Dict, List, Sequence, Tuple

import numpy as np
import pytest
import rosbag
from conftest import error_of, jittery_robot, printed_by

from self_awareness import (EVIDENCE_THRESHOLD, Acceptance, DetectorParameters, EvidenceModel,
                            ResultBag, TrainedModel, accepted_file, judge_by_evidence, read_events)
from self_awareness.commands import calibrate, score
from self_awareness.recordings import RecordingEvents

PAPER = ('--detector', 'paper')
MakeBag = Callable[..., str]


@pytest.fixture(scope='module')
def model(evidence_model: str, long_bags: Tuple[str, str],
          tmp_path_factory: pytest.TempPathFactory) -> str:
    """A model with limits, and with a threshold of the paper's score."""
    path = str(tmp_path_factory.mktemp('calibrated') / 'm')
    assert calibrate.main(['--model', evidence_model, '--normal', long_bags[1], *PAPER, '--inject',
                           'crash:/laser', 'crash:/slam', '-o', path]) == 0
    return path


@pytest.fixture
def dead_laser(make_bag: MakeBag) -> str:
    """Its laser falls silent from 12 s to 20 s."""
    return make_bag('dead.bag', [m for m in jittery_robot(3000.0, 30.0, 3)
                                 if not (3012.0 <= m[0] < 3020.0 and m[1] == '/laser')])


@pytest.fixture
def new(make_bag: MakeBag) -> str:
    """A node that training never saw speaks at 10.02 s."""
    return make_bag('new.bag', sorted([*jittery_robot(3000.0, 30.0, 5), (3010.02, '/new', '/a')]))


def rows_of(path: Path) -> List[Dict[str, str]]:
    with open(path, newline='') as file:
        return list(csv.DictReader(file))


def alarms(out: str) -> List[Tuple[float, float]]:
    """Return start [s] and end [s] of printed alarms."""
    return [(float(start), float(end)) for start, end in re.findall(
        r'^    ([\d.]+) - ([\d.]+) s.* UTC(?:: .+)?$', out, re.MULTILINE)]


@pytest.mark.parametrize('options, reached', [
    ((), r'\d\d+ % of the limit, (.+, )?overdue'),
    (PAPER, r'lowest score ([\d.]+), threshold [\d.]+, score')], ids=['evidence', 'paper'])
def test_the_alarm_and_its_suspect_are_printed(model: str, dead_laser: str,
                                               options: Sequence[str], reached: str) -> None:
    out = printed_by(score, [dead_laser, '--model', model, '--details', *options])
    (start, end), = alarms(out)
    assert 12.0 < start < 13.5 and 19.5 < end < 26.0
    told, = re.findall(r'^  (/.*)$', out, re.MULTILINE)
    assert told == '/laser (/scan) fell silent at 12.0 s, and came back at 20.0 s.'
    assert re.search(r'^    12\.\d - .*, 1970-01-01 00:50:1.* - 1970-01-01 00:50:2.* UTC: '
                     + reached, out, re.MULTILINE)  # 3012 s after the epoch
    assert re.search(r'^    1\. /laser /scan std_msgs/String: silent for ', out, re.MULTILINE)


def test_a_suspicion_is_printed_with_its_reason(model: str, new: str) -> None:
    lines = printed_by(score, [new, '--model', model]).splitlines()
    assert lines[0] == f'{new}: 30 s, 1 suspicion'
    assert re.fullmatch(r'    suspicion: 10\.1 - 12\.\d s, 1970-\S+ \S+ - 1970-\S+ \S+ UTC',
                        lines[2])
    assert lines[3:] == [
        '    1. /new /a std_msgs/String: never seen in training, 1 in this window',
        '1 recording, 30 s: 1 suspicion']


def test_silence_up_to_the_end_of_the_recording_is_seen(model: str, make_bag: MakeBag) -> None:
    # All components are dead; only the clock, which is no event, goes on.
    bag = make_bag('end.bag', [*jittery_robot(3000.0, 10.0, 3),
                               (3015.0, '/clock_server', '/clock')])
    assert '- 15.1 s (to the end of the recording' in printed_by(score, [bag, '--model', model,
                                                                         *PAPER])


@pytest.mark.parametrize('options, raised', [
    (['--unknown', 'error'], True), (['--unknown', 'warn'], False),
    (['--unknown', 'ignore'], False), (PAPER, False)])
def test_what_was_never_seen_is_named_and_an_alarm_where_that_is_asked_for(
        model: str, new: str, tmp_path: Path, options: Sequence[str], raised: bool) -> None:
    table = tmp_path / 'w.csv'
    out = printed_by(score, [new, '--model', model, '--details', '--csv', str(table), *options])
    assert '    /new /a std_msgs/String: 1\n' in out
    assert [start for start, _ in alarms(out)] == [pytest.approx(10.1, abs=0.11)] * raised
    assert sum(int(row['unknown']) for row in rows_of(table)) == 1


def test_what_is_accepted_is_not_judged_and_is_said(model: str, new: str, tmp_path: Path) -> None:
    copy = str(shutil.copy(model, tmp_path / 'copy'))
    accepted_file.keep([Acceptance('/new', '/a', 'stranger')], copy)
    out = printed_by(score, [new, '--model', copy])
    assert 'accepted, so not judged: /new on /a (stranger)' in out
    assert f'{new}: 30 s, nothing abnormal\n' in out


def test_a_part_is_judged_by_itself(model: str, dead_laser: str, tmp_path: Path, capsys) -> None:
    table = tmp_path / 'w.csv'
    assert score.main([f'{dead_laser}@0-11', f'{dead_laser}@11', f'{dead_laser}@2-25', '--model',
                       model, '--csv', str(table)]) == 0
    before, after, both = re.split(f'^{dead_laser}', capsys.readouterr().out,
                                   flags=re.MULTILINE)[1:]
    assert before.startswith('@0-11: 11 s, nothing abnormal\n') and alarms(before) == []
    # Times count from the bag's first message; the part settles until 16 s.
    assert after.startswith('@11: 19 s, 1 incident\n')
    assert [start for start, _ in alarms(after)] == [pytest.approx(16.1, abs=0.21)]
    assert both.startswith('@2-25: 23 s, 1 incident\n')
    assert [start for start, _ in alarms(both)] == [pytest.approx(12.3, abs=0.21)]
    starts = [int(row['window_start_ns']) for row in rows_of(table)
              if row['bag'] == f'{dead_laser}@2-25']
    assert (min(starts), max(starts)) == (3002 * 10**9, 3025 * 10**9)


def test_normal_operation_is_no_alarm(model: str, make_bag: MakeBag, capsys) -> None:
    """Where all are watched, nothing is said of that."""
    bag = make_bag('normal.bag', jittery_robot(7000.0, 60.0, 4))
    assert score.main([bag, '--model', model]) == 0
    assert capsys.readouterr().out == (f'{bag}: 60 s, nothing abnormal\n'
                                       '1 recording, 60 s: nothing abnormal\n')
    assert (', 0 abnormal (0.0%; settling left out), alarms: 0, suspicions: 0\n'
            in printed_by(score, [bag, '--model', model, '--details']))


def test_the_table_has_every_window_with_all_digits(model: str, dead_laser: str,
                                                    tmp_path: Path) -> None:
    table = tmp_path / 'w.csv'
    assert score.main([dead_laser, '--model', model, '--csv', str(table)]) == 0
    assert table.read_text().splitlines()[0] \
        == 'bag,window_start_ns,events,unknown,score,threshold,abnormal'
    rows, trained = rows_of(table), TrainedModel.load(model)
    events = read_events(dead_laser, trained.encoding, trained.event_types)
    verdicts = judge_by_evidence(trained, EvidenceModel(trained), DetectorParameters(),
                                 RecordingEvents(events.event_types, events.stamps, events.ids))
    assert [float(row['score']) for row in rows] == verdicts.score.tolist()
    assert [row['abnormal'] == '1' for row in rows] == verdicts.abnormal.tolist()
    assert {float(row['threshold']) for row in rows} == {EVIDENCE_THRESHOLD}
    # A window of silence has a score, too: silence is evidence.
    assert np.isfinite(verdicts.score).all() and verdicts.score.min() < EVIDENCE_THRESHOLD


def test_a_name_that_a_spreadsheet_would_compute_is_a_text(model: str, robot_bags, tmp_path: Path,
                                                           monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ('=1+1.bag', '@a.bag', '+a.bag'):
        shutil.copy(robot_bags[1], name)
        assert score.main([name, '--model', model, *PAPER, '--csv', 'w.csv']) == 0
        assert calibrate.main(['--model', model, '--normal', name, *PAPER, '--cutoff', 'fpr=0.1',
                               '-o', 'm', '--csv', 'c.csv']) == 0
        for table in (tmp_path / 'w.csv', tmp_path / 'c.csv'):
            assert {row['bag'] for row in rows_of(table)} == {f"'{name}"}


def test_a_model_without_limits_scores_nothing_abnormal_and_says_so(
        model_file: str, dead_laser: str, tmp_path: Path) -> None:
    """Its recording was too short for preliminary limits."""
    table = tmp_path / 'w.csv'
    out = printed_by(score, [dead_laser, '--model', model_file, '--csv', str(table)])
    assert f'{model_file}: not calibrated' in out and 'calibrate' in out and 'alarm' not in out
    assert {(row['threshold'], row['abnormal']) for row in rows_of(table)} == {('', '0')}


def test_scripts_see_an_alarm_by_the_exit_code(model: str, dead_laser: str, model_file: str,
                                               make_bag: MakeBag, capsys) -> None:
    normal = make_bag('normal.bag', jittery_robot(7000.0, 30.0, 4))
    assert score.main([normal, '--model', model, '--fail']) == 0
    assert score.main([normal, dead_laser, '--model', model, '--fail']) == 3
    assert capsys.readouterr().out.splitlines()[-1] == '2 recordings, 60 s: 1 incident'
    assert score.main([dead_laser, '/gone.bag', '--model', model, '--fail']) == 1
    assert (f'--fail: {model_file} is not calibrated, so nothing would ever be an alarm'
            in error_of(score, [dead_laser, '--model', model_file, '--fail']))


def test_the_report_is_opened_in_a_browser(model: str, dead_laser: str, tmp_path: Path, capsys,
                                           monkeypatch: pytest.MonkeyPatch) -> None:
    report = tmp_path / 'a report.html'
    opened: List[str] = []
    command = [dead_laser, '--model', model, '--open']
    monkeypatch.chdir(tmp_path)

    def show(url: str) -> bool:
        opened.append(url)
        return report.exists()

    monkeypatch.setattr('webbrowser.open', show)
    assert score.main([*command, '--report', report.name]) == 0
    assert opened == [report.as_uri()]
    assert capsys.readouterr().err == ''
    monkeypatch.setattr('webbrowser.open', lambda url: False)
    assert score.main([*command, '--report', report.name]) == 0
    assert 'warning: no browser was found here: copy a report.html to' in capsys.readouterr().err
    assert '--open: opens the report; name it by --report FILE.html' in error_of(score, command)


def test_silence_of_the_papers_detector_is_abnormal_and_has_no_score(
        model: str, make_bag: MakeBag, tmp_path: Path) -> None:
    silent = make_bag('silent.bag', [m for m in jittery_robot(3000.0, 30.0, 3)
                                     if not 3012.0 <= m[0] < 3015.0])
    assert score.main([silent, '--model', model, *PAPER, '--csv', str(tmp_path / 'w.csv')]) == 0
    quiet = [row for row in rows_of(tmp_path / 'w.csv') if row['events'] == '0']
    assert len(quiet) >= 29
    assert {(row['score'], row['abnormal']) for row in quiet} == {('', '1')}


def test_nothing_is_judged_before_it_has_settled(model: str, dead_laser: str) -> None:
    assert alarms(printed_by(score, [dead_laser, '--model', model, *PAPER, '--settle-time',
                                     '25'])) == []


STATUS, ALARM, DIAGNOSTICS = '/self_awareness/status', '/self_awareness/alarm', '/diagnostics'
VERSION = '/version'
OK, WARN, ERROR = 0, 1, 2


@pytest.fixture
def dying_laser(make_bag: Callable[..., str]) -> str:
    """Its laser falls silent from 12 s to 20 s, and a stranger speaks at 5.5 s."""
    return make_bag('dead.bag', sorted(
        [m for m in jittery_robot(3000.0, 30.0, 3)
         if not (3012.0 <= m[0] < 3020.0 and m[1] == '/laser')] + [(3005.52, '/new', '/a')]))


@pytest.fixture
def results(evidence_model: str, dying_laser: str, tmp_path: Path) -> Tuple[str, Dict[str, Any]]:
    """The result bag of it, and what was said of it as JSON."""
    path, values = str(tmp_path / 'out.bag'), tmp_path / 'out.json'
    assert score.main([dying_laser, '--model', evidence_model, '--result-bag', path,
                       '--json', str(values)]) == 0
    return path, json.loads(values.read_text())['recordings'][0]


def read(path: str, topic: str) -> List[Tuple[Any, Any]]:
    """Return message and time [s] of a topic."""
    with rosbag.Bag(path) as bag:
        return [(message, stamp.to_sec()) for _, message, stamp in bag.read_messages(topic)]


def test_programs_need_not_parse_words(results: Tuple[str, Dict[str, Any]],
                                       dying_laser: str) -> None:
    """The monitor's messages and score --json tell the same, in fields."""
    path, recording = results
    assert recording['bag'] == dying_laser
    told = [message for message, _ in read(path, ALARM)]
    begun = {}
    for message in told:
        if message.level != OK:
            begun.setdefault(message.alarm, message)
    assert [alarm['id'] for alarm in recording['alarms']] == list(begun)
    assert {alarm['level'] for alarm in recording['alarms']} == {'WARN', 'ERROR'}
    for alarm, message in zip(recording['alarms'], begun.values()):
        assert (alarm['kind'], alarm['culprit']) == (message.kind, message.component)
        assert alarm['reason'] == message.reason
        assert alarm['level'] == {WARN: 'WARN', ERROR: 'ERROR'}[message.level]
        assert alarm['begin_ns'] == message.header.stamp.to_nsec() <= alarm['end_ns']
        for said, suspect in zip(alarm['suspects'], message.suspects):
            assert said['reason'] == suspect.reason
            assert (said['component'], said['kind']) == (suspect.component, suspect.kind)
            assert said['event_type'].split()[:2] == [suspect.source, suspect.scope]
            assert (said['value'], said['unit']) == (suspect.value, suspect.unit)
    times = {key: {alarm[key] for alarm in recording['alarms']} for key in ('begin_ns', 'end_ns')}
    assert {message.header.stamp.to_nsec() for message in told if message.level == OK} == (
        times['end_ns'] - times['begin_ns'])
    died = next(alarm for alarm in recording['alarms'] if alarm['level'] == 'ERROR')
    assert (died['kind'], died['culprit']) == ('silent', '/laser')
    assert 12.0 < died['begin_s'] < 13.0 and died['end_s'] > 20.0 and died['over']
    first = died['suspects'][0]
    assert first['unit'] == 's' and first['value'] == pytest.approx(died['begin_s'] - 12, abs=0.2)
    assert first['usual'] < first['value'] and first['after'] is None


def test_times_are_those_of_the_recording_and_diagnostics_tell_of_all(
        results: Tuple[str, Dict[str, Any]], dying_laser: str) -> None:
    """All else of it: test/ros/verdict/replayed_monitor_test.cpp."""
    path, _ = results
    with rosbag.Bag(path) as bag, rosbag.Bag(dying_laser) as recording:
        assert bag.get_compression_info().compression == 'lz4'
        assert set(bag.get_type_and_topic_info().topics) == {VERSION, STATUS, ALARM, DIAGNOSTICS}
        assert next(bag.read_messages()).topic == VERSION
        stamps = [stamp for _, _, stamp in bag.read_messages([STATUS, ALARM, DIAGNOSTICS])]
        assert recording.get_start_time() < stamps[0].to_sec()
        assert stamps[-1].to_sec() == pytest.approx(recording.get_end_time(), abs=0.11)
        assert {connection.topic: connection.header['latching']
                for connection in bag._get_connections()} == {
                    VERSION: b'0', STATUS: b'0', ALARM: b'1', DIAGNOSTICS: b'0'}
    alarm, at = next((message, stamp) for message, stamp in read(path, ALARM)
                     if message.level == ERROR)
    status = next(array.status for array, stamp in read(path, DIAGNOSTICS) if stamp == at)
    by_name = {each.name.split(': ')[1]: (each.level, each.message) for each in status}
    assert list(by_name) == ['communication', '/battery', '/laser', '/slam']
    assert by_name['communication'] == (ERROR, alarm.message)
    assert by_name['/laser'][0] == ERROR and by_name['/laser'][1].startswith('/scan: silent for ')
    assert by_name['/battery'][1] == 'heard'


def test_several_recordings_are_in_one_bag_in_the_order_of_time(
        evidence_model: str, make_bag: Callable[..., str], tmp_path: Path) -> None:
    later = make_bag('later.bag', jittery_robot(7000.0, 12.0, 4))
    earlier = make_bag('earlier.bag', jittery_robot(3000.0, 12.0, 3))
    both, alone = str(tmp_path / 'both.bag'), str(tmp_path / 'alone.bag')
    assert score.main([later, earlier, '--model', evidence_model, '--result-bag', both]) == 0
    assert score.main([later, '--model', evidence_model, '--result-bag', alone]) == 0
    windows = [message.window_start.to_nsec() for message, _ in read(both, STATUS)]
    assert windows == sorted(windows)
    assert windows[0] < 3100 * 10**9 and windows[-1] > 7000 * 10**9
    assert [message for message, _ in read(both, STATUS)
            if message.window_start.to_sec() > 6000] == [m for m, _ in read(alone, STATUS)]


def test_recordings_that_overlap_are_refused(
        evidence_model: str, make_bag: Callable[..., str], tmp_path: Path) -> None:
    bag, path = make_bag('a.bag', jittery_robot(3000.0, 20.0, 3)), str(tmp_path / 'out.bag')
    assert 'overlap in time' in error_of(score, [f'{bag}@0-12', f'{bag}@8', '--model',
                                                 evidence_model, '--result-bag', path])
    assert not os.path.exists(path)
    assert score.main([f'{bag}@0-10', f'{bag}@10', '--model', evidence_model,
                       '--result-bag', path]) == 0


def test_a_recording_that_cannot_be_judged_keeps_no_other_from_it(evidence_model: str,
                                                                  dying_laser: str,
                                                                  make_bag: Callable[..., str],
                                                                  tmp_path: Path) -> None:
    other = make_bag('other.bag', [(9000.0 + i, '/a', '/b') for i in range(9)])
    before = sorted(tmp_path.iterdir())
    results = tmp_path / 'out.bag'
    assert score.main([other, '--model', evidence_model, '--result-bag', str(results)]) == 1
    assert sorted(tmp_path.iterdir()) == before
    assert 'the model knows none of' in error_of(score, [other, dying_laser, '--model',
                                                         evidence_model, '--result-bag',
                                                         str(results)])
    assert ResultBag.is_one(str(results))
