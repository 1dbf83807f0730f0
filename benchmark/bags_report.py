"""Results of the benchmark of bags, as a section of docs/performance.md."""
from __future__ import annotations

from typing import Any, Dict, List

_NAMES = {'view': '`rosbag::View`, C++', 'read_messages': '`read_messages(raw=True)`, Python',
          'read_events': '`read_events`', 'train': '`train`'}


def markdown(result: Dict[str, Any]) -> str:
    """Return the tables, with that of --jobs if it was measured."""
    programs = result['programs']
    size = result['bag_bytes']
    lines = [
        f'A bag of {size / 1e9:.2f} GB, {result["messages"]:,} messages of eight nodes in '
        f'{result["seconds"]:g} s, images among them; in the page cache, median of '
        f'{result["rounds"]} runs in turn. The work alone is the whole process without its start '
        'and imports; in brackets, times `rosbag::View`. Read of the bag: by read(2), and from '
        'the disk when no cache holds it.',
        '',
        '| | whole process | its CPU | work alone | its CPU | read | from disk |',
        '|---' + '|--:' * 6 + '|']
    for name, program in programs.items():
        times = ' | '.join(_time(programs, name, kind, alone)
                           for alone in (False, True) for kind in ('wall_s', 'cpu_s'))
        lines.append(f'| {_NAMES[name]} | {times} '
                     f'| {100 * program["read_bytes"] / size:.2f} % '
                     f'| {100 * program["cold_disk_bytes"] / size:.2f} % |')
    if 'jobs' in result:
        lines += ['', *_jobs(result['jobs'])]
    return '\n'.join(lines)


def _jobs(result: Dict[str, Any]) -> List[str]:
    alone = result['jobs']['1']['wall_s']
    lines = [
        f'`train` on {result["bags"]} bags of {result["types"]} event types, '
        f'{result["messages"]:,} messages in {result["bags"]} times {result["seconds"]:g} s, on '
        f'{result["cores"]} cores; median of {result["rounds"]} runs in turn, the CPU of all '
        'processes.',
        '',
        '| | whole program | CPU | speed-up |',
        '|---' + '|--:' * 3 + '|']
    for jobs, usage in result['jobs'].items():
        lines.append(f'| `--jobs {jobs}` | {usage["wall_s"]:.2f} s | {usage["cpu_s"]:.2f} s '
                     f'| {alone / usage["wall_s"]:.2f} |')
    return lines


def _time(programs: Dict[str, Any], name: str, kind: str, alone: bool) -> str:
    def of(program: Dict[str, float]) -> float:
        return program[kind] - (program[f'start_{kind}'] if alone else 0.0)
    seconds = of(programs[name])
    return f'{seconds:.3f} s ({seconds / of(programs["view"]):.2f})'
