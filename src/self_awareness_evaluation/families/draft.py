"""Draws the components of a robot: timers, chains of answers, tasks."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, FrozenSet, List, Set, Tuple

import numpy as np

from self_awareness_evaluation.families.conditions import Activity, Conditions
from self_awareness_evaluation.families.emissions import Answer, Emission, Feedback, Timer
from self_awareness_evaluation.families.robot import Output, Robot

RATES_HZ = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 25.0, 30.0, 50.0, 100.0)  # usual rates

_CHAINS = 7
FASTEST_CHAIN_HZ = 30.0
_SHORTEST_ANSWER_S, _LONGEST_ANSWER_S = 0.003, 0.04
MOST_OF_PERIOD = 0.4  # an answer takes no longer, so that its component keeps up
_COPY_S = 0.0005


@dataclass(frozen=True)
class Timing:
    """How the timers of a robot keep time; see Timer. Each clock is off by up to `ppm`."""

    variation: float = 0.0
    ppm: float = 0.0
    wander: float = 0.0
    loops: bool = False


class Draft:
    """A robot while it is drawn: outputs are added one by one."""

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self.rng = np.random.default_rng(seed)
        self.timing = Timing()
        """Of all timers that are added from now on."""
        self.namespace = ''
        """Put before all names that are added from now on, like `/robot1`."""
        self.conditions = Conditions()
        self.outputs: List[Output] = []
        self.activities: Dict[str, Activity] = {}
        self.subscriptions: Set[Tuple[str, str]] = set()
        self.far: FrozenSet[str] = frozenset()
        """Who is on the other side of the wireless link."""
        self._clocks: Dict[str, float] = {}

    def robot(self) -> Robot:
        """Return the robot."""
        return Robot(self.seed, tuple(self.outputs), self.conditions, self.activities,
                     frozenset(self.subscriptions), self.far)

    def add(self, name: str, topic: str, datatype: str, emission: Emission,
            other: str = '', fails: float = 0.0) -> int:
        """Add an output of the component of that name, and return its index; a topic is its own
        if it does not begin with a slash."""
        source = f'{self.namespace}/{name}'
        self.outputs.append(Output(source, topic if topic.startswith('/') else f'{source}/{topic}',
                                   datatype, emission, other, fails))
        return len(self.outputs) - 1

    def add_timer(self, name: str, rate_hz: float, topic: str = 'data', activity: str = '') -> int:
        """Add an output with a timer."""
        timing = self.timing
        ppm = self._clocks.setdefault(name, self.rng.uniform(-timing.ppm, timing.ppm))
        return self.add(name, topic, 'sensor_msgs/PointCloud2', Timer(
            1.0 / rate_hz, variation=timing.variation, ppm=ppm, wander=timing.wander,
            loop=timing.loops and self.rng.uniform() < 0.5, activity=activity))

    def add_answer(self, name: str, trigger: int, longest_s: float, topic: str = 'result',
                   activity: str = '', every: int = 1, share: float = 1.0) -> int:
        """Add an output that answers within some milliseconds."""
        longest = max(_SHORTEST_ANSWER_S, min(_LONGEST_ANSWER_S, longest_s))
        delay = float(np.exp(self.rng.uniform(np.log(_SHORTEST_ANSWER_S), np.log(longest))))
        return self.add(name, topic, 'geometry_msgs/PoseStamped', Answer(
            trigger, delay, self.rng.uniform(0.05, 0.25), every, share, activity))

    def add_copies(self, index: int, number: int) -> None:
        """Let the component of an output publish further topics right after it."""
        name = self.outputs[index].source[len(self.namespace) + 1:]
        for copy in range(number):
            self.add(name, f'{self.outputs[index].topic.rsplit("/", 1)[-1]}_info{copy}',
                     'sensor_msgs/CameraInfo', Answer(index, _COPY_S * (copy + 1), 0.3))

    def add_chain(self, name: str, begin: int, rate_hz: float, length: int) -> List[int]:
        """Add components that answer each to the one before, and return their outputs."""
        chain = []
        for link in range(length):
            begin = self.add_answer(f'{name}_{link + 1}', begin, MOST_OF_PERIOD / rate_hz)
            chain.append(begin)
        return chain

    def listen(self, number: int) -> None:
        """Let every component with a timer subscribe to some others that it does not answer to."""
        sources = sorted({output.source for output in self.outputs})
        for output in self.outputs:
            if isinstance(output.emission, Timer):
                for publisher in self.rng.choice(sources, int(self.rng.integers(0, number + 1))):
                    if publisher != output.source:
                        self.subscriptions.add((str(publisher), output.source))


def add_timers_and_chains(draft: Draft, more: int = 4) -> None:
    """Add a timer of every usual rate, some more, and chains of answers after some of them."""
    rates = [*RATES_HZ, *draft.rng.choice(RATES_HZ, more).tolist()]
    timers = [draft.add_timer(f'driver{number}', rate) for number, rate in enumerate(rates)]
    slow = [number for number, rate in enumerate(rates) if rate <= FASTEST_CHAIN_HZ]
    for chain, number in enumerate(draft.rng.choice(slow, _CHAINS, replace=False).tolist()):
        draft.add_chain(f'filter{chain}', timers[number], rates[number],
                        int(draft.rng.integers(1, 4)))
    draft.listen(2)


def add_task(draft: Draft, name: str, trigger: int, activity: str = '') -> None:
    """Add a component that answers within 0.1 to 4 s; half of them tell how they get on."""
    delay = float(np.exp(draft.rng.uniform(np.log(0.1), np.log(2.5))))
    spread = draft.rng.uniform(0.05, 0.15)
    result = draft.add(name, 'result', 'move_base_msgs/MoveBaseActionResult',
                       Answer(trigger, delay, spread, activity=activity))
    if draft.rng.uniform() < 0.5:
        draft.add(name, 'feedback', 'move_base_msgs/MoveBaseActionFeedback',
                  Feedback(result, delay / draft.rng.uniform(2.0, 6.0)))
