"""Plots as files: their formats, and what they keep of long recordings."""
from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any, Optional

import numpy as np
import pytest

from self_awareness import Roc
from self_awareness.reporting.plots import save_roc, save_scores
from self_awareness.reporting.report.judged import Judged

STARTS = {'png': b'\x89PNG', 'pdf': b'%PDF', 'svg': b'<?xml'}


def scores(windows: int, lowest: float = -2.0, threshold: Optional[float] = -1.0,
           name: str = 'robot.bag') -> Judged:
    values = np.full(windows, -0.3)
    values[windows // 2] = lowest
    values[:3] = np.nan
    alarm = SimpleNamespace(begin=windows * 5 * 10 ** 6, end=windows * 6 * 10 ** 6,
                            culprit='/player')
    verdicts: Any = SimpleNamespace(start=np.arange(windows) * 10 ** 8, score=values,
                                    abnormal=values < -1.0, settling=np.arange(windows) < 50,
                                    alarms=[alarm], suspicions=[])
    by: Any = SimpleNamespace(threshold=threshold, evidence='of it',
                              trained=SimpleNamespace(window=10 ** 8))
    recording: Any = SimpleNamespace(origin=0, part=name)
    return Judged(by, recording, verdicts)


@pytest.mark.parametrize('ending', sorted(STARTS))
def test_the_ending_says_the_format(ending: str, tmp_path: Path) -> None:
    roc = Roc([-0.1, -0.2, -0.3], [-2.0, -0.15])
    curves = [(f'crash:/n{number}', roc) for number in range(9)] + [('all together', roc)]
    paths = [tmp_path / f'{name}.{ending}' for name in ('scores', 'roc')]
    save_scores(str(paths[0]), [scores(600), scores(20, threshold=None)])
    save_roc(str(paths[1]), 'ROC', curves, roc.at(-1.0))
    for path in paths:
        assert path.read_bytes().startswith(STARTS[ending])
    assert sorted(tmp_path.iterdir()) == sorted(paths)


def test_a_plot_names_the_alarm_and_the_few_worst_faults(tmp_path: Path) -> None:
    from matplotlib import rc_context
    rocs = [Roc([-0.1, -0.2, -0.3], [-0.25 - 0.02 * number, -0.15]) for number in range(9)]
    curves = [(f'fault$x^{{{number}', roc) for number, roc in enumerate(rocs)]
    title = r'$HOME/a_$x^{robot.bag'  # with dollars, and no formula
    with rc_context({'svg.fonttype': 'none'}):  # text as text
        save_scores(str(tmp_path / 's.svg'), [scores(600, name=title)])
        save_roc(str(tmp_path / 'r.svg'), title, [*curves, ('all together', rocs[4])],
                 rocs[4].at(-1.0))
    plot, legend = ((tmp_path / name).read_text(encoding='utf-8') for name in ('s.svg', 'r.svg'))
    assert '/player' in plot and title in plot and title in legend
    named = [name for name, _ in curves if f'{name}: AUC' in legend]
    worst = sorted(curves, key=lambda curve: curve[1].auc)[:3]
    assert named == sorted(name for name, _ in worst)
    assert '6 others: AUC' in legend and 'all together: AUC' in legend


def test_an_abnormal_window_of_a_long_recording_is_seen(tmp_path: Path) -> None:
    """Two days of windows of 0.1 s: one in 1.7 million is abnormal."""
    from matplotlib.image import imread
    seen = []
    for lowest in (-0.3, -3.0):
        path = tmp_path / 'p.png'
        save_scores(str(path), [scores(1_728_000, lowest)])
        pixels = imread(str(path))[:, :, :3]
        in_plot = pixels[330:448, 100:1150]  # below the line of the threshold
        seen.append(int((np.abs(in_plot - (0.776, 0.184, 0.208)).max(axis=2) < 0.1).sum()))
    assert seen[0] == 0 and seen[1] > 0
