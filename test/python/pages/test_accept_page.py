"""docs/live.md: the calls of its table are typed as written, while a node of the robot is dead."""
from __future__ import annotations

import re
from typing import Any, Dict, List, Tuple

import yaml
from conftest import wait_until
from page_reader import BACKGROUND, DOCS, NODES, Reader

ID = re.compile(r'\b\d{19}\b')


def calls(service: str) -> List[str]:
    """Return the lines of the page's table that call a service of the monitor."""
    lines = re.findall(r'^\| .* \| `(ros.*)` \|$', (DOCS / 'live.md').read_text(encoding='utf-8'),
                       re.MULTILINE)
    return [line for line in lines
            if line.startswith(f'rosservice call /self_awareness/{service}')]


def answer(reader: Reader, call: str) -> Tuple[bool, str]:
    """Return what a call says; too many in a row are refused for some seconds."""
    said: List[Dict[str, Any]] = []

    def is_served() -> bool:
        said.append(yaml.safe_load(reader.type(call)))
        return 'too many calls' not in said[-1]['message']

    wait_until(is_served, call)
    return said[-1]['success'], said[-1]['message']


def test_all_that_somebody_wants_is_done_as_the_page_says(reader: Reader) -> None:
    reader.learn()
    reader.type(f'{BACKGROUND}\nroslaunch self_awareness monitor.launch model:=robot.model')
    for name, topic, rate in reversed(NODES):
        reader.type(f'{BACKGROUND}\nrosrun self_awareness talker __name:={name[1:]} '
                    f'_output:={topic} _rate:={rate} _variation:=0.3')
    reader.type('rostopic echo -n 1 --filter "not m.settling and m.events > 1" '
                '/self_awareness/status')
    reader.kill_last()
    alarm = re.search(r'^alarm: (\d+)$', reader.type(
        """rostopic echo -n 1 --filter 'm.level == 2 and m.component == "/camera"' """
        '/self_awareness/alarm'), re.MULTILINE)
    assert alarm is not None
    ask, *accept, ask_back, undo = [ID.sub(alarm[1], call) for call in calls('accept')]
    assert len(accept) == 5
    done, message = answer(reader, ask)
    assert not done and f'"{{alarm: {alarm[1]}}}" for /camera on /image (silent)' in message
    for call in accept:
        done, message = answer(reader, call)
        assert done and 'normal from now on' in message, call
    done, message = answer(reader, ask_back)
    assert not done and '/rostopic_12 on /cmd_vel, /camera (slow) and /joystick' in message
    done, message = answer(reader, undo)
    assert done and 'judged again' in message
    *mutes, told_again = calls('mute')
    assert len(mutes) == 4
    for call in mutes:
        done, message = answer(reader, call)
        assert done and 'not told until' in message, call
    done, message = answer(reader, told_again)
    assert done and 'told again: /camera' in message
    for service, said in (('clear', 'alarm'), ('dump', 'dump_')):
        call, = calls(service)
        done, message = answer(reader, call)
        assert done and said in message, message
