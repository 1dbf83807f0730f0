"""A bag in which the clock was set forward teaches and judges like one in which it was not."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Iterable, List, Tuple

import numpy as np
import pytest
from conftest import jittery_robot, learned, trained, write_bag

from self_awareness import load
from self_awareness.commands import convert, score

STEP_S = 20.0


def robot(start: float, seed: int, step_s: float = 0.0,
          dies: bool = False) -> List[Tuple[float, str, str]]:
    """Return two minutes of the robot; after one, the clock is set, or the laser dies."""
    def messages() -> Iterable[Tuple[float, str, str]]:
        for stamp, source, topic in jittery_robot(start, 120.0, seed):
            if stamp < start + 60.0:
                yield stamp, source, topic
            elif not (dies and source == '/laser'):
                yield stamp + step_s, source, topic
    return list(messages())


@pytest.fixture(name='folder', scope='module')
def _folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('steps')
    for index in range(3):
        write_bag(folder / f'{index}.bag', robot(1000.0 * (index + 1), index))
    write_bag(folder / 'even.bag', robot(9000.0, 9))
    write_bag(folder / 'set.bag', robot(9000.0, 9, STEP_S))
    write_bag(folder / 'dies.bag', robot(20000.0, 11, dies=True))
    return folder


def normal(folder: Path) -> List[str]:
    return [str(folder / f'{index}.bag') for index in range(3)]


@pytest.fixture(name='three', scope='module')
def _three(folder: Path) -> str:
    """A model of the three recordings."""
    trained(normal(folder), folder / 'three')
    return str(folder / 'three')


def test_a_step_is_not_learned(folder: Path, capsys: pytest.CaptureFixture) -> None:
    bags = normal(folder)
    even = trained([*bags, folder / 'even.bag'], folder / 'even')
    assert 'clock' not in capsys.readouterr().out
    stepped = trained([*bags, folder / 'set.bag'], folder / 'set')
    assert (f'{folder}/set.bag: warning: the clock was set forward by 20.0 s before 80.0 s, '
            'but the nodes went on without a pause. The recording is cut there'
            ) in capsys.readouterr().out
    for one, other in zip(even.calibration.limits, stepped.calibration.limits):
        assert np.isnan(one) and np.isnan(other) or other == pytest.approx(one, rel=0.1)
    of_even, of_set = (load(folder / name).judge(folder / 'dies.bag')[-1]
                       for name in ('even', 'set'))
    assert of_even.culprit == of_set.culprit == '/laser'
    assert of_set.begin == pytest.approx(of_even.begin, abs=1.1e8)


@pytest.mark.parametrize('by_s', [-0.5, -5.0, -3600.0, -3.6e7, 5.0, 3590.0, 3600.0, 3.6e7])
def test_a_step_of_any_size_is_told_and_no_fault(three: str, tmp_path: Path, by_s: float,
                                                 capsys: pytest.CaptureFixture) -> None:
    page = tmp_path / 'p.html'
    bag = write_bag(tmp_path / 'set.bag', robot(9e7, 9, by_s))
    assert score.main([bag, '--model', three, '--json', str(tmp_path / 'j'), '--report',
                       str(page)]) == 0
    way = f'{"forward" if by_s > 0 else "back"} by {abs(by_s):.1f} s before '
    said = capsys.readouterr()
    assert f'the clock was set {way}' in said.out and ', nothing abnormal\n' in said.out
    assert f'set {way}' in said.err
    recording, = json.loads((tmp_path / 'j').read_text())['recordings']
    assert recording['clock_steps'][0]['by_s'] == pytest.approx(by_s, abs=0.1)
    assert f'set {way}' in page.read_text()


def test_the_log_of_a_bag_is_cut_like_the_bag(folder: Path,
                                              capsys: pytest.CaptureFixture) -> None:
    log = folder / 'set.log.bag'
    assert convert.main([str(folder / 'set.bag'), '-o', str(log)]) == 0
    models = [trained([recording], folder / f'of-{recording.name}')
              for recording in (folder / 'set.bag', log)]
    assert learned(models[0], calibrations=True) == learned(models[1], calibrations=True)
    assert capsys.readouterr().out.count('the clock was set forward') == 2
