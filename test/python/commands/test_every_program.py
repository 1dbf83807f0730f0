"""Each program says what it is and which version, at once and without a robot."""
from __future__ import annotations

import os
import subprocess
from pathlib import Path
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


def _said(program: str, option: str) -> str:
    nobody = {**os.environ, 'ROS_MASTER_URI': 'http://127.0.0.1:1'}
    done = subprocess.run((executable(program), option), env=nobody, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, '')
    return done.stdout


@pytest.mark.parametrize('program', PROGRAMS)
def test_version(program: str) -> None:
    version = ElementTree.parse(str(ROOT / 'package.xml')).findtext('version')
    assert _said(program, '--version') == f'self_awareness {version}\n'


@pytest.mark.parametrize('program', PROGRAMS)
def test_help(program: str) -> None:
    """It begins with the usage, and no line is torn: one that ends early has no room for more."""
    lines = _said(program, '--help').splitlines()
    assert lines[0].startswith('usage: ') and program in lines[0]
    assert max(map(len, lines)) < 100


@pytest.mark.parametrize('program', [each for each in PROGRAMS if each not in OF_DEVELOPERS])
def test_help_is_in_plain_words(program: str) -> None:
    assert JARGON.findall(_said(program, '--help')) == []
