"""What began before an excuse stays what it was, by the cases of ../shared/cases."""
from __future__ import annotations

from pathlib import Path


def test_a_stall_takes_no_death_away(cases, scored, tmp_path: Path) -> None:
    recording, = scored(str(cases.make('01_stall_hides_a_death', tmp_path) / 'crash.bag'))
    assert recording['incidents'][0]['headline'] == '/lidar and /amcl stopped sending at 50.0 s.'
    alarm, = [each for each in recording['alarms'] if each['level'] == 'ERROR']
    assert (alarm['kind'], alarm['culprit'], alarm['over']) == ('died', '/lidar', False)
