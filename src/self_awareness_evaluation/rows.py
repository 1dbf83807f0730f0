"""What a system says of one record: a row of the results, the same for all records and systems.

Rows are kept in CSV files, for other programs, too.
"""
from __future__ import annotations

import csv
from dataclasses import MISSING, dataclass, fields, is_dataclass, replace
from pathlib import Path
from typing import (Any, Dict, List, Optional, Sequence, Tuple, Type, TypeVar, Union, get_args,
                    get_origin, get_type_hints)

import numpy as np

from self_awareness import DEFAULT_WINDOW
from self_awareness.output_files import save_table
from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness_evaluation.records import (NORMAL, REAL, FaultRecord, Judged, SystemAlarm)

# An alarm that is raised so soon after the fault is over belongs to it: a node that comes back is
# no normal operation yet [s].
AFTERMATH_S = 5.0

HOUR_S = 3600.0
_BETWEEN = '; '  # texts in one cell
_Row = TypeVar('_Row')


@dataclass(frozen=True)
class Subject:
    """Who judges, and whom."""

    part: str  # where the record comes from: FAMILIES, OWN or REAL
    robot: str  # with its seed; of a real one, what the recording is called
    learning: str  # what was learned from, in short
    system: str  # its name
    change: str = ''  # what was changed of the method; empty: nothing
    # False alarms an hour that its limits allow; None: the usual ones, or it has none.
    budget: Optional[float] = None

    @property
    def family(self) -> str:
        """The robot without its seed."""
        return self.robot if self.part == REAL else self.robot.rpartition(' ')[0]


@dataclass(frozen=True)
class Row:
    """A system on a record. Times are from the onset of the fault [s]."""

    subject: Subject  # see there
    fault: str  # NORMAL, or the kind of the fault
    source: str = ''  # the guilty components; empty: no single one is guilty
    hours: float = 0.0  # of normal operation, settled: all of it, or what was before the onset [h]
    alarms: int = 0  # raised in it, all of them false
    standing_hours: float = 0.0  # for how long an alarm stood in it [h]
    warnings: int = 0  # times that a suspicion or an alarm began in it
    evidence: Tuple[str, ...] = ()  # what raised each alarm in it, in the system's words
    expected: Optional[float] = None  # false alarms an hour, by the calibration; None: not told
    # How many components the system watches, of a record without a fault; of one with a fault, how
    # many of the guilty ones. None: it judges all together, or is not known.
    watched: Optional[int] = None
    components: Optional[int] = None  # how many there are; None: not known
    stood_before: bool = False  # whether a false alarm stood at the onset: no other can be raised
    latency_s: Optional[float] = None  # to the first alarm raised after the onset; None: none was
    # To the first suspicion or alarm; None: none, or one stood at the onset.
    noticed_s: Optional[float] = None
    # Whether that alarm names a guilty one first, or among the first three; None: no such alarm,
    # nobody is guilty, or the system names nobody.
    first: Optional[bool] = None
    among_three: Optional[bool] = None
    # How many it names that have nothing to do with the fault; None: no such alarm, or who is
    # involved is not known.
    bystanders: Optional[int] = None
    level: str = ''  # of what stands when the fault ends, ALARM or SUSPICION; empty: nothing does
    # Who is to blame by then, and what is wrong; empty: nobody, or not known.
    culprit: str = ''
    kind: str = ''
    after: Optional[int] = None  # false alarms for who was back already; None: the fault lasts
    refused: str = ''  # why nothing could be judged; empty: it was

    @property
    def right_at_end(self) -> Optional[bool]:
        """Whether a guilty one is blamed when the fault ends, or nobody where nobody is guilty;
        None: nothing stands, or who is guilty is not known."""
        if not self.level or self.subject.part == REAL:
            return None
        return self.culprit in self.source.split(_BETWEEN)


def normal_row(subject: Subject, judged: Judged, expected: Optional[float] = None,
               watched: Optional[int] = None, components: Optional[int] = None) -> Row:
    row = Row(subject, NORMAL, expected=expected, watched=watched, components=components)
    return _quiet(row, judged, np.ones(len(judged.start), dtype=bool), judged.alarms)


def fault_row(subject: Subject, record: FaultRecord, judged: Judged,
              watched: Optional[int] = None) -> Row:
    """Measure a record with a fault; watched: how many of the culprits the system watches."""
    onset = record.onset
    row = _quiet(Row(subject, record.kind, record.source, watched=watched), judged,
                 judged.start + DEFAULT_WINDOW <= onset,
                 [alarm for alarm in judged.alarms if alarm.start <= onset])
    row = replace(row, noticed_s=_noticed_s(judged, onset),
                  stood_before=any(each.stands_at(onset) for each in judged.alarms))
    alarms, ends = judged.alarms, record.recording.end
    if record.back is not None:
        ends = record.back
        alarms = [each for each in alarms if each.start <= ends + nanoseconds(AFTERMATH_S)]
        row = replace(row, after=len(judged.alarms) - len(alarms))
    alarm = first_alarm(alarms, onset)
    if alarm is not None:
        row = replace(row, latency_s=(alarm.start - onset) / SECOND_NS)
        named = alarm.suspects
        if named is not None and record.culprits:
            guilty = [suspect in record.culprits for suspect in named]
            row = replace(row, first=any(guilty[:1]), among_three=any(guilty[:3]))
        if named is not None and record.involved is not None:
            row = replace(row, bystanders=len(set(named) - record.involved))
    return at_end(row, [*judged.alarms, *judged.suspicions], ends)


def first_alarm(alarms: Sequence[SystemAlarm], onset: int) -> Optional[SystemAlarm]:
    """Return the first alarm that is raised after the onset [ns]."""
    return next((alarm for alarm in alarms if alarm.start > onset), None)


def _quiet(row: Row, judged: Judged, early: np.ndarray, alarms: Sequence[SystemAlarm]) -> Row:
    """Return the row with what was judged in some windows of normal operation."""
    counted = early & ~judged.settling
    begins = np.diff((judged.noticed & early).astype(np.int8), prepend=0) == 1
    return replace(row, hours=_hours(counted), alarms=len(alarms),
                   standing_hours=_hours(judged.standing & counted), warnings=int(begins.sum()),
                   evidence=tuple(alarm.evidence for alarm in alarms))


def at_end(row: Row, found: Sequence[SystemAlarm], end: int) -> Row:
    """Return the row of a fault with what is said when it ends; found: alarms, then suspicions, of
    which an alarm goes first."""
    last = next((each for each in found if each.stands_at(end)), None)
    if last is None:
        return row
    return replace(row, level=last.level, culprit=last.culprit, kind=last.kind)


def _noticed_s(judged: Judged, onset: int) -> Optional[float]:
    """Return when the first suspicion or alarm came after the onset [s]; None: see Row."""
    ends = judged.start + DEFAULT_WINDOW
    noticed = judged.noticed
    if not noticed.any() or noticed[ends <= onset][-1:].any():
        return None
    first = ends[noticed & (ends > onset)][:1]
    return (int(first[0]) - onset) / SECOND_NS if len(first) else None


def _hours(windows: np.ndarray) -> float:
    return int(windows.sum()) * DEFAULT_WINDOW / SECOND_NS / HOUR_S


def columns(row_type: type) -> List[str]:
    """Return the columns of a dataclass: its fields, those of a field that is one itself, too."""
    hints = get_type_hints(row_type)
    return [name for field in fields(row_type) for kind in [hints[field.name]]
            for name in (columns(kind) if is_dataclass(kind) else [field.name])]


def flat(row: Any) -> Dict[str, Any]:
    """Return a row by column; tuples become one text."""
    found: Dict[str, Any] = {}
    for field in fields(row):
        value = getattr(row, field.name)
        if is_dataclass(value):
            found.update(flat(value))
        else:
            found[field.name] = _BETWEEN.join(value) if isinstance(value, tuple) else value
    return found


def save(path: Path, rows: Sequence[_Row], row_type: Type[_Row]) -> None:
    """Write rows, a whole file or none."""
    save_table(str(path), columns(row_type), [list(flat(row).values()) for row in rows])


def load(path: Path, row_type: Type[_Row]) -> List[_Row]:
    """Read what save() wrote, without columns that are not known; raise ValueError, with the line,
    if it is not such a table."""
    with open(path, encoding='utf-8', newline='') as file:
        reader = csv.DictReader(file)
        rows = []
        for cells in reader:
            try:
                rows.append(_row(cells, row_type))
            except ValueError as error:
                raise ValueError(f'{path}, line {reader.line_num}: {error}') from None
    return rows


def _row(cells: Dict[str, str], row_type: Any) -> Any:
    hints = get_type_hints(row_type)
    values = {}
    for field in fields(row_type):
        kind, text = hints[field.name], cells.get(field.name)
        if is_dataclass(kind):
            values[field.name] = _row(cells, kind)
        elif text is not None:
            values[field.name] = _parsed(field.name, text, kind)
        elif field.default is MISSING:
            raise ValueError(f'there is no {field.name}')
    return row_type(**values)


def _parsed(name: str, text: str, kind: Any) -> Any:
    if get_origin(kind) is Union:  # Optional
        return _parsed(name, text, get_args(kind)[0]) if text else None
    if get_origin(kind) is tuple:
        return tuple(text.split(_BETWEEN)) if text else ()
    if kind is bool:
        if text not in ('True', 'False'):
            raise ValueError(f'{name} is {text!r}, not True or False')
        return text == 'True'
    try:
        return kind(text)
    except ValueError:
        raise ValueError(f'{name} is {text!r}, no number') from None
