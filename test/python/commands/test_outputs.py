"""Results replace what they are meant to replace and nothing else, also where the disk is full."""
from __future__ import annotations

import os
import resource
import shutil
import stat
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Tuple

import pytest
from conftest import error_of

from self_awareness.commands import calibrate, convert, diff, merge, score, train
from self_awareness.output_files import (EVENT_LOG, MODEL, PAGE, PICTURE, RESULT_BAG, TABLE,
                                         VALUES, check_outputs)

PROGRAMS = {'train': train, 'calibrate': calibrate, 'merge': merge, 'score': score,
            'convert': convert, 'diff': diff}

WRITERS = {
    'train': ('train', ['{recording}', '-o', '{output}']),
    'calibrate': ('calibrate', ['--model', '{model}', '--normal', '{other}', '-o', '{output}']),
    'calibrate --csv': ('calibrate', ['--model', '{model}', '--normal', '{other}', '-o',
                                      '{spare}', '--csv', '{output}']),
    'calibrate --roc': ('calibrate', ['--model', '{model}', '--normal', '{other}', '--inject',
                                      'starve', '-o', '{spare}', '--roc', '{output}.png']),
    'merge': ('merge', ['{model}', '{second}', '-o', '{output}']),
    'convert': ('convert', ['{recording}', '-o', '{output}']),
    'score --csv': ('score', ['{other}', '--model', '{model}', '--csv', '{output}']),
    'score --json': ('score', ['{other}', '--model', '{model}', '--json', '{output}']),
    'score --plot': ('score', ['{other}', '--model', '{model}', '--plot', '{output}.png']),
    'score --report': ('score', ['{other}', '--model', '{model}', '--report', '{output}.html']),
    'score --result-bag': ('score', ['{other}', '--model', '{model}', '--result-bag',
                                     '{output}']),
    'diff --html': ('diff', ['{model}', '{other}', '--html', '{output}.html']),
}
"""Every way to write a file: the program and its arguments."""

KINDS = dict(zip(WRITERS, (MODEL, MODEL, TABLE, PICTURE, MODEL, EVENT_LOG, TABLE, VALUES, PICTURE,
                           PAGE, RESULT_BAG, PAGE)))


def line_of(way: str, output: Path, files: Dict[str, str]) -> Tuple[Any, List[str], Path]:
    """Return the program, its arguments, and the file that it is to write."""
    name, arguments = WRITERS[way]
    filled = [each.format(output=output, **files) for each in arguments]
    written = next(each for each in filled if each.startswith(str(output)))
    return PROGRAMS[name], filled, Path(written)


@pytest.fixture(scope='module')
def files(long_bags: Tuple[str, str], evidence_model: str,
          tmp_path_factory: pytest.TempPathFactory) -> Dict[str, str]:
    """What the ways to write need, by the names in their arguments."""
    folder = tmp_path_factory.mktemp('files')
    second = str(folder / 'second.model')
    assert train.main([long_bags[1], '--detector', 'both', '-o', second]) == 0
    return {'recording': long_bags[0], 'other': long_bags[1], 'model': evidence_model,
            'second': second, 'spare': str(folder / 'spare.model')}


@pytest.fixture(scope='module')
def written(files: Dict[str, str], tmp_path_factory: pytest.TempPathFactory) -> Dict[str, bytes]:
    """What each way writes."""
    folder = tmp_path_factory.mktemp('written')
    contents = {}
    for index, way in enumerate(WRITERS):
        program, arguments, path = line_of(way, folder / str(index), files)
        assert program.main(arguments) == 0
        contents[way] = path.read_bytes()
    return contents


@pytest.mark.parametrize('way', WRITERS)
def test_a_file_of_another_kind_is_not_replaced(way: str, files: Dict[str, str],
                                                tmp_path: Path) -> None:
    program, arguments, path = line_of(way, tmp_path / 'out', files)
    for content in (Path(files['recording']).read_bytes(), b'notes, by hand\n'):
        path.write_bytes(content)
        assert (f'{path}: is there already, and no {KINDS[way].name} that'
                in error_of(program, arguments))
        assert path.read_bytes() == content
    assert os.listdir(tmp_path) == [path.name]


def test_what_is_written_is_of_its_kind_and_of_no_other(written: Dict[str, bytes],
                                                        tmp_path: Path) -> None:
    for way, content in written.items():
        (tmp_path / 'f').write_bytes(content)
        assert {kind for kind in KINDS.values()
                if kind.is_one(str(tmp_path / 'f'))} == {KINDS[way]}, way


def test_what_cannot_be_written_is_told_before_the_work(tmp_path: Path, monkeypatch) -> None:
    def error(*paths: Path) -> str:
        with pytest.raises(ValueError) as caught:
            check_outputs([(str(path), TABLE) for path in paths], [])
        return str(caught.value)

    assert 'is a folder; name a file in it' in error(tmp_path)
    assert f'there is no folder {tmp_path}/no; create it' in error(tmp_path / 'no' / 'where')
    assert 'is named for another result, too' in error(tmp_path / 'a', tmp_path / '.' / 'a')
    path = tmp_path / 'table'
    path.write_text('a,b\n1,2\n')
    allowed = os.access  # root may write everything
    monkeypatch.setattr(os, 'access', lambda file, mode: allowed(file, mode) and not (
        mode == os.W_OK and os.fspath(file) == str(path)))
    assert error(path) == f'{path}: is there already, and may not be written'
    monkeypatch.setattr(os, 'access', lambda file, mode: False)
    assert error(tmp_path / 'new') == f'{tmp_path}/new: nothing may be written into {tmp_path}'


@pytest.mark.parametrize('way', WRITERS)
def test_an_input_is_not_replaced_by_any_of_its_names(way: str, files: Dict[str, str],
                                                      tmp_path: Path) -> None:
    links: List[Callable[[str, Path], None]] = [os.symlink, os.link]
    program, arguments, path = line_of(way, tmp_path / 'out', files)
    mine = {name: str(tmp_path / name) for name in ('recording', 'other', 'model', 'second')}
    for name, copy in mine.items():
        shutil.copy(files[name], copy)
    for name in mine:
        if f'{{{name}}}' not in WRITERS[way][1] or way == 'calibrate' and name == 'model':
            continue
        before = Path(mine[name]).read_bytes()
        for link in links:
            link(mine[name], path)
            _, filled, _ = line_of(way, tmp_path / 'out', {**files, **mine})
            assert f'{path}: is an input, too' in error_of(program, filled)
            path.unlink()
        assert Path(mine[name]).read_bytes() == before


def test_devices_and_pipes_are_written_and_stay(files: Dict[str, str], written: Dict[str, bytes],
                                                tmp_path: Path) -> None:
    device = os.stat('/dev/null')
    table = ['score', files['other'], '--model', files['model'], '--csv']
    assert score.main([*table[1:], '/dev/null']) == 0
    assert os.stat('/dev/null').st_ino == device.st_ino and stat.S_ISCHR(device.st_mode)
    pipe = tmp_path / 'pipe'
    os.mkfifo(pipe)
    read = tmp_path / 'read'  # into a file: a reader that nobody reads from would wait, too
    with open(read, 'wb') as out, subprocess.Popen(['cat', str(pipe)], stdout=out) as reader:
        assert score.main([*table[1:], str(pipe)]) == 0
        assert reader.wait(timeout=10) == 0
    assert read.read_bytes() == written['score --csv']
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    for way in ('train', 'convert', 'score --result-bag'):
        program, arguments, _ = line_of(way, pipe, files)
        assert f'{pipe}: is no file' in error_of(program, arguments)


@contextmanager
def small_files(most_bytes: int) -> Iterator[None]:
    """Let no file of this process grow beyond a size, as if the disk were full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize('way', WRITERS)
def test_a_file_that_cannot_grow_is_told_and_the_one_of_before_stays(
        way: str, files: Dict[str, str], written: Dict[str, bytes], tmp_path: Path) -> None:
    program, arguments, path = line_of(way, tmp_path / 'out', files)
    path.write_bytes(written[way])
    with small_files(min(len(written[way]) // 2, 4096)):
        error = error_of(program, arguments)
    assert error.endswith(f': error: {path}: cannot be written (File too large)')
    assert path.read_bytes() == written[way] and os.listdir(tmp_path) == [path.name]


def test_a_full_standard_output_is_told(files: Dict[str, str]) -> None:
    program = ('import sys; from self_awareness.commands import info;'
               'sys.exit(info.main(sys.argv[1:]))')
    with open('/dev/full', 'wb') as full:
        run = subprocess.run([sys.executable, '-c', program, files['model']], stdout=full,
                             stderr=subprocess.PIPE, text=True, check=False,
                             env={**os.environ, 'PYTHONUNBUFFERED': ''})
    assert run.returncode == 1
    assert run.stderr == 'info: error: standard output: No space left on device\n'


@pytest.mark.parametrize('way', ['train', 'convert', 'score --csv', 'score --result-bag'])
def test_a_file_of_the_same_kind_or_an_empty_one_is_replaced_through_links(
        way: str, files: Dict[str, str], written: Dict[str, bytes], tmp_path: Path) -> None:
    program, arguments, path = line_of(way, tmp_path / 'out', files)
    target = tmp_path / 'target'
    path.symlink_to(target)
    for before in (b'', written[way]):
        target.write_bytes(before)
        inode = target.stat().st_ino
        assert program.main(arguments) == 0
        assert path.is_symlink() and target.stat().st_ino != inode
        assert target.stat().st_size > 0
    assert sorted(os.listdir(tmp_path)) == sorted([path.name, 'target'])
