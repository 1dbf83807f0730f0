"""What a recovery has done, in a file that outlives it: NAME.actions, beside NAME.incidents."""
from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, Dict, List, Optional

from self_awareness import printable, yaml_file
from self_awareness.output_files import replacing
from self_awareness.yaml_section import Section

MOST = 200  # actions that are kept: the last ones, all of an hour at least (limits of the rules)
ENDING = '.actions'

_MOST_STAMP = 2 ** 63
_LONGEST_RESULT = 500
_BOOT_ID = Path('/proc/sys/kernel/random/boot_id')


@dataclass(frozen=True)
class Action:
    """A step that was begun, as RecoveryAction.msg tells of it; `begin` is in ns since 1970."""

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
    # When it was begun by the steady clock of this boot of the machine, which nobody sets [ns]; 0:
    # it was another boot.
    steady: int = 0

    def told(self) -> Dict[str, Any]:
        """Return by name what others are told of it."""
        values = asdict(self)
        del values['steady']
        return values


@dataclass(frozen=True)
class Hold:
    """Nothing is done for a while."""

    until: int = 0  # when [ns since 1970]; 0: it is done
    # The same by the steady clock of this boot [ns]; 0: it was set in another boot.
    steady: int = 0
    by: str = field(default='', compare=False)  # who wants it, in words, which is not kept

    def left(self, steady: int, wall: int) -> int:
        """Return for how long from now on [ns], 0 or more; see History.ages()."""
        return max(0, self.steady - steady if self.steady else self.until - wall)


@dataclass
class History:
    """The last actions, in the order in which they were begun, and until when there are no more.
    """

    actions: List[Action] = field(default_factory=list)
    hold: Hold = Hold()

    @property
    def under_way(self) -> Optional[Action]:
        """The last one, if it is still being done."""
        return self.actions[-1] if self.actions and not self.actions[-1].over else None

    def begin(self, action: Action) -> None:
        """Add an action."""
        self.actions = [*self.actions[1 - MOST:], action]

    def end(self, success: bool, result: str) -> None:
        """Say what came of the last one."""
        told = printable(' '.join(result.split()))[:_LONGEST_RESULT]
        self.actions[-1] = replace(self.actions[-1], over=True, success=success, result=told)

    def ages(self, steady: int, wall: int) -> List[int]:
        """Return how long ago the actions were begun [ns], 0 or more.

        Args:
            steady, wall: what the clocks say now [ns]. The latter may have been set since.
        """
        return [steady - each.steady if 0 < each.steady <= steady
                else max(0, wall - each.begin) for each in self.actions]

    def save(self, path: str) -> None:
        """Write the file, whole or not at all; its folder is made.

        Raises:
            OSError: it cannot be written.
        """
        values = {'actions': [asdict(each) for each in self.actions],
                  'held_until': self.hold.until, 'held_until_steady': self.hold.steady}
        values = {key: value for key, value in values.items() if value}
        if values:
            values['boot'] = _boot()
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with replacing(path) as temporary:
            # YAML, which reads it, knows no pairs of escapes.
            text = json.dumps(values, indent=1, ensure_ascii=False) + '\n'
            Path(temporary).write_text(text, encoding='utf-8')


def load(path: str) -> History:
    """Return what a file holds; nothing, if there is none.

    Raises:
        OSError: it cannot be read.
        ValueError: it is damaged; the message names it.
    """
    if not os.path.exists(path):
        return History()
    with Section(yaml_file.load(path), path) as section:
        read = History([_action(each) for each in section.sections('actions', ())][-MOST:],
                       Hold(section.integer('held_until', 0, 0, _MOST_STAMP),
                            section.integer('held_until_steady', 0, 0, _MOST_STAMP)))
        same_boot = section.text('boot', '.*', '') == _boot() != ''
    if not same_boot:
        read.hold = replace(read.hold, steady=0)
        read.actions = [replace(each, steady=0) for each in read.actions]
    return read


def beside_incidents(directory: str, monitor: str) -> str:
    """Return the file's path, by a monitor's full name and its ~recorder/directory."""
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
            begin=section.integer('begin', 0, high=_MOST_STAMP),
            steady=section.integer('steady', 0, 0, _MOST_STAMP),
            dry_run=section.boolean('dry_run'), over=section.boolean('over'),
            success=section.boolean('success'), result=section.text('result', '.*'))


def _boot() -> str:
    """Return what tells this boot of the machine from others; empty: not known."""
    try:
        return _BOOT_ID.read_text().strip()
    except OSError:
        return ''
