"""self_awareness: learns how a healthy robot talks to itself.

The method is implemented once, in C++; this package makes it available to Python as
`self_awareness.Training`, `TrainedModel`, `Model`, `Roc` and so on, and holds the logic of the
programs (`self_awareness.commands`).
"""

from self_awareness._core import (  # noqa: F401
    DEFAULT_WINDOW,
    EVIDENCE_THRESHOLD,
    FEWEST_GAPS,
    LEAST_KNOWN,
    PREDECESSORS,
    USUAL_SHARES,
    Alarm,
    BagError,
    BagSummary,
    Calibration,
    DetectorParameters,
    EncodingRules,
    EventLogWriter,
    EventType,
    EvidenceCalibration,
    EvidenceLimits,
    EvidenceModel,
    LeastEffect,
    LimitFinder,
    LimitFindings,
    Model,
    ModelFileError,
    Persistence,
    RecordedEvents,
    Recording,
    ReplayedMonitor,
    ResultBag,
    Roc,
    RocPoint,
    Suspect,
    TrainedModel,
    Training,
    UnknownEvents,
    Verdicts,
    judge_by_evidence,
    read_events,
    recordings_in_event_log,
    stable_name,
    summarise_bag,
)
