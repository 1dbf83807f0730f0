"""Each program says what it is and which version, at once and without a robot."""
from __future__ import annotations

import contextlib
import importlib
import io
import os
import re
import subprocess
from pathlib import Path
from typing import List, Tuple
from xml.etree import ElementTree

import pytest

from self_awareness.learning.programs import executable

from plain_words import JARGON

ROOT = Path(__file__).resolve().parents[3]
NODES = ('record_events', 'self_awareness_node')
PROGRAMS = sorted(str(path.name) for folder in ('nodes', 'scripts')
                  for path in (ROOT / folder).iterdir()
                  if path.read_bytes().startswith(b'#!/usr/bin/python3')) + list(NODES)
OF_DEVELOPERS = ('benchmark', 'evaluate')


def _started(program: str, option: str) -> str:
    nobody = {**os.environ, 'ROS_MASTER_URI': 'http://127.0.0.1:1'}
    done = subprocess.run((executable(program), option), env=nobody, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, '')
    return done.stdout


def _help(program: str) -> str:
    """Return what a program says; one in Python is not started anew for that."""
    if program in NODES:
        return _started(program, '--help')
    name = program.partition('.')[0]
    package = 'self_awareness_evaluation' if program == 'evaluate' else 'self_awareness.commands'
    words = [program, '--help'] if program == 'component' else ['--help']
    with contextlib.redirect_stdout(io.StringIO()) as said:
        assert importlib.import_module(f'{package}.{name}').main(words) == 0
    return said.getvalue()


@pytest.mark.parametrize('program', PROGRAMS)
def test_version(program: str) -> None:
    version = ElementTree.parse(str(ROOT / 'package.xml')).findtext('version')
    assert _started(program, '--version') == f'self_awareness {version}\n'


@pytest.mark.parametrize('program', PROGRAMS)
def test_help(program: str, monkeypatch) -> None:
    """It begins with the usage, is in plain words, and no line of prose is short for no reason."""
    monkeypatch.setenv('COLUMNS', '80')
    text = _help(program)
    lines = text.splitlines()
    assert lines[0].startswith('usage: ') and program in lines[0]
    assert max(map(len, lines)) < 100
    assert torn_lines(lines) == []
    assert program in OF_DEVELOPERS or JARGON.findall(text) == []


JUDGING = ('--detector', '--csv', '--settle-time')


@pytest.mark.parametrize('program, options', [
    ('train', ('--detector', '--bin', '--window', '--horizon')),
    ('calibrate', (*JUDGING, '--cutoff', '--roc')), ('score', JUDGING)])
def test_options_of_researchers_have_a_heading_of_their_own(
        program: str, options: Tuple[str, ...]) -> None:
    everybody, researchers = _help(program).split('\nfor researchers:\n')
    _, _, everybody = everybody.partition('\n\n')  # without the usage
    shown = re.findall(r'^  (--[a-z-]+)', researchers, re.MULTILINE)
    assert sorted(shown) == sorted(options)
    assert not set(shown) & set(re.findall(r'--[a-z-]+', everybody))


def torn_lines(lines: List[str]) -> List[str]:
    """Return the lines of prose that end within a sentence, though the next word had room."""
    longest = max((len(line) for line in lines if line[:1].isalnum()), default=0)
    return [line for line, after in zip(lines, lines[1:])
            if line[:1].isalnum() and after[:1].isalnum() and line[-1] not in '.:'
            and len(line) + 1 + len(after.split()[0]) <= longest - 8]
