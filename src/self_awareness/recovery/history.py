"""What a recovery has done, in a file that outlives it: NAME.actions, beside NAME.incidents."""
from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import List

from self_awareness import printable, yaml_file
from self_awareness.output_files import replacing
from self_awareness.yaml_section import Section

MOST = 100
"""Actions that are kept: the last ones."""
ENDING = '.actions'

_MOST_STAMP = 2 ** 63
_LONGEST_RESULT = 500


@dataclass(frozen=True)
class Action:
    """A step that was begun.

    Args:
        incident: id of the monitor's incident.
        component, kind: what the incident blames, and for what.
        step, steps: its number, 1 the first, and that of all.
        action: what it does, in words.
        begin: [ns since 1970].
        dry_run: nothing was done.
        over: it is not being done any more.
        success: it was done, which need not have helped.
        result: what came of it, in words.
    """

    incident: int
    component: str
    kind: str
    step: int
    steps: int
    action: str
    begin: int
    dry_run: bool
    over: bool = False
    success: bool = False
    result: str = ''


@dataclass
class History:
    """The last actions, and until when there may be no further ones.

    Args:
        actions: in the order in which they were begun.
        held_until: [ns since 1970]; 0: not at all.
    """

    actions: List[Action] = field(default_factory=list)
    held_until: int = 0

    def begin(self, action: Action) -> None:
        """Add an action."""
        self.actions = [*self.actions[1 - MOST:], action]

    def end(self, success: bool, result: str) -> None:
        """Say what came of the last one."""
        told = printable(' '.join(result.split()))[:_LONGEST_RESULT]
        self.actions[-1] = replace(self.actions[-1], over=True, success=success, result=told)

    def save(self, path: str) -> None:
        """Write the file, whole or not at all; its folder is made.

        Raises:
            OSError: it cannot be written.
        """
        values = {key: value for key, value in asdict(self).items() if value}
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with replacing(path) as temporary:
            # YAML, which reads it, knows no pairs of escapes.
            Path(temporary).write_text(json.dumps(values, indent=1, ensure_ascii=False) + '\n',
                                       encoding='utf-8')


def load(path: str) -> History:
    """Return what a file holds; nothing, if there is none.

    Raises:
        OSError: it cannot be read.
        ValueError: it is damaged; the message names it.
    """
    if not os.path.exists(path):
        return History()
    with Section(yaml_file.load(path), path) as section:
        return History([_action(each) for each in section.sections('actions', ())][-MOST:],
                       int(section.number('held_until', 0, _MOST_STAMP, 0)))


def beside_incidents(directory: str, monitor: str) -> str:
    """Return the file's path.

    Args:
        directory: the monitor's parameter ~recorder/directory.
        monitor: its full name.
    """
    name = monitor.lstrip('/').replace('/', '_')
    home = os.environ.get('ROS_HOME') or '~/.ros'
    if directory.startswith('$ROS_HOME/'):
        directory = home + directory[len('$ROS_HOME'):]
    return os.path.join(os.path.expanduser(directory.replace('$NAME', name)), name + ENDING)


def _action(section: Section) -> Action:
    with section:
        return Action(
            incident=section.integer('incident', 0), component=section.text('component'),
            kind=section.text('kind'), step=section.integer('step', 1),
            steps=section.integer('steps', 1), action=section.text('action'),
            begin=int(section.number('begin', 0, _MOST_STAMP)),
            dry_run=section.boolean('dry_run'), over=section.boolean('over'),
            success=section.boolean('success'), result=section.text('result', '.*'))
