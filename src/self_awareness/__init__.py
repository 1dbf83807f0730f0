"""self_awareness: learns how a healthy robot talks to itself.

>>> import self_awareness as sa
>>> model = sa.learn(['monday.bag', 'tuesday.bag'])
>>> for alarm in model.judge('crash.bag'):
...     if alarm.level == 'ERROR':
...         print(alarm.kind, alarm.culprit)
died /laser

docs/python.md tells more. The method is implemented once, in C++; the other names here are its
parts, which the programs (`self_awareness.commands`) are made of.
"""
from typing import TYPE_CHECKING, Any


from self_awareness._core import (  # noqa: F401
    DEFAULT_WINDOW,
    EVIDENCE_THRESHOLD,
    FEWEST_CLASSES,
    HOURS_OF_ROBOTS,
    LATEST_EVENT,
    LEAST_KNOWN,
    LONGEST_SILENCE,
    METHOD,
    MOST_CLASSES,
    OTHER_MODE,
    RATE_SPAN,
    SHORTEST_WINDOW,
    USUAL_SHARES,
    VERSION,
    Acceptance,
    Alarm,
    BagError,
    BagSummary,
    Calibration,
    Calibrator,
    ComponentDrift,
    Coverage,
    DetectorParameters,
    Drift,
    DriftSamples,
    EncodingRules,
    EventLogWriter,
    EventType,
    EvidenceCounts,
    EvidenceLanes,
    EvidenceModel,
    FileError,
    FileVersion,
    Incident,
    KeptIncident,
    Learner,
    LimitFindings,
    ModelFileError,
    Occurrence,
    OutputFile,
    PaperCalibration,
    PaperModel,
    Persistence,
    Reason,
    RecordedEvents,
    Recording,
    ReplayedMonitor,
    ResultBag,
    Roc,
    RocPoint,
    Silent,
    Suspect,
    Track,
    TrainedModel,
    Tuning,
    TuningNumber,
    UnknownEvents,
    Verdicts,
    Waiting,
    bag_span,
    evidence_lanes,
    find_clock_steps,
    fold_incidents,
    half_of,
    host_in,
    is_own_type,
    judge_by_evidence,
    last_log_lines,
    lasting_subscriptions,
    missing_subscriptions,
    name_of_files,
    pack_attributes,
    printable,
    read_accepted,
    read_events,
    read_incidents,
    read_numbers,
    recorded_types,
    recordings_in_event_log,
    resolved_name,
    stable_name,
    summarise_bag,
    unheard_publications,
    why_nothing_is_heard,
    write_accepted,
    write_problem,
)

if TYPE_CHECKING:
    from self_awareness.library import Alarms, Model, learn, load  # noqa: F401

_LIBRARY = ('Alarms', 'Model', 'learn', 'load')


def __getattr__(name: str) -> Any:
    """Import the library when it is needed: it brings numpy, which many programs do without."""
    if name not in _LIBRARY:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    from self_awareness import library
    return getattr(library, name)
