"""The core is a C++ library that needs neither ROS nor Python (docs/library.md)."""
from __future__ import annotations

import re
from pathlib import Path

import pytest

from conftest import (ALARM, EXAMPLE, LIBRARY_PAGE, ROOT, configure_project_of_library_page,
                      cpp_of_library_page, run, run_project_of_library_page)

INCLUDE = ROOT / 'include'
HEADERS = sorted(str(path.relative_to(INCLUDE))
                 for path in (INCLUDE / 'self_awareness' / 'core').rglob('*.h'))


COMMANDS = re.findall(r'```\n(cmake .*?)```', LIBRARY_PAGE, re.DOTALL)[0].splitlines()
"""Of the page: they build the core by itself, test it and install it."""

QUICK = ('-DCMAKE_BUILD_TYPE=None', '-DCMAKE_CXX_FLAGS=-O0 -Werror')
"""Compiles in a third of the time of the default."""


@pytest.fixture(scope='module')
def build(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The core and its example, built as a CMake project.

    Its tests are the package's core_test; scripts/test_core_aarch64.sh builds them like this, too.
    """
    folder = tmp_path_factory.mktemp('core')
    for name in ('examples', 'include', 'src', 'test'):  # the build folder is beside them
        (folder / name).symlink_to(ROOT / name)
    configure, compile_all, _, _ = COMMANDS
    run(*configure.replace('/where/you/like', str(folder / 'installed')).split(), *QUICK,
        cwd=folder)
    run(*compile_all.split(), '-j2', '--target', 'self_awareness_core', 'train_and_judge',
        cwd=folder)
    return folder / 'build'


def test_its_example_passes(build: Path) -> None:
    test = COMMANDS[2]
    assert test.startswith('(cd build && ctest)')
    printed = run('ctest', '--output-on-failure', '-R', 'train_and_judge', cwd=build)
    assert '100% tests passed, 0 tests failed out of 1' in printed


def test_a_project_finds_it_installed(build: Path, tmp_path: Path) -> None:
    run(*COMMANDS[3].split(), cwd=build.parent)
    printed = run_project_of_library_page(
        tmp_path, 'find_package(self_awareness_core',
        f'-DCMAKE_PREFIX_PATH={build.parent / "installed"}')
    assert ALARM.fullmatch(printed), printed
    assert f'```\n{printed}```' in LIBRARY_PAGE


def test_a_project_builds_it_as_a_part_of_itself(tmp_path: Path) -> None:
    """Of the core, one source: that all of them can be compiled and linked is shown above."""
    (tmp_path / 'self_awareness').symlink_to(ROOT)
    configure_project_of_library_page(tmp_path, 'add_subdirectory(', *QUICK)
    run('make', '-C', tmp_path / 'build', f'{EXAMPLE.name}.o')
    core, = (path.parent for path in (tmp_path / 'build').rglob('Makefile')
             if 'learn.cpp.o:' in path.read_text(encoding='utf-8'))
    run('make', '-C', core, 'learn.cpp.o')


@pytest.mark.parametrize('header', HEADERS)
def test_a_public_header_needs_no_other_before_it_and_no_private_one(header: str,
                                                                     tmp_path: Path) -> None:
    source = tmp_path / 'only.cpp'
    source.write_text(f'#include "{header}"\n', encoding='utf-8')
    run('g++', '-std=c++17', '-Wall', '-Wextra', '-Wpedantic', '-Werror', '-fsyntax-only',
        '-I', INCLUDE, source)


def test_the_blocks_of_the_page_are_the_example() -> None:
    _, _, code = EXAMPLE.read_text(encoding='utf-8').partition('\n\n')
    assert cpp_of_library_page().split('\n') == code.split('\n')
