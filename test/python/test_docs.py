"""What the pages point to is there: files, headings, programs, launch files, public headers."""
from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path
from typing import Dict, Iterator, List, Set
from urllib.parse import unquote

import pytest
from plain_words import JARGON

ROOT = Path(__file__).resolve().parents[2]
METHOD = ROOT / 'docs' / 'method.md'
PAGES = [ROOT / 'README.md', ROOT / 'CONTRIBUTING.md', *sorted((ROOT / 'docs').rglob('*.md'))]

# [text](target), also of an image, with an optional "title".
LINK = re.compile(r'\[[^\]]*\]\(<?([^)\s>]+)>?(?:\s+"[^"]*")?\)')
HEADING = re.compile(r'^#{1,6}\s+(.*?)\s*#*$')


def _name(page: Path) -> str:
    return str(page.relative_to(ROOT))


def _lines(page: Path) -> Iterator[str]:
    """Return the lines of a page that are no code."""
    code = False
    for line in page.read_text(encoding='utf-8').splitlines():
        if line.startswith('```'):
            code = not code
        elif not code:
            yield line


def _links(page: Path) -> List[str]:
    """Return where the links of a page lead."""
    return [target for line in _lines(page)
            for target in LINK.findall(re.sub(r'`[^`]*`', '', line))]


def _anchors(page: Path) -> Set[str]:
    """Return the anchors of a page's headings, as GitHub and GitLab make them."""
    anchors: Set[str] = set()
    for line in _lines(page):
        match = HEADING.match(line)
        if match is None:
            continue
        text = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', match[1])
        anchor = re.sub(r'[^\w\- ]', '', text.lower()).replace(' ', '-')
        number = 0
        while (f'{anchor}-{number}' if number else anchor) in anchors:
            number += 1
        anchors.add(f'{anchor}-{number}' if number else anchor)
    return anchors


def _broken(page: Path) -> List[str]:
    """Return the relative links of a page that lead nowhere."""
    broken = []
    for target in _links(page):
        if re.match(r'[a-z][a-z+.-]*:', target):
            continue
        name, _, anchor = unquote(target).partition('#')
        path = (page.parent / name).resolve() if name else page
        if not path.exists() or (anchor and anchor not in _anchors(path)):
            broken.append(target)
    return broken


def _programs() -> Set[str]:
    """Return what rosrun finds in this package."""
    found = {path.name for folder in ('nodes', 'scripts') for path in (ROOT / folder).iterdir()
             if path.read_bytes().startswith(b'#!/usr/bin/python3')}
    return found | set(re.findall(r'add_executable\((\w+)', (ROOT / 'CMakeLists.txt').read_text()))


@pytest.mark.parametrize('page', PAGES, ids=_name)
def test_links_lead_somewhere(page: Path) -> None:
    assert _broken(page) == []


@pytest.mark.parametrize('page', PAGES, ids=_name)
def test_commands_exist(page: Path) -> None:
    text = page.read_text(encoding='utf-8')
    assert set(re.findall(r'rosrun\s+self_awareness\s+(\w+)', text)) <= _programs()
    for name in re.findall(r'roslaunch\s+self_awareness\s+([\w.]+)', text):
        assert (ROOT / 'launch' / name).is_file(), name
    for name in re.findall(r'(?<![\w/.])scripts/(\w+(?:\.sh)?)', text):
        assert (ROOT / 'scripts' / name).is_file(), name


def test_every_page_is_linked_to() -> None:
    linked = {(page.parent / target.partition('#')[0]).resolve()
              for page in PAGES for target in _links(page)}
    assert [str(page) for page in PAGES[1:] if page not in linked] == []


def _numbers_of_the_method() -> Dict[str, float]:
    """Return the numbers of the evidence detector with their values, by name."""
    header = (ROOT / 'include/self_awareness/core/evidence/tuning.h').read_text(encoding='utf-8')
    return {name: float(value)
            for name, value in re.findall(r'^  double (\w+) = ([\d.]+);$', header, re.MULTILINE)}


def test_the_method_names_every_number_once() -> None:
    numbers = _numbers_of_the_method()
    text = METHOD.read_text(encoding='utf-8')
    found = {name: [float(value) for value in
                    re.findall(rf'(?<!\w){name}`? = (\d+(?:\.\d+)?)', text)] for name in numbers}
    assert found == {name: [value] for name, value in numbers.items()}
    named = re.findall(r'`([a-z]+(?:_[a-z]+)*)` = [\d.]', text)
    assert {name for name in named if len(name) > 1} - {'s_b'} <= set(numbers), 'it is gone'


def test_the_method_is_short() -> None:
    text = METHOD.read_text(encoding='utf-8')
    lines = text.splitlines()
    assert len(lines) <= 220 and len(text.split()) <= 3500
    assert [line for line in lines if len(line) > 120] == []


def test_the_search_finds_broken_links(tmp_path: Path) -> None:
    (tmp_path / 'there.md').write_text(
        '# One, `two`\n\n```\n# No heading\n```\n## Again\n## Again\n')
    page = tmp_path / 'page.md'
    page.write_text(
        '# Here\n[a](there.md) [b](there.md#one-two) [c](there.md#again-1) [d](#here)\n'
        '![e](gone.png) [f](there.md#no-heading) [g](#there) [h](https://a.example/b)\n'
        '`[i](code.md)`\n```\n[j](code.md)\n```\n')
    assert _broken(page) == ['gone.png', 'there.md#no-heading', '#there']


def test_topics_services_and_parameters_of_the_nodes_exist() -> None:
    """What a page calls `~name`, a node of the package advertises, or reads as a parameter."""
    code = ''.join(path.read_text(encoding='utf-8') for suffix in ('*.cpp', '*.py')
                   for path in (ROOT / 'src').rglob(suffix))
    there = set(re.findall(r'advertise(?:Service|<[^>]*>)\(\s*"([\w/]+)"', code))
    there |= set(re.findall(r'[rR]eader\.\w+(?:<[^>]*>)?\(\s*"([\w/]+)"', code))
    there |= set(re.findall(r"'~([\w/]+)'", code))
    named = {page: re.findall(r'`~([\w/]+)`', page.read_text(encoding='utf-8')) for page in PAGES}
    assert {'clear', 'status', 'alarm_of'} <= there and any(named.values())
    assert {_name(page): sorted(set(names) - there) for page, names in named.items()
            if set(names) - there} == {}


def test_the_readme_begins_with_what_it_does() -> None:
    """A picture, what is found in plain words, and the two commands; no word of the method."""
    text = (ROOT / 'README.md').read_text(encoding='utf-8')
    first = text[:text.index('scripts/test.sh')]
    assert '![' in first and 'scripts/demo.sh' in first
    assert re.findall(r'\b(?:events?|windows?|papers?)\b', first) == []


def test_the_pages_are_few_and_short() -> None:
    """Those that people write: of the evaluation and of reliability, programs write one each."""
    assert len((ROOT / 'README.md').read_text(encoding='utf-8').split()) <= 1300, 'ten minutes'
    written = [page for page in PAGES if _name(page) not in (
        'docs/evaluation/research.md', 'docs/reliability/README.md', 'CONTRIBUTING.md')]
    assert len(written) <= 14
    words = re.findall(r'\S*\w\S*', '\n'.join(page.read_text('utf-8') for page in written))
    assert len(words) <= 28000


def _sentences(page: Path) -> Set[str]:
    """Return the sentences of a page that have seven words or more, without their marks."""
    text = re.sub(r'```.*?```', '', page.read_text(encoding='utf-8'), flags=re.DOTALL)
    text = re.sub(r'[|*`\s]+', ' ', re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', text))
    return {each.lower() for each in re.split(r'(?<=[.:;]) ', text) if len(each.split()) >= 7}


def test_no_sentence_is_told_on_two_pages() -> None:
    written = [page for page in PAGES if page.name != 'research.md']
    told = [sentence for page in written for sentence in _sentences(page)]
    assert len(told) > 1000
    assert sorted({each for each in told if told.count(each) > 1}) == []


OF_DEVELOPERS = ('docs/method.md', 'docs/developers.md',
                 'docs/performance.md', 'docs/evaluation/')
# Sentences that had to be read twice.
TWICE = ('Models of before', 'the file of before', 'models of before', 'by it the model knows',
         'what is none becomes', 'and not the way', 'as they were recorded',
         'are left out by [the encoding]')


@pytest.mark.parametrize('page', PAGES, ids=_name)
def test_pages_are_in_plain_words(page: Path) -> None:
    text = page.read_text(encoding='utf-8')
    assert [each for each in TWICE if each in text] == []
    if not _name(page).startswith(OF_DEVELOPERS):
        prose = re.sub(r'```.*?```|`[^`\n]*`', '', text, flags=re.DOTALL)
        assert JARGON.findall(prose) == []


API_DOCS = 'scripts/api_docs.sh'
# Others warn of other things, or know other settings.
VERSION = '1.9.4'


def _run(argument: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run((API_DOCS, argument), cwd=ROOT, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def test_they_are_about_the_headers_that_the_page_names() -> None:
    page = (ROOT / 'docs' / 'library.md').read_text(encoding='utf-8')
    found = _run('--headers').stdout.split()
    assert set(found) == {f'include/self_awareness/{name}'
                          for name in re.findall(r'`(core/[^`]*\.h)`', page)}
    assert len(found) >= 9
    assert [name for name in found if not (ROOT / name).is_file()] == []


def test_everything_public_in_these_headers_has_a_comment(tmp_path: Path) -> None:
    if shutil.which('doxygen') is None:
        pytest.skip('doxygen is not installed')
    version = subprocess.run(('doxygen', '--version'), stdout=subprocess.PIPE, text=True,
                             check=True).stdout.strip()
    if not version.startswith(VERSION):
        pytest.skip(f'the comments are checked by doxygen {VERSION}, this is {version}')
    done = _run(str(tmp_path / 'api'))
    assert done.returncode == 0, done.stdout
    for name in ('classself__awareness_1_1core_1_1Detector.html',
                 'structself__awareness_1_1core_1_1Suspect.html', 'index.html'):
        assert (tmp_path / 'api' / name).is_file(), name
