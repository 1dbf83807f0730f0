"""What is in a result bag, as plain values: for reading, and for JSON."""
from __future__ import annotations

import os
from typing import Any, Dict

from self_awareness import FileVersion, summarise_bag
from self_awareness.reporting.version_summary import summarise_version


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
