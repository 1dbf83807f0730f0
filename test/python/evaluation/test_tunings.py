"""`evaluate --set` and `--without`: what is changed, and what is refused in words."""
from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, List

import pytest

from self_awareness import Tuning
from self_awareness_evaluation import evaluate, tunings

# Whatever the method has: one that no value switches off, one that is, and two channels.
PLAIN = next(number for number in Tuning.numbers() if number.off is None)
RULE = next(number for number in Tuning.numbers() if number.off is not None)
CHANNELS = Tuning.channels()[:2]


def asked(*arguments: str) -> Tuning:
    parser = argparse.ArgumentParser()
    tunings.add(parser)
    return tunings.tuning_of(tunings.of(parser.parse_args(arguments)))


def test_numbers_are_set_and_channels_left_out() -> None:
    assert asked() == Tuning()
    tuning = asked('--set', f'{PLAIN.name}={PLAIN.most}', '--without', CHANNELS[0],
                   '--set', f'{RULE.name}=off', '--without', CHANNELS[1])
    assert (tuning.get(PLAIN.name), tuning.get(RULE.name)) == (PLAIN.most, RULE.off)
    assert sorted(tuning.without) == sorted(CHANNELS)


@pytest.mark.parametrize('wrong, told', [
    (['--set', 'luck=3'], ['luck']), (['--set', PLAIN.name], ['NAME=VALUE', PLAIN.name]),
    (['--set', f'{PLAIN.name}=much'], [PLAIN.name, 'much']),
    (['--set', f'{PLAIN.name}={PLAIN.least - 1.0:g}'], [PLAIN.name, f'{PLAIN.least:g}']),
    (['--set', f'{PLAIN.name}=off'], [PLAIN.name, 'off']),
    (['--set', f'{PLAIN.name}=nan'], [PLAIN.name, 'nan']),
    (['--without', 'smell'], ['smell', CHANNELS[0]])])
def test_wrong_changes_are_refused(wrong: List[str], told: List[str], tmp_path: Path,
                                   capsys: Any) -> None:
    for part in (['simulated'], ['families'], ['recordings', '--data', str(tmp_path)]):
        assert evaluate.main([*part, '-o', str(tmp_path / 'out'), *wrong]) == 2
        error = capsys.readouterr().err.splitlines()[-1]
        assert all(word in error for word in told), error
        assert not (tmp_path / 'out').exists()


@pytest.mark.parametrize('part', ['simulated', 'families'])
def test_a_change_that_no_system_has_is_refused(part: str, tmp_path: Path, capsys: Any) -> None:
    assert evaluate.main([part, '--systems', 'frequency', '--without', CHANNELS[0],
                          '-o', str(tmp_path / 'out')]) == 1
    assert '--systems' in capsys.readouterr().err
    assert not (tmp_path / 'out').exists()
