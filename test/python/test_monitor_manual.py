"""The comment of the class Monitor is its manual: complete, and as the code and the configuration.

live_rules_test.py checks with a running monitor that the defaults of the configuration are those
of the code.
"""
from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Dict, List, NamedTuple

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
TYPES = {'string': str, 'double': float, 'int': int, 'bool': bool, 'list': list}
NOT_IN_CONFIGURATION = {'model'}
"""Has no default: the launch file sets it."""
_CONSTANTS = {'kHour': '3600', 'kDay': '86400'}
"""Of the code, in ranges."""


class Entry(NamedTuple):
    """What the manual says of one parameter."""

    type: str
    unit: str
    default: str
    range: str


class Reading(NamedTuple):
    """How the code reads one parameter."""

    how: str
    arguments: str


def _manual() -> str:
    header = (ROOT / 'src/monitor/monitor.h').read_text()
    comment = re.search(r'((?:///.*\n)+)class Monitor : public', header)
    assert comment is not None
    return re.sub(r'\s*\n///\s*', ' ', comment[1])


def _entries(manual: str) -> Dict[str, Entry]:
    found = re.findall(r'- `~([\w/]+)` \((\w+)(?:, ([^;)]+))?; default: ([^;)]+)(?:; ([^)]+))?\):',
                       manual)
    assert len({name for name, *_ in found}) == len(found)
    return {name: Entry(*fields) for name, *fields in found}


def _readings() -> Dict[str, Reading]:
    code = (ROOT / 'src/monitor/parameters.cpp').read_text()
    code = code[code.index('MonitorParameters::load'):]
    found = re.findall(r'reader\.(\w+)(?:<[^>]*>)?\(\s*"([\w/]+)"(.*?)\);', code, re.DOTALL)
    return {name: Reading(how, arguments) for how, name, arguments in found}


def _configuration() -> Dict[str, Any]:
    """Return the defaults by their full names: ~recorder/after is in the section recorder."""
    found: Dict[str, Any] = {}
    for name, value in yaml.safe_load(
            (ROOT / 'config/self_awareness.yaml').read_text()).items():
        if isinstance(value, dict):
            found.update({f'{name}/{key}': each for key, each in value.items()})
        else:
            found[name] = value
    return found


def test_manual_and_configuration_have_every_parameter_that_is_read() -> None:
    assert set(_entries(_manual())) == set(_readings())
    assert set(_configuration()) == set(_readings()) - NOT_IN_CONFIGURATION


@pytest.mark.parametrize('name', sorted(_configuration()))
def test_types_and_defaults_are_those_of_the_configuration(name: str) -> None:
    entry = _entries(_manual())[name]
    default = yaml.safe_load(entry.default)
    assert default == _configuration()[name]
    expected = TYPES[entry.type]
    assert {type(default), type(_configuration()[name])} == {expected}


@pytest.mark.parametrize('name', sorted(_readings()))
def test_ranges_are_those_of_the_code(name: str) -> None:
    entry, reading = _entries(_manual())[name], _readings()[name]
    if reading.how == 'choice':
        choices = re.findall(r'\{"(\w+)",', reading.arguments)
        assert len(choices) > 1
        assert re.split(', | or ', entry.range) == choices
    elif reading.how in ('seconds', 'wholeNumber'):
        limits = re.search(r'\{(\S+), (\S+)\}\)*$', reading.arguments)
        assert limits is not None
        least, most = (_CONSTANTS.get(limit, limit) for limit in limits.groups())
        assert entry.range.replace('`', '').replace('~', '') == f'{least} to {most}'
        assert (entry.unit == 's') == (reading.how == 'seconds')
    else:
        assert reading.how in ('text', 'flag', 'names')
        assert entry.range == ''


def _advertised(call: str) -> List[str]:
    code = ''.join(path.read_text() for path in sorted((ROOT / 'src/monitor').glob('*.cpp')))
    return re.findall(rf'private_node_handle_?\s*\.{call}\(\s*"(\w+)"', code)


def test_manual_and_page_list_topics_and_services() -> None:
    topics, services = _advertised('advertise<[^>]*>'), _advertised('advertiseService')
    assert topics and services
    listed = set(re.findall(r'- `~(\w+)` \([\w/]+\):', _manual()))
    assert listed == {*topics, *services}
    assert '- `/diagnostics` (diagnostic_msgs/DiagnosticArray):' in _manual()
    page = (ROOT / 'docs' / 'monitor.md').read_text(encoding='utf-8')
    named = re.findall(r'^\| services \((.*?)\) \|', page, re.MULTILINE)
    assert set(re.findall(r'`~(\w+)`', ' '.join(named))) == set(services)
