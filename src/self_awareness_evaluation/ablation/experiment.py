"""Every variant on the same records, one after the other; what is done stays done."""
from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Dict, List, Sequence

from self_awareness import METHOD, Tuning
from self_awareness.output_files import replacing
from self_awareness.workers import Processes
from self_awareness_evaluation.ablation import bench as benches
from self_awareness_evaluation.ablation.bench import Plan
from self_awareness_evaluation.ablation.rows import Row, RowFile, judge
from self_awareness_evaluation.ablation.variants import DEFAULT, Variant

Results = Dict[Variant, List[Row]]
"""The rows of every variant."""


def run(plan: Plan, variants: Sequence[Variant], path: Path, jobs: int) -> Results:
    """Let all variants judge, `jobs` of them at a time.

    Args:
        plan: what they judge.
        variants: the method as it is first.
        path: of the file of rows. Variants that it holds already are not judged again.
        jobs: processes.

    Raises:
        ValueError: the file holds rows of another plan or of another method.
        OSError: it cannot be read or written.
    """
    _check_plan(plan, path)
    bench = benches.make(plan, jobs)
    rows = RowFile(path)
    default = Variant(DEFAULT)
    now = judge(bench, default)
    if rows[default] and rows[default] != now:
        raise ValueError(f'{path}: the method was another one when this was measured; remove it '
                         'or choose another --output')
    if not rows[default]:
        rows.add(default, now)
    left = [variant for variant in variants if len(rows[variant]) != len(now)]
    with closing(Processes(jobs).map(judge, bench, left, 'variants')) as judged:
        for variant, found in zip(left, judged):
            rows.add(variant, found)
    return {variant: rows[variant] for variant in variants}


def _check_plan(plan: Plan, path: Path) -> None:
    """Check that the rows that a file holds are of this plan; write down what they are of.

    Raises:
        ValueError: they are of another one.
        OSError: it cannot be read or written.
    """
    numbers = [f'{number.name} {number.default:g} {number.least:g} {number.most:g} {number.off}'
               for number in Tuning.numbers()]
    text = '\n'.join([f'method {METHOD}', str(plan), *Tuning.channels(), *numbers, ''])
    beside = path.with_suffix('.plan')
    if path.is_file() and (not beside.is_file() or beside.read_text(encoding='utf-8') != text):
        raise ValueError(f'{path}: of another plan, or of another method; remove it or choose '
                         'another --output')
    with replacing(str(beside)) as temporary:
        Path(temporary).write_text(text, encoding='utf-8')
