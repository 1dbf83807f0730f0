"""Makes the page of a report: one file that needs no network."""
from __future__ import annotations

import base64
import importlib.util
import shutil
import zlib
from typing import Any, Dict, Optional, Sequence

from self_awareness.output_files import replacing
from self_awareness.reporting.report import figures, neighbours
from self_awareness.reporting.report.headline import clock
from self_awareness.reporting.report.incidents import Incident
from self_awareness.reporting.report.section import Details, Section
from self_awareness.reporting.report.templates import template

_WITHOUT_EVAL = 5  # the first version of plotly whose plotly.js calls no eval()


def check_installed(graphs: bool = False) -> None:
    """Check before long work that a page can be made, with graphs if they are wanted.

    Raises:
        ValueError: plotly is missing, which rosdep does not know, or dot.
    """
    if importlib.util.find_spec('plotly') is None:
        raise ValueError('a page needs plotly, which is not installed: apt install '
                         'python3-plotly')
    if graphs and shutil.which('dot') is None:
        raise ValueError('a report needs dot, which is not installed: apt install graphviz')


def save_report(path: str, sections: Sequence[Section]) -> None:
    """Write the report of recordings.

    Raises:
        OSError: the file cannot be written, or a graph cannot be drawn.
    """
    save_page(path, 'report.html', {
        'sections': [{
            'overTime': figures.over_time(section.timeline, section.incidents),
            'incidents': {each.key: _drawn(each, section.details.get(each.key))
                          for each in section.incidents},
        } for section in sections]},
        sections=sections, clock=clock, draw=neighbours.draw)


def save_page(path: str, name: str, data: Dict[str, Any], **values: Any) -> None:
    """Write a page of this folder's style.

    Args:
        path: of the page.
        name: of the template.
        data: what page.js draws: figures, and where they belong.
        values: of the template.

    Raises:
        OSError: the file cannot be written.
        ValueError: a number of the data is not finite.
    """
    import plotly  # takes long to import: only a program that writes a page imports it
    from plotly.offline import get_plotlyjs

    page = template(name).stream(
        # As page.js unpacks it: Debian's plotly.js has 8.7 MB, and packed 2.5.
        data=data, plotly=base64.b64encode(zlib.compress(get_plotlyjs().encode(), 9)).decode(),
        evals=int(plotly.__version__.split('.')[0]) < _WITHOUT_EVAL, **values)
    with replacing(path) as temporary:
        with open(temporary, 'w', encoding='utf-8') as file:
            file.writelines(page)


def _drawn(incident: Incident, details: Optional[Details]) -> Dict[str, Any]:
    against = [] if details is None else details.evidence
    return {'range': [round(incident.main.start, 3), round(incident.main.end, 3)],
            'figures': {f'{incident.key}-delays-{index}': evidence.figure
                        for index, evidence in enumerate(against) if evidence is not None}}
