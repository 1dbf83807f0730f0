"""`score` by evidence: the alarm names its evidence; what was never seen; the table of windows."""
from __future__ import annotations

import csv
import re
import shutil
from typing import Callable, List, Tuple

import numpy as np
import pytest
from conftest import Message, jittery_robot

from self_awareness import (EVIDENCE_THRESHOLD, Acceptance, DetectorParameters, EvidenceModel,
                            TrainedModel, accepted_file, judge_by_evidence, read_events)
from self_awareness.commands import score


def without_laser(start: float) -> List[Message]:
    """Its laser falls silent from 12 s to 20 s."""
    return [m for m in jittery_robot(start, 30.0, 3) if not (start + 12.0 <= m[0] < start + 20.0
                                                             and m[1] == '/laser')]


def alarms(out: str) -> List[Tuple[float, float, str]]:
    """Return start [s], end [s] and evidence, if details were asked for, of printed alarms."""
    found = re.findall(r'^    ([\d.]+) - ([\d.]+) s.* UTC(?:: \d+ % of the limit, (.+))?$', out,
                       re.MULTILINE)
    return [(float(start), float(end), evidence) for start, end, evidence in found]


def test_the_alarm_names_its_evidence_and_its_suspect(
        evidence_model: str, make_bag: Callable[..., str], capsys) -> None:
    bag = make_bag('dead.bag', without_laser(3000.0))
    assert score.main([bag, '--model', evidence_model, '--details']) == 0
    out = capsys.readouterr().out
    (start, end, evidence), = alarms(out)
    assert 12.0 < start < 13.0 and 19.5 < end < 26.0
    assert 'overdue' in evidence.split(', ')
    assert re.search(r'^    1\. /laser /scan std_msgs/String: silent for ', out, re.MULTILINE)


def test_a_fault_during_the_alarm_is_printed_with_its_time(
        evidence_model: str, make_bag: Callable[..., str], capsys) -> None:
    bag = make_bag('two.bag', [m for m in jittery_robot(3000.0, 60.0, 3)
                               if not (m[0] >= 3012.0 and m[1] == '/laser')
                               and not (m[0] >= 3040.0 and m[1] == '/battery')])
    assert score.main([bag, '--model', evidence_model]) == 0
    out = capsys.readouterr().out
    assert len(alarms(out)) == 1
    since, = re.findall(r'^    since ([\d.]+) s /battery /charge std_msgs/String: silent for ',
                        out, re.MULTILINE)
    assert 40.0 < float(since) < 43.0


def test_a_suspicion_is_printed_with_its_reason(
        evidence_model: str, make_bag: Callable[..., str], capsys) -> None:
    bag = make_bag('new.bag', sorted([*jittery_robot(3000.0, 30.0, 5), (3010.02, '/new', '/a')]))
    assert score.main([bag, '--model', evidence_model]) == 0
    out = capsys.readouterr().out
    lines = out.splitlines()
    assert lines[0] == f'{bag}: 30 s, 1 suspicion'
    assert re.fullmatch(r'    suspicion: 10\.1 - 12\.\d s, 1970-\S+ \S+ - 1970-\S+ \S+ UTC',
                        lines[2])
    assert lines[3:] == [
        '    1. /new /a std_msgs/String: never seen in training, 1 in this window',
        '1 recording, 30 s: 1 suspicion']


def test_a_part_is_judged_by_itself(evidence_model: str, make_bag: Callable[..., str], tmp_path,
                                    capsys) -> None:
    bag, table = make_bag('dead.bag', without_laser(3000.0)), tmp_path / 'w.csv'
    assert score.main([f'{bag}@0-11', f'{bag}@11', f'{bag}@2-25', '--model', evidence_model,
                       '--csv', str(table)]) == 0
    out = capsys.readouterr().out
    before, after, both = re.split(f'^{bag}', out, flags=re.MULTILINE)[1:]
    assert before.startswith('@0-11: 11 s, nothing abnormal\n') and alarms(before) == []
    # Times count from the bag's first message; the part settles until 16 s.
    assert after.startswith('@11: 19 s, 1 incident\n')
    assert [start for start, _, _ in alarms(after)] == [pytest.approx(16.1, abs=0.21)]
    assert both.startswith('@2-25: 23 s, 1 incident\n')
    assert [start for start, _, _ in alarms(both)] == [pytest.approx(12.3, abs=0.21)]
    with open(table, newline='') as file:
        rows = list(csv.DictReader(file))
    starts = [int(row['window_start_ns']) for row in rows if row['bag'] == f'{bag}@2-25']
    assert (min(starts), max(starts)) == (3002 * 10**9, 3025 * 10**9)


def test_normal_operation_is_no_alarm(evidence_model: str, make_bag: Callable[..., str],
                                      capsys) -> None:
    bag = make_bag('normal.bag', jittery_robot(7000.0, 60.0, 4))
    assert score.main([bag, '--model', evidence_model]) == 0
    assert capsys.readouterr().out == (f'{bag}: 60 s, nothing abnormal\n'
                                       '1 recording, 60 s: nothing abnormal\n')
    assert score.main([bag, '--model', evidence_model, '--details']) == 0
    assert (', 0 abnormal (0.0%; settling left out), alarms: 0, suspicions: 0\n'
            in capsys.readouterr().out)


def test_the_table_has_every_window_with_all_digits(
        evidence_model: str, make_bag: Callable[..., str], tmp_path, capsys) -> None:
    bag, table = make_bag('dead.bag', without_laser(3000.0)), tmp_path / 'w.csv'
    assert score.main([bag, '--model', evidence_model, '--csv', str(table)]) == 0
    assert table.read_text().splitlines()[0] \
        == 'bag,window_start_ns,events,unknown,score,threshold,abnormal'
    with open(table, newline='') as file:
        rows = list(csv.DictReader(file))
    trained = TrainedModel.load(evidence_model)
    events = read_events(bag, trained.encoding, trained.event_types)
    verdicts = judge_by_evidence(trained, EvidenceModel(trained), DetectorParameters(),
                                 events.stamps, events.ids)
    assert [float(row['score']) for row in rows] == verdicts.score.tolist()
    assert [row['abnormal'] == '1' for row in rows] == verdicts.abnormal.tolist()
    assert {float(row['threshold']) for row in rows} == {EVIDENCE_THRESHOLD}
    # A window of silence has a score, too: silence is evidence.
    assert np.isfinite(verdicts.score).all() and verdicts.score.min() < EVIDENCE_THRESHOLD


def test_what_is_accepted_is_not_judged_and_is_said(
        evidence_model: str, make_bag: Callable[..., str], tmp_path, capsys) -> None:
    model = str(shutil.copy(evidence_model, tmp_path))
    bag = make_bag('new.bag', sorted([*jittery_robot(3000.0, 30.0, 5), (3010.02, '/new', '/a')]))
    accepted_file.keep([Acceptance('/new', '/a', 'stranger')], model)
    assert score.main([bag, '--model', model]) == 0
    out = capsys.readouterr().out
    assert 'accepted, so not judged: /new on /a (stranger)' in out
    assert f'{bag}: 30 s, nothing abnormal\n' in out


@pytest.mark.parametrize('option, raised', [('error', True), ('warn', False), ('ignore', False)])
def test_what_was_never_seen_is_an_alarm_where_that_is_asked_for(
        evidence_model: str, make_bag: Callable[..., str], option: str, raised: bool,
        capsys) -> None:
    bag = make_bag('new.bag', sorted([*jittery_robot(3000.0, 30.0, 5), (3010.02, '/new', '/a')]))
    assert score.main([bag, '--model', evidence_model, '--details', '--unknown',
                       option]) == 0
    out = capsys.readouterr().out
    assert '    /new /a std_msgs/String: 1\n' in out
    assert ([start for start, _, _ in alarms(out)] == [pytest.approx(10.1, abs=0.11)]) == raised
    assert raised or alarms(out) == []


def test_a_model_without_limits_scores_nothing_abnormal_and_says_so(
        model_file: str, make_bag: Callable[..., str], tmp_path, capsys) -> None:
    """Its recording was too short for preliminary limits."""
    bag, table = make_bag('dead.bag', without_laser(3000.0)), tmp_path / 'w.csv'
    assert score.main([bag, '--model', model_file, '--csv', str(table)]) == 0
    out = capsys.readouterr().out
    assert f'{model_file}: not calibrated' in out and 'calibrate' in out and 'alarm' not in out
    with open(table, newline='') as file:
        assert {(row['threshold'], row['abnormal']) for row in csv.DictReader(file)} == {('', '0')}
