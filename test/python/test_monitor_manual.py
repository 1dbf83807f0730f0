"""The page of the monitor is its manual: complete, and as the code and the configuration.

live_rules_test.py checks with a running monitor that the defaults of the configuration are those
of the code.
"""
from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Dict, List, Set

import yaml

ROOT = Path(__file__).resolve().parents[2]
NOT_IN_CONFIGURATION = {'model'}
"""Has no default: the launch file sets it."""


def _page() -> str:
    return (ROOT / 'docs' / 'monitor.md').read_text(encoding='utf-8')


def _manual() -> str:
    header = (ROOT / 'src/monitor/monitor.h').read_text()
    comment = re.search(r'((?:///.*\n)+)class Monitor : public', header)
    assert comment is not None
    return re.sub(r'\s*\n///\s*', ' ', comment[1])


def _parameters_of_page() -> Dict[str, Any]:
    """Return the defaults by the full names: of `~recorder/files`, `disk`, one row has both."""
    table = _page().partition('| parameter | default | |\n')[2].partition('\n\n')[0]
    found: Dict[str, Any] = {}
    for row in table.splitlines()[1:]:
        names, defaults = (cell.replace('`', '').strip() for cell in row.split('|')[1:3])
        first, *others = names.split(', ')
        folder = first[:first.rfind('/') + 1]
        full = [(name if name.startswith('~') else folder + name)[1:] for name in [first, *others]]
        values = [defaults] if len(full) == 1 else defaults.split(', ')
        assert len(values) == len(full), row
        found.update(zip(full, map(yaml.safe_load, values)))
    return found


def _read() -> Set[str]:
    code = (ROOT / 'src/monitor/parameters.cpp').read_text()
    code = code[code.index('MonitorParameters::load'):]
    return set(re.findall(r'reader\.\w+(?:<[^>]*>)?\(\s*"([\w/]+)"', code))


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


def test_page_and_configuration_have_every_parameter_that_is_read() -> None:
    assert set(_parameters_of_page()) == _read()
    assert set(_configuration()) == _read() - NOT_IN_CONFIGURATION


def test_defaults_of_the_page_are_those_of_the_configuration() -> None:
    page, configuration = _parameters_of_page(), _configuration()
    assert {name: page[name] for name in configuration} == configuration
    assert [type(page[name]) for name in configuration] == [
        type(value) for value in configuration.values()]


def _advertised(call: str) -> List[str]:
    code = ''.join(path.read_text() for path in sorted((ROOT / 'src/monitor').glob('*.cpp')))
    return re.findall(rf'private_node_handle_?\s*\.{call}\(\s*"(\w+)"', code)


def test_manual_and_page_list_topics_and_services() -> None:
    topics, services = _advertised('advertise<[^>]*>'), _advertised('advertiseService')
    assert topics and services
    listed = set(re.findall(r'- `~(\w+)` \([\w/]+\):', _manual()))
    assert listed == {*topics, *services}
    assert '- `/diagnostics` (diagnostic_msgs/DiagnosticArray):' in _manual()
    named = re.findall(r'^\| services \((.*?)\) \|', _page(), re.MULTILINE)
    assert set(re.findall(r'`~(\w+)`', ' '.join(named))) == set(services)
