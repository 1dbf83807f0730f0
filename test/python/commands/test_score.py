"""`score --detector paper`: abnormal intervals, suspects, and the table of windows."""
from __future__ import annotations

import csv
import re
import shutil
from typing import Callable, Dict, List, Tuple

import numpy as np
import pytest
from conftest import robot

from self_awareness.commands import calibrate, score

Bags = Tuple[str, str]

PAPER = ('--detector', 'paper')


@pytest.fixture(scope='module')
def calibrated(model_file: str, robot_bags: Bags, tmp_path_factory) -> str:
    path = str(tmp_path_factory.mktemp('calibrated') / 'm')
    assert calibrate.main(['--model', model_file, '--normal', robot_bags[1], *PAPER, '--inject',
                           'crash:/laser', 'crash:/slam', '-o', path]) == 0
    return path


@pytest.fixture
def dead_laser(make_bag: Callable[..., str]) -> str:
    """Its laser falls silent from 12 s to 20 s."""
    return make_bag('dead.bag', [m for m in robot(3000.0)
                                 if not (3012.0 <= m[0] < 3020.0 and m[1] == '/laser')])


def rows_of(path) -> List[Dict[str, str]]:
    with open(path, newline='') as file:
        return list(csv.DictReader(file))


def test_the_alarm_and_its_suspect_are_printed(calibrated: str, dead_laser: str, capsys) -> None:
    assert score.main([dead_laser, '--model', calibrated, *PAPER, '--details']) == 0
    out = capsys.readouterr().out
    told, = re.findall(r'^  (/.*)$', out, re.MULTILINE)
    assert told == '/laser (/scan) fell silent at 11.9 s, and came back at 20.0 s.'
    interval = re.search(r'^    ([\d.]+) - ([\d.]+) s.*, (.+) - (.+) UTC: lowest score (\S+), '
                         r'threshold (\S+), score$', out, re.MULTILINE)
    start, end = float(interval[1]), float(interval[2])
    assert 12.0 < start < 13.5 and 19.5 < end < 23.0
    assert interval[3].startswith('1970-01-01 00:50:1')  # 3012 s after the epoch
    assert float(interval[5]) < float(interval[6])
    assert re.search(r'^    1\. /laser /scan std_msgs/String: silent for ', out, re.MULTILINE)


def test_silence_is_abnormal_and_has_no_score(calibrated: str, make_bag: Callable[..., str],
                                              tmp_path, capsys) -> None:
    silent = make_bag('silent.bag', [m for m in robot(3000.0) if not 3012.0 <= m[0] < 3015.0])
    table = tmp_path / 'w.csv'
    assert score.main([silent, '--model', calibrated, *PAPER, '--csv', str(table)]) == 0
    quiet = [row for row in rows_of(table) if row['events'] == '0']
    assert len(quiet) >= 29
    assert {(row['score'], row['abnormal']) for row in quiet} == {('', '1')}


def test_silence_up_to_the_end_of_the_recording_is_seen(calibrated: str,
                                                        make_bag: Callable[..., str],
                                                        capsys) -> None:
    # All components are dead; only the clock, which is no event, goes on.
    bag = make_bag('end.bag', [*robot(3000.0, 10.0), (3015.0, '/clock_server', '/clock')])
    assert score.main([bag, '--model', calibrated, *PAPER]) == 0
    assert '- 15.1 s (to the end of the recording' in capsys.readouterr().out


def test_unknown_events_are_counted_and_named(calibrated: str, make_bag: Callable[..., str],
                                              tmp_path, capsys) -> None:
    bag = make_bag('new.bag', sorted([*robot(3000.0), (3010.0, '/new', '/a'),
                                      (3011.0, '/new', '/a'), (3012.0, '/new', '/b')]))
    table = tmp_path / 'w.csv'
    assert score.main([bag, '--model', calibrated, *PAPER, '--details', '--csv',
                       str(table)]) == 0
    out = capsys.readouterr().out
    assert '    /new /a std_msgs/String: 2\n    /new /b std_msgs/String: 1\n' in out
    assert sum(int(row['unknown']) for row in rows_of(table)) == 3


def test_a_name_that_a_spreadsheet_would_compute_is_a_text(calibrated: str, robot_bags, tmp_path,
                                                           monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ('=1+1.bag', '@a.bag', '+a.bag'):
        shutil.copy(robot_bags[1], name)
        assert score.main([name, '--model', calibrated, *PAPER, '--csv', 'w.csv']) == 0
        assert {row['bag'] for row in rows_of(tmp_path / 'w.csv')} == {f"'{name}"}
        assert calibrate.main(['--model', calibrated, '--normal', name, '--detector', 'paper',
                               '--cutoff', 'fpr=0.1', '-o', 'm', '--csv', 'c.csv']) == 0
        assert {row['bag'] for row in rows_of(tmp_path / 'c.csv')} == {f"'{name}"}


def test_the_options_of_the_alarm_are_heard(calibrated: str, dead_laser: str, capsys) -> None:
    def alarms(*options: str) -> List[Tuple[float, float]]:
        assert score.main([dead_laser, '--model', calibrated, *PAPER, *options]) == 0
        return [(float(a), float(b)) for a, b in
                re.findall(r'^    ([\d.]+) - ([\d.]+) s', capsys.readouterr().out, re.MULTILINE)]

    usual = alarms()
    assert len(usual) == 1
    assert alarms('--settle-time', '25') == []
    late = alarms('--alarm-windows', '30', '--alarm-of', '30')
    assert not late or late[0][0] > usual[0][0] + 1.0
    assert alarms('--hold-time', '6')[0][1] == pytest.approx(usual[0][1] + 4.0, abs=0.11)


def test_the_plot_is_a_picture_that_shows_the_alarm(calibrated: str, dead_laser: str, tmp_path,
                                                    capsys) -> None:
    from matplotlib.image import imread
    plot = tmp_path / 'p.png'
    assert score.main([dead_laser, '--model', calibrated, *PAPER, '--plot', str(plot)]) == 0
    pixels = imread(str(plot))[:, :, :3]
    shade = (np.abs(pixels - (0.965, 0.811, 0.814)).max(axis=2) < 0.02).sum(axis=0)
    # The alarm lasts for a third of the time, nearly from top to bottom.
    assert 0.15 < (shade > pixels.shape[0] / 2).mean() < 0.45
    assert [path.name for path in tmp_path.iterdir() if 'part' in path.name] == []


def test_scripts_see_an_alarm_by_the_exit_code(calibrated: str, dead_laser: str, model_file: str,
                                               make_bag: Callable[..., str], capsys) -> None:
    normal = make_bag('normal.bag', robot(7000.0))
    assert score.main([normal, '--model', calibrated, *PAPER, '--fail']) == 0
    assert score.main([normal, dead_laser, '--model', calibrated, *PAPER, '--fail']) == 3
    assert capsys.readouterr().out.splitlines()[-1] == '2 recordings, 60 s: 1 incident'
    assert score.main([dead_laser, '/gone.bag', '--model', calibrated, *PAPER, '--fail']) == 1
    assert score.main([dead_laser, '--model', model_file, *PAPER, '--fail']) == 1
    assert (f'--fail: {model_file} is not calibrated, so nothing would ever be an alarm'
            in capsys.readouterr().err)


def test_the_report_is_opened_in_a_browser(calibrated: str, dead_laser: str, tmp_path, capsys,
                                           monkeypatch: pytest.MonkeyPatch) -> None:
    report = tmp_path / 'a report.html'
    opened: List[str] = []
    command = [dead_laser, '--model', calibrated, *PAPER, '--open']
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
    assert score.main(command) == 1
    assert '--open: opens the report; name it by --report FILE.html' in capsys.readouterr().err
