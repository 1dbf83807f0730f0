"""The systems that can be evaluated, by name."""
from __future__ import annotations

from typing import Callable, Dict

from self_awareness_evaluation.detectors import Paper
from self_awareness_evaluation.peers import FrequencyMonitor, GapMonitor, LearnedFrequencyMonitor
from self_awareness_evaluation.systems import System

EVIDENCE = ('evidence', 'evidence_no_graph')
"""The evidence detector, with the graph of the robot and without."""

_OTHERS: Dict[str, Callable[[], System]] = {
    'paper': Paper,
    'gaps': GapMonitor,
    'frequency': FrequencyMonitor,
    'frequency_learned': LearnedFrequencyMonitor,
}

NAMES = (*EVIDENCE, *_OTHERS)
"""Of all systems."""


def make(name: str) -> System:
    """Return a new system, one of NAMES that is not of EVIDENCE."""
    return _OTHERS[name]()
