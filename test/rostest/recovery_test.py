#!/usr/bin/python3
"""The recovery beside a robot whose laser driver hangs."""
from __future__ import annotations

import json
import os
import signal
import time
from contextlib import suppress
from typing import List, Optional

import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticStatus

from live_system import (MonitorListener, Process, again_if_disturbed, await_condition, ours,
                         pid_of, run_program)
from monitor_case import MonitorCase
from self_awareness.msg import RecoveryAction, RecoveryActions
from self_awareness.recovery.node_process import process_of
from self_awareness.srv import Maintenance, MaintenanceResponse
from self_awareness_follow_me.scenario import load_scenario

PLAYER, RECOVERY = '/player', '/self_awareness_recovery'
BACK_WITHIN_S = 5.0
"""From when nobody holds it, besides the delay of the rules."""


def go_on(pid: int) -> None:
    """Wakes a process that is stopped, if it is still there."""
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGCONT)


class RecoveryListener(MonitorListener):
    """Keeps what the recovery says."""

    def __init__(self) -> None:
        super().__init__(RECOVERY)
        self.actions: List[RecoveryAction] = []
        self._subscribers.append(rospy.Subscriber(RECOVERY + '/actions', RecoveryActions,
                                                  self._on_actions))

    def _on_actions(self, message: RecoveryActions) -> None:
        self.actions = message.actions


@again_if_disturbed
class RecoveryTest(MonitorCase):

    def model_of_robot(self) -> str:
        """A model of the simulated robot, which is started, too."""
        path = self.path('robot.model')
        run_program('simulate', '-o', self.folder, '--duration', '120', '--runs', '2')
        run_program('train', self.path('normal_1.bag'), self.path('normal_2.bag'), '-o', path)
        robot = Process('roslaunch', '--wait', 'self_awareness', 'follow_me.launch',
                        'respawn:=true')
        self.addCleanup(robot.stop)
        rospy.wait_for_message('/scan', rospy.AnyMsg, 60)
        return path

    def rules(self) -> str:
        values = {'delay': 0.5, 'wait': 30.0, 'grace': 1.0, 'rules': [
            {'component': PLAYER, 'kinds': ['silent'], 'steps': [{'stop': [PLAYER]}]}]}
        with open(self.path('rules.yaml'), 'w') as file:
            yaml.safe_dump(values, file)
        return file.name

    def hold(self, duration: float) -> MaintenanceResponse:
        return rospy.ServiceProxy(RECOVERY + '/hold', Maintenance)(duration)

    def test_who_hangs_is_back_within_5_s_unless_it_is_held_and_nobody_else_is_touched(
            self) -> None:
        others = ['/' + spec.name for spec in load_scenario().components
                  if '/' + spec.name != PLAYER]
        recovery = RecoveryListener()
        with self.monitor(self.model_of_robot(), detector='evidence', settle_time=3), \
                MonitorListener() as said, ours('recovery.py', self.rules()), recovery:
            said.await_settled()
            recovery.await_next('recovery', 'watches 1 components', DiagnosticStatus.OK)
            before = {node: pid_of(node) for node in others}
            self.assertIn('from 1 to 86400 s', self.hold(1e9).message)
            self.assertIn('does nothing until', self.hold(600.0).message)
            pid = pid_of(PLAYER)
            os.kill(pid, signal.SIGSTOP)
            self.addCleanup(go_on, pid)
            alarm = said.await_alarm()
            self.assertEqual(alarm.component, PLAYER, alarm.message)
            recovery.await_next('recovery', 'does nothing until', DiagnosticStatus.WARN)
            self.assertEqual(recovery.actions, [])
            self.assertTrue(process_of(PLAYER, pid).runs())
            self.assertEqual(self.hold(0.0).message, 'goes on')
            since = time.monotonic()
            rospy.wait_for_message('/scan', rospy.AnyMsg, 40)
            self.assertLess(time.monotonic() - since, 0.5 + BACK_WITHIN_S)
            action: Optional[RecoveryAction] = await_condition('the action is over', lambda: next(
                (each for each in recovery.actions if each.over), None), 20)
            self.assertTrue(action.success, action.result)
            self.assertEqual((action.incident, action.component, action.kind, action.step,
                              action.action, action.result),
                             (alarm.alarm, PLAYER, 'silent', 1, 'stop /player',
                              '/player ended by SIGKILL, since it hangs'))
            status = recovery.await_next('recovery', '1 actions so far', DiagnosticStatus.OK)
            self.assertIn('stop /player', {each.key: each.value for each in status.values}[
                'action 1'])
            self.assertEqual({node: pid_of(node) for node in others}, before)
            shown = json.loads(run_program('incidents', '--json', '--file',
                                           self.path('recorder/self_awareness.incidents')))
            self.assertEqual([[did['action'] for did in each['actions']] for each in shown
                              if each['id'] == alarm.alarm], [['stop /player']])


if __name__ == '__main__':
    rospy.init_node('recovery_test')
    rostest.rosrun('self_awareness', 'recovery', RecoveryTest)
