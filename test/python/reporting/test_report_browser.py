"""The report in a real browser: it draws, it zooms, and it asks nobody for anything."""
from __future__ import annotations

import base64
import shutil
import subprocess
from pathlib import Path
from typing import Iterator, List

import pytest
from browser import Browser, opened
from conftest import write_bag
from judged_recordings import with_graph, without_laser

from self_awareness.commands import score


@pytest.fixture(scope='module')
def report(evidence_model: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A report of a laser that dies at 12 s, and of another recording where it does."""
    folder = tmp_path_factory.mktemp('report')
    bags = [write_bag(folder / f'{start}.bag', without_laser(start, 60.0))
            for start in (3000.0, 5000.0)]
    model = with_graph(evidence_model, folder / 'm')
    assert score.main([*bags, '--model', model, '--report', str(folder / 'r.html')]) == 0
    return folder / 'r.html'


def _range(browser: Browser, section: int = 0) -> List[float]:
    return browser.run('return document.querySelectorAll(".over-time")'
                       f'[{section}].layout.xaxis.range.map(Number)')


DRAWN = 'return document.querySelectorAll(".over-time .main-svg").length >= 2'
ALARM = 'document.querySelector("details.incident.alarm")'


@pytest.fixture
def browser(report: Path) -> Iterator[Browser]:
    """The report, drawn; no error may come."""
    with opened(report) as shown:
        shown.wait(DRAWN)
        yield shown
        assert shown.errors() == []


def test_it_opens_without_error_and_without_network(browser: Browser, report: Path) -> None:
    assert browser.requests() == [report.as_uri()]
    assert browser.driver.title.startswith(
        '/laser (/scan) fell silent at 12.0 s, and came back at 20.0 s.')
    text = browser.run(f'return {ALARM}.querySelector("summary").textContent')
    assert 'alarm' in text and '/laser' in text and '12.' in text
    lanes = browser.run('return document.querySelector(".over-time").textContent')
    assert '/laser' in lanes and '/slam' in lanes
    # What the summary is about is open, and drawn.
    browser.wait(f'return {ALARM}.querySelectorAll(".figure .main-svg").length >= 4')


def test_a_click_on_an_alarm_zooms_to_it(browser: Browser) -> None:
    before = _range(browser)
    assert before[1] - before[0] == pytest.approx(60.0, abs=0.3)
    browser.run(f'{ALARM}.open = false; {ALARM}.querySelector("summary").click()')
    browser.wait('return document.querySelector(".over-time").layout.xaxis.range[1] < 40')
    start, end = _range(browser)
    assert 5.0 < start < 12.0 and 20.0 < end < 35.0
    assert browser.run(f'return {ALARM}.open')
    # The other recording has a plot of its own.
    assert _range(browser, 1) == pytest.approx(before, abs=0.3)
    browser.run('document.querySelector("[data-whole]").click()')
    browser.wait('return document.querySelector(".over-time").layout.xaxis.range[1] > 50')
    assert _range(browser) == before


def test_an_alarm_in_the_plot_can_be_clicked(browser: Browser) -> None:
    browser.run(f'{ALARM}.open = false')
    x, y = browser.run('''
        const plot = document.querySelector(".over-time"), box = plot.getBoundingClientRect();
        const axis = plot._fullLayout.xaxis, strip = plot._fullLayout.yaxis;
        return [box.left + axis._offset + axis.l2p(16),
                box.top + strip._offset + strip._length / 2];''')
    for kind in ('mouseMoved', 'mousePressed', 'mouseReleased'):
        browser.driver.execute_cdp_cmd('Input.dispatchMouseEvent', {
            'type': kind, 'x': x, 'y': y, 'button': 'left', 'clickCount': 1})
    browser.wait(f'return {ALARM}.open')
    browser.wait('return document.querySelector(".over-time").layout.xaxis.range[1] < 40')


def test_a_phone_shows_it_without_scrolling_sideways(report: Path) -> None:
    with opened(report, 390, 844) as browser:
        browser.wait(DRAWN)
        assert browser.run('return document.documentElement.scrollWidth') <= 390
        assert browser.run('return document.querySelector(".over-time").layout.dragmode') is False
        assert browser.errors() == []


def test_it_follows_the_theme(browser: Browser) -> None:
    colours = []
    for theme in ('light', 'dark'):
        browser.driver.execute_cdp_cmd('Emulation.setEmulatedMedia', {
            'features': [{'name': 'prefers-color-scheme', 'value': theme}]})
        browser.wait('return document.querySelector(".over-time").layout.font.color === '
                     f'"{"#c3cad5" if theme == "dark" else "#3a424d"}"')
        colours.append(browser.run('return getComputedStyle(document.body).backgroundColor'))
    assert colours[0] != colours[1]


def test_it_can_be_printed(browser: Browser, tmp_path: Path) -> None:
    if shutil.which('pdftotext') is None:
        pytest.skip('pdftotext (poppler-utils) is not installed')
    done = browser.driver.execute_cdp_cmd('Page.printToPDF', {})
    page = tmp_path / 'r.pdf'
    page.write_bytes(base64.b64decode(done['data']))
    text = subprocess.run(['pdftotext', str(page), '-'], stdout=subprocess.PIPE, text=True,
                          check=True).stdout
    assert '/laser (/scan) fell silent at 12.0 s, and came back at 20.0 s.' in text
    assert 'gaps between two /laser /scan' in text and 'now: ' in text
