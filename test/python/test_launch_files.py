"""The launch files: their arguments are explained, and mean what who launches them means."""
from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import Dict
from xml.etree import ElementTree

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
FILES = sorted((ROOT / 'launch').glob('*.launch'))


def _roslaunch(*words: object, cwd: Path = ROOT) -> subprocess.CompletedProcess[str]:
    return subprocess.run(('roslaunch', *map(str, words)), cwd=cwd, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=60,
                          env={**os.environ, 'PWD': str(cwd)})


def _parameters(cwd: Path, file: str, *arguments: str) -> Dict[str, object]:
    done = _roslaunch('--dump-params', 'self_awareness', file, *arguments, cwd=cwd)
    assert done.returncode == 0, done.stderr
    return yaml.safe_load(done.stdout)


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.name)
def test_every_argument_says_what_it_is(path: Path) -> None:
    arguments = [each for each in ElementTree.parse(str(path)).getroot().findall('arg')
                 if each.get('value') is None]
    assert arguments
    assert [each.get('name') for each in arguments if not each.get('doc')] == []
    done = _roslaunch('--ros-args', 'self_awareness', path.name)
    assert all(str(each.get('name')) in done.stdout for each in arguments)


@pytest.mark.parametrize('given, meant', [
    ('r.model', '{cwd}/r.model'), ('/data/r.model', '/data/r.model'), ('~/r.model', '~/r.model')])
def test_a_relative_path_means_the_folder_of_who_launches(given: str, meant: str,
                                                          tmp_path: Path) -> None:
    meant = meant.format(cwd=tmp_path)
    for file in ('monitor.launch', 'learn.launch'):
        assert _parameters(tmp_path, file, f'model:={given}')['/self_awareness/model'] == meant
    nodelet = _parameters(tmp_path, 'monitor.launch', f'model:={given}', 'standalone:=false')
    assert nodelet['/self_awareness/model'] == meant
    recorder = _parameters(tmp_path, 'record.launch', f'output:={given}')
    assert recorder['/recorder/output'] == meant


def test_logs_and_encoding_of_the_learner_are_relative_to_the_same_folder(tmp_path: Path) -> None:
    done = _roslaunch('--args', '/self_awareness', 'self_awareness', 'learn.launch',
                      'model:=r.model', 'encoding:=e.yaml', cwd=tmp_path)
    words = done.stdout.split()
    assert words[words.index('--logs') + 1].strip("'") == f'{tmp_path}/r.model.logs'
    assert words[words.index('--encoding') + 1].strip("'") == f'{tmp_path}/e.yaml'


@pytest.mark.parametrize('what, node', [('events', '/recorder'), ('event', '/recorder'),
                                        ('bags', '/record'), ('bag', '/record')])
def test_one_or_many_are_the_same(what: str, node: str) -> None:
    done = _roslaunch('--nodes', 'self_awareness', 'record.launch', f'what:={what}')
    assert node in done.stdout.split()


def test_what_is_neither_is_told_in_a_sentence() -> None:
    done = _roslaunch('--nodes', 'self_awareness', 'record.launch', 'what:=logs')
    assert 'what:=logs is neither events nor bags' in done.stdout + done.stderr
