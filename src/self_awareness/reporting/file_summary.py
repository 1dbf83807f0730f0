"""What is in an event log or a result bag, and of what version a file is (docs/monitor.md).

As plain values: for reading, and for JSON.
"""
from __future__ import annotations

import os
from collections import Counter
from typing import Any, Dict, List, Set, Tuple

import numpy as np

from self_awareness import (METHOD, BagSummary, EncodingRules, FileVersion, encoding_file,
                            read_events, recordings_in_event_log, summarise_bag)
from self_awareness.stamps import SECOND_NS
from self_awareness.training.robot_graph import RobotGraph


def summarise_version(version: FileVersion) -> Dict[str, Any]:
    """Return what a file says of its version; `method` is None where no method made it."""
    return {
        'package': version.package,
        'format': version.format,
        'oldest_reader': version.oldest_reader,
        'method': version.method or None,
    }


def describe_version(summary: Dict[str, Any]) -> str:
    """Return the same in words."""
    text = f'self_awareness {summary["package"]}, format {summary["format"]}'
    if summary['method'] is None:
        return text
    older = f' (this is {METHOD})' if summary['method'] != METHOD else ''
    return f'{text}, method {summary["method"]}{older}'


def summarise_results(path: str) -> Dict[str, Any]:
    """Return when a result bag begins and ends, and how much is in it.

    Raises:
        BagError: it cannot be read.
    """
    summary = summarise_bag(path)
    return {
        'version': summarise_version(FileVersion.of_result_bag(path)),
        'size': os.path.getsize(path),
        'start_ns': summary.start,
        'end_ns': summary.end,
        'messages': summary.messages,
    }


def summarise_event_log(path: str) -> Dict[str, Any]:
    """Return all of an event log but its events.

    Times are in seconds and rates in Hz, unless a key says otherwise. Event types are those of all
    recordings.

    Raises:
        BagError: it cannot be read.
    """
    counts: Counter = Counter()
    found: List[Dict[str, Any]] = []
    edges: Set[Tuple[str, str, str]] = set()
    hosts: Dict[str, str] = {}
    for number in range(recordings_in_event_log(path) or 0):
        summary = summarise_bag(path, number)
        assert summary.encoding is not None, 'every recording of an event log has one'
        events = read_events(path, summary.encoding, recording=number)
        for kind, count in zip(events.event_types, np.bincount(
                events.ids, minlength=len(events.event_types)).tolist()):
            counts[kind] += count
        graph = RobotGraph(*summary.graph)
        edges |= graph.edges(summary.encoding)
        hosts.update(graph.hosts_of_sources(summary.encoding))
        found.append(_recording(summary, summary.encoding))
    duration = sum(recording['duration'] for recording in found)
    return {
        'version': summarise_version(FileVersion.of_event_log(path)),
        'size': os.path.getsize(path),
        'duration': duration,
        'events': sum(counts.values()),
        'starts': len({recording['robot_start_ns'] for recording in found} - {None}),
        'recordings': found,
        'event_types': [{'source': kind.source, 'scope': kind.scope, 'type': kind.type,
                         'count': count, 'rate': count / duration if duration > 0.0 else None}
                        for kind, count in counts.items()],
        'graph': [dict(zip(('publisher', 'topic', 'subscriber'), edge))
                  for edge in sorted(edges)],
        'hosts': hosts,
    }


def _recording(summary: BagSummary, encoding: EncodingRules) -> Dict[str, Any]:
    return {
        'bag': summary.bag,
        'start_ns': summary.start,
        'duration': (summary.end - summary.start) / SECOND_NS,
        'events': summary.messages,
        'dropped': summary.dropped,
        'robot_start_ns': summary.robot_start or None,
        'robot': summary.robot or None,
        'encoding': encoding_file.values(encoding),
    }
