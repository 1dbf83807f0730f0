"""The systems that can be evaluated, by name, and the libraries that some of them need."""
from __future__ import annotations

from importlib import util
from typing import Callable, Dict, Optional, Sequence

from self_awareness import Tuning
from self_awareness_evaluation.detectors import Evidence, Paper, scenario_graph
from self_awareness_evaluation.peers import sizes, timestamps
from self_awareness_evaluation.peers.frequency import (TOLERANCE, FrequencyMonitor,
                                                       LearnedFrequencyMonitor)
from self_awareness_evaluation.peers.gaps import GapMonitor
from self_awareness_evaluation.peers.markov import MarkovScorer
from self_awareness_evaluation.systems import Scorer, ScoringSystem, System


def _isolation_forest() -> Scorer:
    from self_awareness_evaluation.peers.isolation_forest import IsolationForestScorer
    return IsolationForestScorer()


def _one_class_svm() -> Scorer:
    from self_awareness_evaluation.peers.one_class_svm import OneClassSvmScorer
    return OneClassSvmScorer()


def _hmm() -> Scorer:
    from self_awareness_evaluation.peers.hmm import HmmScorer
    return HmmScorer()


_SYSTEMS: Dict[str, Callable[[Tuning], System]] = {
    'evidence': lambda tuning: Evidence(scenario_graph(), tuning=tuning),
    'evidence_no_graph': lambda tuning: Evidence(set(), tuning=tuning),
    'paper': lambda _: Paper(),
    'gaps': lambda _: GapMonitor(),
}

_SCORERS: Dict[str, Callable[[], Scorer]] = {
    'frequency': FrequencyMonitor,
    'frequency_learned': LearnedFrequencyMonitor,
    'timestamps': timestamps.TimestampMonitor,
    'sizes': sizes.SizeMonitor,
    'isolation_forest': _isolation_forest,
    'one_class_svm': _one_class_svm,
    'hmm': _hmm,
    'markov': MarkovScorer,
}

# Scorers that have a threshold of their own.
_THRESHOLDS = {'frequency': -TOLERANCE, 'timestamps': timestamps.WITHIN_BOUNDS,
               'sizes': sizes.WITHIN_BOUNDS}

# Imported when the peer is made: nothing else needs them.
_LIBRARIES = {'isolation_forest': 'sklearn', 'one_class_svm': 'sklearn', 'hmm': 'hmmlearn'}

NAMES = (*_SYSTEMS, *_SCORERS)
"""Of all systems, the package's own detectors first."""


def make(name: str, tuning: Optional[Tuning] = None) -> System:
    """Return a new system.

    Args:
        name: one of NAMES.
        tuning: of the evidence method, if the system is one of it; None: the method as it is.
    """
    if name in _SYSTEMS:
        return _SYSTEMS[name](tuning or Tuning())
    return ScoringSystem(name, _SCORERS[name](), _THRESHOLDS.get(name))


def check_libraries(names: Sequence[str]) -> None:
    """Check that the libraries of systems are installed.

    Raises:
        ValueError: names what is missing, and the ways out.
    """
    missing = [name for name in names
               if name in _LIBRARIES and util.find_spec(_LIBRARIES[name]) is None]
    if missing:
        libraries = ' and '.join(dict.fromkeys(_LIBRARIES[name] for name in missing))
        raise ValueError(f'the Python library {libraries} is not installed: let '
                         'scripts/evaluation_env.sh install it and run this program, or evaluate '
                         f'without {" and ".join(missing)} (--systems)')
