"""The row of a live session: one for each stretch of time, whatever the plan."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

MONITOR = 'evidence'
"""The system that listened: the monitor, by its detector."""

RESTARTED = 'restarted by the recovery'
"""The fault of a row that tells of a node that the recovery has restarted."""


@dataclass(frozen=True)
class Row:
    """A stretch of time as a system saw it; the columns of the CSV files.

    All after `load` may be None: where that does not apply, never came, or was not measured.

    Args:
        fault: its name; of normal operation: what that is called; or RESTARTED.
        node: that is broken, several with a space between; empty: none, or the whole machine.
        system: that judged.
        round: number, from 1 on.
        onset: [s since 1970].
        lasted_s: time until it was undone; of normal operation: time that was judged.
        void: why a fault does not count; empty: it does.
        said: of the alarm of a fault, in the monitor's words; of normal operation: each alarm
            and suspicion as it began.
        evidence: of the alarm of a fault.
        suspects: of that alarm, the most likely first, with a space between.
        note: what did not go as planned.
        load: the machine's load average of the last minute at the onset.
        alarms: of normal operation: how often an alarm (ERROR) was raised.
        named: of normal operation: alarms that blamed a node as they began.
        suspicions: of normal operation: how often there was a suspicion (WARN) that did not
            become an alarm.
        standing_s: of normal operation: time that an alarm stood.
        expected: of normal operation: alarms an hour that calibrate expects.
        watched: of normal operation: components that the system watches; None: it judges all
            together.
        components: of normal operation: that the model knows.
        suspicion_s, latency_s: from the onset to the first WARN or ERROR, and to the first ERROR.
        blamed_s: from the onset to the first ERROR that blames the node.
        first, among_three: whether the node is the first suspect, or among the first three, of
            the first ERROR.
        end_level, end_kind, end_component: what was said when the fault was undone.
        recovered_s: from the onset to when the node was as before.
        cleared_s: from then to the end of the alarm; 0: there was none then; inf: it stood to
            the end of the wait.
        incident_began_s, incident_ended_s: from the onset to when the alarm's incident was
            opened, and to its last alarm so far; negative: it is one with an earlier fault.
        back_s: from blamed_s to when a new process of the node was heard, by the recovery.
        events: that the monitor judged.
        memory_mb, threads, files: resident memory of the monitor [MB], its threads, and its open
            files and connections, at the end.
        cpu: share of a core that the monitor took.
    """

    fault: str
    node: str
    system: str = MONITOR
    round: int = 1
    onset: float = 0.0
    lasted_s: float = 0.0
    void: str = ''
    said: str = ''
    evidence: str = ''
    suspects: str = ''
    note: str = ''
    load: float = 0.0
    alarms: Optional[int] = None
    named: Optional[int] = None
    suspicions: Optional[int] = None
    standing_s: Optional[float] = None
    expected: Optional[float] = None
    watched: Optional[int] = None
    components: Optional[int] = None
    suspicion_s: Optional[float] = None
    latency_s: Optional[float] = None
    blamed_s: Optional[float] = None
    first: Optional[bool] = None
    among_three: Optional[bool] = None
    end_level: Optional[int] = None
    end_kind: Optional[str] = None
    end_component: Optional[str] = None
    recovered_s: Optional[float] = None
    cleared_s: Optional[float] = None
    incident_began_s: Optional[float] = None
    incident_ended_s: Optional[float] = None
    back_s: Optional[float] = None
    events: Optional[int] = None
    memory_mb: Optional[float] = None
    threads: Optional[int] = None
    files: Optional[int] = None
    cpu: Optional[float] = None

    @property
    def is_normal(self) -> bool:
        """Whether nothing was wrong."""
        return self.alarms is not None

    @property
    def is_fault(self) -> bool:
        """Whether something was wrong with the robot."""
        return not self.is_normal and self.fault != RESTARTED

    @property
    def brief(self) -> str:
        """The row for people who watch the session."""
        if self.is_normal:
            return (f'{self.fault}, {self.lasted_s:.0f} s: alarms: {self.alarms}, suspicions: '
                    f'{self.suspicions}; {self.said} {self.note}')
        if not self.is_fault:
            return f'{self.fault}: {self.node}'
        return (f'{self.fault} {self.node}: {self.void or self.latency_s}, suspicion '
                f'{self.suspicion_s}, cleared {self.cleared_s}; {self.said} {self.note}')
