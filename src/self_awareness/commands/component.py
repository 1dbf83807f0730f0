"""`rosrun self_awareness component`: runs one component of the simulated follow-me robot."""
from __future__ import annotations

import argparse

from self_awareness.commands import cli, ros_node
from self_awareness_follow_me.node import ComponentNode
from self_awareness_follow_me.scenario import load_scenario
from self_awareness_follow_me.speed import sped_up


def _run(arguments: argparse.Namespace) -> None:
    scenario = sped_up(load_scenario(arguments.scenario or None), arguments.speed)
    intruder = scenario.faults.extra.spec
    spec = intruder if arguments.name == intruder.name else scenario.component(arguments.name)
    ros_node.begin(spec.name)
    ComponentNode(scenario, spec, arguments.seed).spin()


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('name', help='name of the component, or of the intruder, in the scenario')
    parser.add_argument('--scenario', help='scenario file (default: config/follow_me.yaml)')
    parser.add_argument('--seed', type=int, default=0, help='of the random numbers (default: 0)')
    parser.add_argument('--speed', type=cli.above_zero('a factor of the speed'), default=1.0,
                        help='how many times as fast everything goes (default: 1)')


main = cli.Program('component', __doc__, '', _arguments, _run, is_node=True)
