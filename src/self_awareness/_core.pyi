"""What crosses the border to the C++ module, for mypy; test_stubs.py compares the two."""
from typing import Any, Callable, ClassVar, Final, Sequence

import numpy as np

from self_awareness.recordings import RecordingEvents

_Files = str | Sequence[str]

DEFAULT_WINDOW: int
EVIDENCE_THRESHOLD: float
FEWEST_CLASSES: int
HOURS_OF_ROBOTS: float
MOST_CLASSES: int
OTHER_MODE: int
LATEST_EVENT: int
LEAST_KNOWN: float
LONGEST_SILENCE: int
METHOD: int
VERSION: str
RATE_SPAN: int
SHORTEST_WINDOW: int
USUAL_SHARES: tuple[float, float]

class Acceptance:
    def __init__(self, component: str = ..., topic: str = ..., kind: str = ..., at: int = ...,
                 by: str = ..., together: Sequence[str] = ...) -> None: ...
    at: Final[int]
    component: Final[str]
    kind: Final[str]
    together: Final[list[str]]
    topic: Final[str]
    def is_about(self, event_type: EventType) -> bool: ...
    def __eq__(self, other: object, /) -> bool: ...

class Alarm:
    def __str__(self) -> str: ...
    begin: Final[int]
    busy: Final[str | None]
    culprit: Final[str]
    end: Final[int]
    evidence: Final[str]
    id: Final[int]
    kind: Final[str]
    later: Final[list[Suspect]]
    is_told_once: Final[bool]
    level: Final[str]
    lowest_score: Final[float]
    over: Final[bool]
    reason: Final[str]
    silent: Final[Silent | None]
    suspects: Final[list[Suspect]]
    waiting: Final[str]

class BagError(RuntimeError): ...

class BagSummary:
    bag: Final[str]
    clock_watched: Final[bool]
    copied: Final[bool]
    dropped: Final[int]
    encoding: Final[EncodingRules | None]
    end: Final[int]
    files: Final[list[tuple[str, int]]]
    fingerprint: Final[int]
    graph: Final[tuple[dict[str, set[str]], dict[str, set[str]], dict[str, str]]]
    has_sources: Final[bool]
    left_out: Final[list[str]]
    messages: Final[int]
    one_sender_a_topic: Final[bool]
    robot: Final[str]
    robot_start: Final[int]
    set_back: Final[list[tuple[int, int]]]
    start: Final[int]

class Calibration:
    budget: float
    false_alarms_per_hour: float
    limits: list[float]
    method: str
    recordings: list[Recording]
    relations: list[Relation]
    stamp: int
    windows: int
    def __init__(self) -> None: ...

class Calibrator:
    def __init__(self, trained: TrainedModel, settle_time: int) -> None: ...
    def add(self, recording: RecordingEvents, trained_on: bool = ...) -> None: ...
    def find(self, budget: float) -> Calibration: ...
    def findings(self) -> LimitFindings: ...
    def merge(self, findings: LimitFindings) -> None: ...
    def part(self) -> Calibrator: ...

class ComponentDrift:
    evidence: Final[float]
    last: Final[float]
    told_by: Final[int]
    usual: Final[float]

class Coverage:
    MOST_STARTS: int
    blind: Final[list[tuple[str, str, str]]]
    component: Final[str]
    death_found_after: Final[float | None]
    found_after: Final[str]
    found_when_asked: Final[float | None]
    gaps: Final[int]
    is_watched: Final[bool]
    late_answers: Final[float | None]
    late_answers_found: Final[str]
    more_starts: Final[int]
    period: Final[float]

class DetectorParameters:
    settle_time: int
    unknown: UnknownEvents
    def __init__(self) -> None: ...

class Drift:
    def component(self, number: int) -> ComponentDrift: ...
    needed: Final[float]
    samples: Final[int]

class EncodingRules:
    classes: dict[str, tuple[int, list[float]]]
    exclude_sources: list[str]
    exclude_topics: list[str]
    include_sources: list[str]
    include_topics: list[str]
    mode: tuple[str, str] | None
    rename: list[tuple[str, str]]
    source: str
    type_fields: dict[str, str]
    def __init__(self) -> None: ...
    @staticmethod
    def defaults() -> EncodingRules: ...
    def includes_source(self, source: str) -> bool: ...
    def scopes_of(self, topics: set[str]) -> dict[str, str]: ...
    def sources_of(self, nodes: set[str]) -> dict[str, str]: ...
    def validate(self) -> None: ...
    def __eq__(self, other: object, /) -> bool: ...

class EventLogWriter:
    def __init__(self, path: str, named: str = ...) -> None: ...
    def add_bag(self, path: _Files, encoding: EncodingRules, publishers: dict[str, set[str]] = ...,
                subscribers: dict[str, set[str]] = ..., hosts: dict[str, str] = ...,
                progress: Callable[[int, int], Any] | None = ...) -> BagSummary: ...
    def close(self) -> None: ...

class EventType:
    def __init__(self, source: str, scope: str, type: str) -> None: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    component: Final[str]
    scope: Final[str]
    source: Final[str]
    tells_mode: Final[bool]
    is_message: Final[bool]
    type: Final[str]

class EvidenceLanes:
    components: Final[list[str]]
    shares: Final[np.ndarray]
    strongest: Final[np.ndarray]
    tracks: Final[list[int | None]]

class EvidenceModel:
    def __init__(self, trained: TrainedModel) -> None: ...
    @staticmethod
    def of_all_pairs(trained: TrainedModel, half: int | None = ...) -> EvidenceModel: ...
    def delay_count(self, from_id: int, to_id: int) -> int: ...
    def events(self, id: int) -> int: ...
    def rate_variance(self, id: int) -> float: ...
    def dispersion(self, id: int) -> float: ...
    duration: Final[int]
    def delays(self, from_id: int, to_id: int) -> list[tuple[int, int]]: ...
    def evidence(self, window: int, stamps: np.ndarray, ids: np.ndarray,
                 limits: Sequence[float] | None = ...) -> np.ndarray: ...
    def usual_delay(self, from_id: int, to_id: int, share: float) -> float: ...
    tracks: Final[list[Track]]

class FileError(OSError): ...

class FileVersion:
    @staticmethod
    def of_event_log(path: str) -> FileVersion: ...
    @staticmethod
    def of_graph() -> FileVersion: ...
    @staticmethod
    def of_result_bag(path: str) -> FileVersion: ...
    @staticmethod
    def why_graph_too_new(format: int, oldest_reader: int, package: str) -> str: ...
    format: Final[int]
    method: Final[int]
    oldest_reader: Final[int]
    package: Final[str]

class Incident:
    ids: Final[list[int]]
    main: Final[int]
    others: Final[list[str]]
    together: Final[list[str]]
    victims: Final[list[str]]

class KeptIncident:
    alarms: Final[int]
    component: Final[str]
    ended: Final[int]
    grown: Final[int]
    id: Final[int]
    kind: Final[str]
    level: Final[str]
    model: Final[str]
    near_misses: Final[int]
    opened: Final[int]
    others: Final[list[str]]
    hosts: Final[list[str]]
    over: Final[bool]
    reason: Final[str]
    recording: Final[str]
    together: Final[list[str]]
    unknown: Final[bool]
    victims: Final[list[str]]

class Learner:
    def __init__(self, tuning: Tuning = ..., graph: set[tuple[str, str, str]] = ...,
                 window: int = ..., encoding: EncodingRules = ..., bin_size: int = ...,
                 horizon_bins: int = ..., evidence: bool = ..., paper: bool = ...) -> None: ...
    def add(self, recording: RecordingEvents) -> None: ...
    def count(self, recording: RecordingEvents) -> None: ...
    def learn(self) -> TrainedModel: ...
    def model(self, watch: bool = ...) -> TrainedModel: ...

class LimitFindings:
    def __init__(self) -> None: ...

class ModelFileError(RuntimeError): ...

class Occurrence:
    def __init__(self, id: int, is_alarm: bool, begin: int, end: int, kind: str, culprit: str,
                 named: Sequence[tuple[str, bool, int | None, str, int]],
                 hosts: Sequence[str]) -> None: ...

class OutputFile:
    def __init__(self, path: str) -> None: ...
    def close(self) -> None: ...
    def complete(self) -> None: ...
    temporary: Final[str]

class PaperCalibration:
    auc: float
    false_alarms_per_hour: float
    false_positive_rate: float
    faulty: list[Recording]
    faulty_windows: int
    injected: list[str]
    method: str
    normal: list[Recording]
    normal_windows: int
    stamp: int
    threshold: float
    true_positive_rate: float
    def __init__(self) -> None: ...

class PaperModel:
    def __init__(self, trained: TrainedModel) -> None: ...
    def judge(self, window: int, threshold: float | None, parameters: DetectorParameters,
              recording: RecordingEvents, monitor: ReplayedMonitor | None = ...) -> Verdicts: ...
    def weight(self, from_id: int, to_id: int) -> float: ...

class Persistence:
    def __init__(self, parameters: DetectorParameters) -> None: ...
    def add(self, abnormal: bool, end: int, certain: bool = ...) -> bool: ...

class Reason:
    after: Final[str]
    kind: Final[str]
    lasted: Final[float]
    topics: Final[list[str]]
    unit: Final[str]
    usual: Final[float]
    usual_longest: Final[float]
    usual_shortest: Final[float]
    value: Final[float]
    words: Final[str]
    def shortly(self, is_silence: bool, is_back: bool) -> str: ...

class RecordedEvents:
    attributes: Final[np.ndarray]
    event_types: Final[list[EventType]]
    ids: Final[np.ndarray]
    senders: Final[list[tuple[int, set[tuple[str, str]], set[EventType]]]]
    stamps: Final[np.ndarray]
    summary: Final[BagSummary]
    waiting: Final[list[tuple[int, int, int]]]

class Recording:
    bag: str
    end: int
    events: int
    fingerprint: int
    robot: str
    robot_start: int
    start: int
    def __init__(self) -> None: ...

class Relation:
    irregular: Final[bool]
    reaches: Final[bool]
    spread: Final[float]
    starts: Final[int]
    starts_needed: Final[int]
    watched: Final[bool]

class ReplayedMonitor:
    def __init__(self, bag: ResultBag, model_path: str, trained: TrainedModel, calibrated: bool,
                 event_types: Sequence[EventType], start: int,
                 coverage: Sequence[Coverage] = ...) -> None: ...

class ResultBag:
    def __init__(self, path: str, named: str = ...) -> None: ...
    def close(self) -> None: ...
    @staticmethod
    def is_one(path: str) -> bool: ...

class Roc:
    def __init__(self, normal: Sequence[float], abnormal: Sequence[float]) -> None: ...
    def at(self, cutoff: float) -> RocPoint: ...
    def closest(self) -> RocPoint: ...
    def level(self, false_positive_rate: float) -> RocPoint: ...
    def youden(self) -> RocPoint: ...
    auc: Final[float]
    points: Final[list[RocPoint]]

class RocPoint:
    cutoff: Final[float]
    false_positive_rate: Final[float]
    true_positive_rate: Final[float]

class Silent:
    def __str__(self) -> str: ...
    components: Final[list[str]]
    hosts: Final[list[str]]
    others_go_on: Final[bool]
    since: Final[int]

class Suspect:
    abnormal: Final[bool]
    component: Final[str]
    id: Final[int]
    onset: Final[int]
    reason: Final[Reason]
    since: Final[int]
    topic: Final[str]
    value: Final[str]

class Track:
    channel: Final[str]
    from_id: Final[int]
    name: Final[str]
    to_id: Final[int]

class TrainedModel:
    calibration: Calibration | None
    findings: LimitFindings
    graph: set[tuple[str, str, str]]
    hosts: dict[str, str]
    unheard: set[tuple[str, str]]
    subscriptions: Final[set[tuple[str, str]]]
    def add_subscriptions(self, lasting: set[tuple[str, str]]) -> None: ...
    paper_calibration: PaperCalibration | None
    def starts_of(self, recordings: Sequence[Recording]) -> int: ...
    def coverage(self) -> list[Coverage]: ...
    def event_count(self, arg0: int) -> int: ...
    def gaps(self, id: int) -> int: ...
    def longest_gap(self, id: int) -> int: ...
    def histogram(self, from_id: int, to_id: int) -> dict[int, int]: ...
    def __getstate__(self) -> bytes: ...
    def __setstate__(self, state: bytes, /) -> None: ...
    @staticmethod
    def load(path: str, watched_only: bool = ...) -> TrainedModel: ...
    def merge(self, other: TrainedModel) -> None: ...
    def quantile(self, from_id: int, to_id: int, fraction: float) -> int: ...
    def require(self, detector: str) -> None: ...
    def save(self, path: str) -> None: ...
    def add_renames(self, rename: Sequence[tuple[str, str]]) -> None: ...
    def watch(self) -> None: ...
    def watched_only(self) -> TrainedModel: ...
    bin_size: Final[int]
    detectors: Final[str]
    encoding: Final[EncodingRules]
    event_types: Final[list[EventType]]
    events: Final[int]
    fewest_gaps: Final[int]
    heard_in: Final[list[tuple[str, int, int, set[EventType]]]]
    horizon_bins: Final[int]
    left_out: Final[set[str]]
    pairs: Final[int]
    recordings: Final[list[Recording]]
    stamp: Final[int]
    threshold: Final[float | None]
    tuning: Final[Tuning]
    version: Final[FileVersion]
    window: Final[int]

class Tuning:
    def __init__(self) -> None: ...
    @staticmethod
    def channels() -> list[str]: ...
    def get(self, name: str) -> float: ...
    def leave_out(self, channel: str) -> None: ...
    @staticmethod
    def numbers() -> list[TuningNumber]: ...
    def set(self, name: str, value: float) -> None: ...
    def __eq__(self, other: object, /) -> bool: ...
    without: Final[list[str]]

class TuningNumber:
    default: Final[float]
    least: Final[float]
    meaning: Final[str]
    most: Final[float]
    name: Final[str]
    off: Final[float | None]
    unit: Final[str]

class UnknownEvents:
    __members__: ClassVar[dict[str, UnknownEvents]] = ...  # read-only
    ERROR: ClassVar[UnknownEvents] = ...
    IGNORE: ClassVar[UnknownEvents] = ...
    WARN: ClassVar[UnknownEvents] = ...
    def __init__(self, value: int) -> None: ...
    def __eq__(self, other: object) -> bool: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __int__(self) -> int: ...
    def __ne__(self, other: object) -> bool: ...
    name: Final[str]
    value: Final[int]

class Verdicts:
    abnormal: Final[np.ndarray]
    alarms: Final[list[Alarm]]
    events: Final[np.ndarray]
    score: Final[np.ndarray]
    settling: Final[np.ndarray]
    start: Final[np.ndarray]
    suspicion: Final[np.ndarray]
    suspicions: Final[list[Alarm]]
    unknown: Final[np.ndarray]

def bag_span(path: str) -> tuple[int, int] | None: ...
def drift_of(components: int, normal: Sequence[tuple[int, int, int, Sequence[float]]]
             ) -> Drift: ...
def evidence_lanes(trained: TrainedModel, model: EvidenceModel, parameters: DetectorParameters,
                   recording: RecordingEvents, starts: Sequence[int],
                   accepted: Sequence[Acceptance] = ...) -> EvidenceLanes: ...
def find_clock_steps(stamps: np.ndarray, ids: np.ndarray) -> list[int]: ...
def fold_incidents(occurrences: Sequence[Occurrence],
                   graph: set[tuple[str, str, str]]) -> list[Incident]: ...
def half_of(fingerprint: int) -> int: ...
def host_in(uri: str) -> str: ...
def is_own_type(datatype: str) -> bool: ...
def judge_by_evidence(trained: TrainedModel, model: EvidenceModel, parameters: DetectorParameters,
                      recording: RecordingEvents, monitor: ReplayedMonitor | None = ...,
                      accepted: Sequence[Acceptance] = ...) -> Verdicts: ...
def last_log_lines(path: _Files, encoding: EncodingRules, nodes: Sequence[tuple[str, int]],
                   most: int) -> list[list[tuple[int, int, str]]]: ...
def name_of_files(files: _Files) -> str: ...
def pack_attributes(ages: np.ndarray, sizes: np.ndarray, steps: np.ndarray,
                    same: np.ndarray) -> np.ndarray: ...
def printable(text: str) -> str: ...
def read_accepted(path: str) -> list[Acceptance] | None: ...
def read_events(path: _Files, encoding: EncodingRules, event_types: Sequence[EventType] = ...,
                start: float | None = ..., end: float | None = ...,
                progress: Callable[[int, int], Any] | None = ...,
                recording: int | None = ...) -> RecordedEvents: ...
def read_incidents(path: str) -> list[KeptIncident] | None: ...
def read_numbers(path: _Files, encoding: EncodingRules, start: float | None = ...,
                 end: float | None = ...) -> dict[str, np.ndarray]: ...
def recorded_types(path: _Files, encoding: EncodingRules,
                   recording: int | None = ...) -> set[EventType]: ...
def recordings_in_event_log(path: str) -> int | None: ...
def resolved_name(name: str) -> str: ...
def sentence(kind: str, components: Sequence[str], topic: str, wrong: str, is_silence: bool,
             begin: str, back: str, reason: str = ..., end: str = ..., goes_on: str = ...,
             times: int = ..., hosts: Sequence[str] = ..., silent: int = ...) -> str: ...
def stable_name(name: str) -> str: ...
def summarise_bag(path: _Files, recording: int | None = ...) -> BagSummary: ...
def lasting_subscriptions(summary: BagSummary,
                          encoding: EncodingRules) -> set[tuple[str, str]]: ...
def missing_subscriptions(
        summary: BagSummary, encoding: EncodingRules,
        expected: set[tuple[str, str]]) -> list[tuple[int, set[tuple[str, str]]]]: ...
def unheard_publications(encoding: EncodingRules, publishers: dict[str, set[str]],
                         subscribers: dict[str, set[str]]) -> set[tuple[str, str]]: ...
def why_nothing_is_heard(encoding: EncodingRules, publishers: dict[str, set[str]],
                         subscribers: dict[str, set[str]], types: dict[str, str],
                         used_only: bool) -> str: ...
def write_accepted(accepted: Sequence[Acceptance], path: str) -> None: ...
def write_problem(path: str, error: int, temporary: str = ...) -> str: ...
