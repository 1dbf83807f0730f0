"""What the monitor would have said, `score`, its JSON and the report: one culprit, kind, onset."""
from __future__ import annotations

import html
import re
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Dict

import rosbag


def told(path: Path) -> Dict[int, Any]:
    """Return the last message of each alarm and suspicion while it stood, by id."""
    with rosbag.Bag(str(path)) as bag:
        return {message.alarm: message for topic, message, _ in bag.read_messages()
                if topic.endswith('/alarm') and message.level > 0}


def clock(stamp_s: float) -> str:
    return datetime.fromtimestamp(stamp_s, timezone.utc).strftime('%H:%M:%S UTC')


def check(recording: Dict[str, Any], results: Path, page: Path, printed: str) -> None:
    """Check that all say the same of a recording.

    Args:
        recording: what the JSON says of it.
        results: the result bag.
        page: the report.
    """
    messages = told(results)
    alarms = {alarm['id']: alarm for alarm in recording['alarms']}
    assert alarms and set(messages) == set(alarms)
    for id_, alarm in alarms.items():
        message = messages[id_]
        assert (message.kind, message.component) == (alarm['kind'], alarm['culprit'] or '')
        named = [*alarm['suspects'], *alarm['later']]
        blamed = next((each for each in named if each['component'] == alarm['culprit']), None)
        if blamed is None:
            continue
        begin = message.message.split(', ')[0]
        assert begin.startswith(alarm['culprit']) or (
            blamed['kind'] == 'stranger' and alarm['culprit'] in begin)
        if blamed['kind'] == 'silent' and blamed['onset_s'] is not None:
            onset = alarm['begin_ns'] / 1e9 - alarm['begin_s'] + blamed['onset_s']
            assert clock(onset) in message.message
    title = re.search(r'<title>(.*?)</title>', page.read_text('utf-8'), re.S)
    headline = recording['incidents'][0]['headline']
    assert title and html.unescape(title[1]).strip().startswith(headline)
    for incident in recording['incidents']:
        assert f"  {incident['headline']}" in printed
        of_it = [alarms[id_] for id_ in incident['alarms'] if alarms[id_]['level'] ==
                 incident['level']]
        assert (incident['kind'], incident['cause']) in [
            (alarm['kind'], alarm['culprit']) for alarm in of_it]
        if incident['cause'] and incident['kind'] != 'stranger':
            assert incident['headline'].startswith(incident['cause'])
