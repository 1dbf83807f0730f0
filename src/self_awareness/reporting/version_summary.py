"""Of what version a file is (docs/files.md), as plain values and in words."""
from __future__ import annotations

from typing import Any, Dict

from self_awareness import METHOD, FileVersion


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
