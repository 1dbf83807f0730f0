"""What is said of recordings that are named: how long each is, and the files that it lies in."""
from __future__ import annotations

import os
from typing import Any, Dict, List

from self_awareness import summarise_bag
from self_awareness.parts import BagPart, Named
from self_awareness.reporting.text import duration, number_of
from self_awareness.stamps import SECOND_NS, moment


def summarise(named: Named) -> Dict[str, Any]:
    """Return the recordings as plain values; those that turn out to be bad are added to these."""
    return {'recordings': list(named.each(_recording)), 'skipped': named.bad}


def _recording(part: BagPart) -> Dict[str, Any]:
    summary = summarise_bag(part.files, part.recording)
    start, end = part.span(summary.start, summary.end)
    return {'recording': str(part), 'start_ns': start, 'duration': (end - start) / SECOND_NS,
            'files': [{'file': path, 'begin_s': (begin - summary.start) / SECOND_NS}
                      for path, begin in summary.files]}


def lines(summary: Dict[str, Any]) -> List[str]:
    """Return the same in words, but for what is bad."""
    found = summary['recordings']
    text = [f'{number_of(len(found), "recording")}, '
            f'{duration(sum(each["duration"] for each in found))}']
    for each in found:
        text.append(f'  {each["recording"]}: {each["duration"]:.1f} s, '
                    f'from {moment(each["start_ns"])}')
        if len(each['files']) > 1:
            text += [f'    from {file["begin_s"]:.1f} s on: {os.path.basename(file["file"])}'
                     for file in each['files']]
    return text
