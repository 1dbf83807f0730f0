#!/usr/bin/python3
"""The recovery beside a robot whose laser driver hangs."""
from __future__ import annotations

import json
import os
import shutil
import signal
import tempfile
import time
from contextlib import contextmanager, suppress
from typing import Any, Dict, Iterator, List, Optional

import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticStatus
from std_srvs.srv import Trigger, TriggerResponse

from live_system import (MonitorListener, Process, again_if_disturbed, await_condition, ours,
                         pid_of, run_program)
from monitor_case import MonitorCase
from self_awareness.msg import RecoveryAction, RecoveryActions
from self_awareness.recovery.node_process import process_of
from self_awareness.srv import Maintenance, MaintenanceResponse
from self_awareness_follow_me.scenario import load_scenario

PLAYER, RECOVERY = '/player', '/self_awareness_recovery'
BACK_WITHIN_S = 5.0
"""From the alarm, besides the delay of the rules."""
STOP = {'stop': [PLAYER]}


class RecoveryListener(MonitorListener):
    """Keeps what the recovery says."""

    def __init__(self) -> None:
        super().__init__(RECOVERY)
        self.actions: List[RecoveryAction] = []
        self._subscribers.append(rospy.Subscriber(RECOVERY + '/actions', RecoveryActions,
                                                  self._on_actions))

    def await_status(self, level: int, words: str) -> DiagnosticStatus:
        """Waits for a status from now on."""
        return self.await_diagnostics('recovery', words, level,
                                      since=len(self.diagnostics('recovery')))

    def _on_actions(self, message: RecoveryActions) -> None:
        self.actions = message.actions


@again_if_disturbed
class RecoveryTest(MonitorCase):

    trained: str

    @classmethod
    def setUpClass(cls) -> None:
        bags = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, bags)
        cls.trained = os.path.join(bags, 'robot.model')
        run_program('simulate', '-o', bags, '--duration', '120', '--runs', '2')
        run_program('train', os.path.join(bags, 'normal_1.bag'),
                    os.path.join(bags, 'normal_2.bag'), '-o', cls.trained)
        robot = Process('roslaunch', '--wait', 'self_awareness', 'follow_me.launch',
                        'respawn:=true')
        cls.addClassCleanup(robot.stop)

    def rules(self, *steps: Dict[str, Any], **changed: Any) -> str:
        values = {'delay': 0.5, 'wait': 30.0, 'grace': 1.0, **changed, 'rules': [
            {'component': PLAYER, 'kinds': ['silent'], 'steps': list(steps)}]}
        with open(self.path('rules.yaml'), 'w') as file:
            yaml.safe_dump(values, file)
        return file.name

    @contextmanager
    def recovering(self, rules: str) -> Iterator[RecoveryListener]:
        """Monitor and recovery; when the block begins, all is well and known."""
        rospy.wait_for_message('/scan', rospy.AnyMsg, 60)
        listener = RecoveryListener()
        with self.monitor(self.trained, detector='evidence', settle_time=3), \
                MonitorListener() as self.said, ours('recovery.py', rules), listener:
            self.said.await_settled()
            listener.await_status(DiagnosticStatus.OK, 'watches 1 components')
            yield listener

    @contextmanager
    def hung(self) -> Iterator[int]:
        """The process of /player, stopped; it goes on if it is still there at the end."""
        pid = pid_of(PLAYER)
        os.kill(pid, signal.SIGSTOP)
        try:
            yield pid
        finally:
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGCONT)

    def hold(self, duration: float) -> MaintenanceResponse:
        return rospy.ServiceProxy(RECOVERY + '/hold', Maintenance)(duration)

    def test_who_hangs_is_back_within_5_s_of_the_alarm_and_nobody_else_is_touched(self) -> None:
        others = ['/' + spec.name for spec in load_scenario().components
                  if '/' + spec.name != PLAYER]
        with self.recovering(self.rules(STOP)) as recovery:
            before = {node: pid_of(node) for node in others}
            with self.hung():
                onset = time.monotonic()
                alarm = self.said.await_alarm()
                raised = time.monotonic()
                rospy.wait_for_message('/scan', rospy.AnyMsg, 40)
                back = time.monotonic()
            rospy.loginfo('alarm after %.2f s, back %.2f s later', raised - onset, back - raised)
            self.assertEqual(alarm.component, PLAYER, alarm.message)
            self.assertLess(back - raised, 0.5 + BACK_WITHIN_S)
            action: Optional[RecoveryAction] = await_condition('the action is over', lambda: next(
                (each for each in recovery.actions if each.over), None), 20)
            self.assertTrue(action.success, action.result)
            self.assertEqual((action.incident, action.component, action.kind, action.step,
                              action.action, action.result),
                             (alarm.alarm, PLAYER, 'silent', 1, 'stop /player',
                              '/player ended by SIGKILL, since it hangs'))
            status = recovery.await_status(DiagnosticStatus.OK, '1 actions so far')
            self.assertIn('stop /player', {each.key: each.value for each in status.values}[
                'action 1'])
            self.assertEqual({node: pid_of(node) for node in others}, before)
            shown = json.loads(run_program('incidents', '--json', '--file',
                                           self.path('recorder/self_awareness.incidents')))
            self.assertEqual([[did['action'] for did in each['actions']] for each in shown
                              if each['id'] == alarm.alarm], [['stop /player']])

    def test_nothing_is_done_while_it_is_held_then_step_after_step(self) -> None:
        service = rospy.Service('/does_not_help', Trigger,
                                lambda _: TriggerResponse(True, 'no change'))
        self.addCleanup(service.shutdown)
        rules = self.rules({'call': '/does_not_help'}, STOP, wait=1.0)
        with self.recovering(rules) as recovery:
            self.assertIn('from 1 to 86400 s', self.hold(1e9).message)
            self.assertIn('does nothing until', self.hold(600.0).message)
            with self.hung() as pid:
                self.said.await_alarm()
                recovery.await_status(DiagnosticStatus.WARN, 'does nothing until')
                self.assertEqual(recovery.actions, [])
                self.assertTrue(process_of(PLAYER, pid).runs())
                self.assertEqual(self.hold(0.0).message, 'goes on')
                await_condition('then it is done', lambda: sum(
                    each.success for each in recovery.actions) == 2, 40)
                self.assertEqual([each.result for each in recovery.actions],
                                 ['/does_not_help says: no change',
                                  '/player ended by SIGKILL, since it hangs'])


if __name__ == '__main__':
    rospy.init_node('recovery_test')
    rostest.rosrun('self_awareness', 'recovery', RecoveryTest)
