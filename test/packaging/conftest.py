"""What the tests of what others get of the package share."""
from __future__ import annotations

import re
import subprocess
from pathlib import Path
from typing import Dict, Optional

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / 'examples' / 'train_and_judge.cpp'
LIBRARY_PAGE = (ROOT / 'docs' / 'library.md').read_text(encoding='utf-8')

ALARM = re.compile(r'silent /laser, alarm at 60\.\d+ s\n'
                   r'/laser: silent for .*\n'
                   r'/slam: silent for .*\n')
"""What the example prints: the laser died after 60 s; the pose, which answers it, is a victim."""


def run(*command: object, cwd: Optional[Path] = None, env: Optional[Dict[str, str]] = None,
        timeout_s: float = 900.0) -> str:
    """Run a command that must succeed; return what it printed."""
    done = subprocess.run([str(word) for word in command], cwd=cwd, env=env, timeout=timeout_s,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.returncode == 0, f'{command}:\n{done.stdout}'
    return done.stdout


def cpp_of_library_page() -> str:
    """Return the program that the page's blocks of C++ are."""
    return '\n'.join(re.findall(r'```cpp\n(.*?)```', LIBRARY_PAGE, re.DOTALL))


def configure_project_of_library_page(folder: Path, word: str, *options: str,
                                      env: Optional[Dict[str, str]] = None) -> None:
    """Prepare to build the page's program by one of its CMakeLists.txt.

    Args:
        folder: where to build; empty, or with what the project needs.
        word: which only this CMakeLists.txt contains.
        options: of cmake.
        env: the environment; None: that of this process.
    """
    blocks = re.findall(r'```cmake\n(.*?)```', LIBRARY_PAGE, re.DOTALL)
    project, = [block for block in blocks if word in block]
    (folder / 'CMakeLists.txt').write_text(project, encoding='utf-8')
    (folder / EXAMPLE.name).write_text(cpp_of_library_page(), encoding='utf-8')
    run('cmake', '-S', folder, '-B', folder / 'build', *options, env=env)


def run_project_of_library_page(folder: Path, word: str, *options: str,
                                env: Optional[Dict[str, str]] = None) -> str:
    """Prepare it so, and build it; return what it prints."""
    configure_project_of_library_page(folder, word, *options, env=env)
    run('cmake', '--build', folder / 'build', '-j2', env=env)
    program, = [path for path in (folder / 'build').rglob(EXAMPLE.stem) if path.is_file()]
    return run(program, env=env)
