"""Writes what was found beside the packaged nodes: a CSV file, and a page with one table."""
from __future__ import annotations

import csv
import math
from collections import Counter
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence

from self_awareness.calibration import confidence
from self_awareness.output_files import replacing
from self_awareness_evaluation.live.learning import APART_S
from self_awareness_evaluation.nodes.measures import (BURSTS, SEPARATOR, UNDISTURBED,
                                                      Row)
from self_awareness_evaluation.nodes.session import (BETWEEN_BURSTS_S, BURST_S, QUIET_AFTER_S,
                                                     RECOVERED_WITHIN_S, SessionPlan)
from self_awareness_evaluation.nodes.system import NODES, RELAY
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.tables import table

_NAME = 'nodes'
_NONE = '–'

_INTRODUCTION = """\
# Evaluation beside packaged nodes

{written}

{nodes} nodes of Debian packages, which nobody of this project wrote, publish on {topics} topics:

{packages}

A relay of this project (`{relay}`) is one more, because no packaged one can come late. PCL's
nodelets are left out: the list of them comes only with PCL's development packages, 750 MB. Debian
12 has no drivers of lasers, IMUs or GPS receivers: `rosbag play` replays small bags, whose periods
vary by 2 %, under their names. `scripts/packaged_nodes_env.sh` installs everything;
`src/self_awareness_evaluation/nodes/system.py` lists nodes and faults.

`record.launch` recorded {starts} starts of them for {training_s:g} s each, for `train`, and
{calibrations} more for {calibration_s:g} s, for `calibrate`, all with default options.
{apart_s:g} s passed between two recordings: those within a minute count as one start. After
another start, the monitor of `monitor.launch` watched. First nothing was wrong; then came one
fault after the other. Before each, the monitor's ~reset was called, and it had settled and not
alarmed for some seconds. After each there was no alarm for {quiet_s:g} s; where one stood, the
wait for that was {within_s:g} s at most.

Latencies count from the onset to the end of the window whose status was WARN or ERROR; `none`:
none while the fault lasted. "Guilty first": the node that was broken (the manager, if it holds
nodelets) is the first suspect of the alarm. "Cleared": from the end of the fault, when the node
had published on all its topics again, to the end of the alarm; 0 where the alarm was over
before. The relay's 60 ms are a period and 10 ms of its topic of 20 Hz: it comes 10 ms after the
message before.

The machine's load average was {low:.1f} to {high:.1f}, that of the nodes included. Other work
makes messages late, and swaps those that come at the same time.
"""


_COMPANY = """\
Only in that session, an operator looked on: `rosbag record -a` recorded all topics, and
`rostopic echo /diagnostics` read what all nodes say of themselves. After the quiet time, other
programs took every core for {shortest_s:g} to {longest_s:g} s at a time, every {between_s:g} s on
the average, as a machine does that compiles now and then. "Name a node": of the alarms of
undisturbed operation, those that blamed one as they began.
"""


_WATCHED = """\
The model watches {watched:.0f} of {components:.0f} components.
"""


def write(folder: Path, plan: SessionPlan, rows: Sequence[Row], command: str) -> List[Path]:
    """Write both files, each whole or not at all; return their names.

    Args:
        folder: exists.
        plan: of the session.
        rows: of all stretches, in their order.
        command: that the page says it was written by.

    Raises:
        OSError: a file cannot be written.
    """
    paths = [csv_path(folder), folder / f'{_NAME}.md']
    save_csv(paths[0], rows)
    with replacing(str(paths[1])) as temporary:
        Path(temporary).write_text(page(plan, load_csv(paths[0]), command), encoding='utf-8')
    return paths


def csv_path(folder: Path) -> Path:
    """Return where the rows are written."""
    return folder / f'{_NAME}.csv'


def save_csv(path: Path, rows: Sequence[Row]) -> None:
    """Write all rows.

    Raises:
        OSError: the file cannot be written.
    """
    with replacing(str(path)) as temporary:
        with open(temporary, 'w', encoding='utf-8', newline='') as file:
            writer = csv.DictWriter(file, [field.name for field in fields(Row)],
                                    lineterminator='\n')
            writer.writeheader()
            writer.writerows({name: _cell(value) for name, value in asdict(row).items()}
                             for row in rows)


def load_csv(path: Path) -> List[Row]:
    """Read what save_csv wrote.

    Raises:
        OSError: the file cannot be read.
    """
    with open(path, encoding='utf-8', newline='') as file:
        return [Row(**{name: _value(name, text) for name, text in row.items()})
                for row in csv.DictReader(file)]


def page(plan: SessionPlan, rows: Sequence[Row], command: str) -> str:
    """Return the page."""
    packaged = [node for node in NODES if node is not RELAY]
    lines = [_INTRODUCTION.format(
        written=written_by(command), nodes=len(packaged), relay=RELAY.name,
        topics=len({topic for node in packaged for topic in node.topics}),
        packages='\n'.join(_packages()), starts=plan.starts, training_s=plan.training_s,
        calibrations=plan.calibrations, calibration_s=plan.calibration_s, apart_s=APART_S,
        quiet_s=QUIET_AFTER_S, within_s=RECOVERED_WITHIN_S, low=min(row.load for row in rows),
        high=max(row.load for row in rows))]
    quiet = {kind: [row for row in rows if row.fault == kind] for kind in (UNDISTURBED, BURSTS)}
    if quiet[BURSTS]:
        lines.append(_COMPANY.format(shortest_s=BURST_S[0], longest_s=BURST_S[1],
                                     between_s=BETWEEN_BURSTS_S))
    for row in quiet[UNDISTURBED][:1]:
        if not math.isnan(row.components):  # a session that did not note it
            lines.append(_WATCHED.format(watched=row.watched, components=row.components))
    lines += table(['', 'lasted', 'WARN', 'ERROR', 'guilty first', 'cleared',
                    'what the monitor said'],
                   [*(_quiet(kind, of_kind) for kind, of_kind in quiet.items() if of_kind),
                    *(_fault(row) for row in rows if row.fault not in quiet)])
    return '\n'.join([*lines, *_remarks(rows), ''])


def _packages() -> List[str]:
    """Return a line for each package, with its nodes."""
    names: Dict[str, List[str]] = {}
    for node in NODES:
        if node is not RELAY:
            kind = node.arguments[1].split('/')[0] if node.manager else node.package
            where = f' (in `{node.manager}`)' if node.manager else ''
            names.setdefault(kind, []).append(f'`{node.name}`{where}')
    return [f'- {package}: {", ".join(of_package)}' for package, of_package in names.items()]


def _quiet(kind: str, rows: Sequence[Row]) -> List[str]:
    """Return the line of a kind of normal operation."""
    hours = sum(row.lasted_s for row in rows) / 3600.0
    alarms = sum(row.alarms for row in rows)
    suspicions = sum(row.suspicions for row in rows)
    standing_s = sum(row.standing_s for row in rows)
    low, high = confidence.poisson_rate(alarms, hours)
    named = sum(row.named for row in rows)  # nan of a session that did not note it
    naming = '' if math.isnan(named) else f'; {named:.0f} name a node'
    return [f'**{kind}**', f'{60.0 * hours:.0f} min',
            f'{suspicions:.0f} ({suspicions / hours:.1f} an hour)',
            f'{alarms:.0f} (95 %: {low:.1f} to {high:.1f} an hour; expected by calibrate: '
            f'{rows[0].expected:.2g}){naming}', _NONE,
            f'an alarm stood for {standing_s:.0f} s ({standing_s / hours / 36.0:.2g} % of the '
            'time)', _text(_counted([said for row in rows for said in row.said.split(SEPARATOR)]))]


def _counted(said: Sequence[str]) -> str:
    """Return how often the same was said of the same topic, whatever the numbers."""
    kinds = Counter(': '.join(text.split(': ')[:2]) for text in said if text)
    return '; '.join(f'{kind} ({number}x)' for kind, number in sorted(kinds.items()))


def _fault(row: Row) -> List[str]:
    name = f'`{row.node}` {row.fault}' if row.node else row.fault
    if row.void:
        return [name, f'{row.lasted_s:.0f} s', _NONE, _NONE, _NONE, _NONE, f'void: {row.void}']
    guilty = (_NONE if row.first is None else 'yes' if row.first
              else 'among three' if row.among_three else 'no')
    cleared = 'did not clear' if math.isinf(row.cleared_s) else f'{row.cleared_s:.1f} s'
    return [name, f'{row.lasted_s:.0f} s', _latency(row.suspicion_s), _latency(row.latency_s),
            guilty, _NONE if row.latency_s is None and row.cleared_s == 0.0 else cleared,
            _text(row.said)]


def _latency(latency_s: Optional[float]) -> str:
    return 'none' if latency_s is None else f'{latency_s:.2f} s'


def _text(said: str) -> str:
    return said.replace('|', '/') or _NONE


def _remarks(rows: Sequence[Row]) -> List[str]:
    notes = [f'- `{row.node}` {row.fault}: {row.note}' for row in rows if row.note]
    return ['', 'What did not go as planned:', '', *notes] if notes else []


def _cell(value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, float):
        return '' if value is None else value
    return '' if math.isnan(value) else f'{value:.6g}'


_TEXTS = ('fault', 'node', 'said', 'suspects', 'void', 'note')
_FLAGS = ('first', 'among_three')
_OPTIONAL = ('suspicion_s', 'latency_s')


def _value(name: str, text: str) -> Any:
    if name in _TEXTS:
        return text
    if name in _FLAGS:
        return None if text == '' else text == 'True'
    if text == '':
        return None if name in _OPTIONAL else math.nan
    return float(text)
