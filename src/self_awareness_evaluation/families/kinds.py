"""Draws the robots of the families: their timers, chains of answers and tasks."""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Callable, Dict, FrozenSet, List, Optional, Sequence, Set, Tuple

import numpy as np

from self_awareness_evaluation.families.emissions import (Answer, Emission, Feedback, Once,
                                                          Sporadic, Timer, TwoRates)
from self_awareness_evaluation.families.robot import LOG, WARNING, Output, Robot
from self_awareness_evaluation.families.scene import CRASH, NOTHING, Activity, Conditions, Fault

RATES_HZ = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 25.0, 30.0, 50.0, 100.0)  # usual rates
_CHAINS = 7
FASTEST_CHAIN_HZ = 30.0
_SHORTEST_ANSWER_S, _LONGEST_ANSWER_S = 0.003, 0.04
MOST_OF_PERIOD = 0.4  # an answer takes no longer, so that its component keeps up
_COPY_S = 0.0005
_TRANSFORMS = 'tf2_msgs/TFMessage'
_DIAGNOSTICS = 'diagnostic_msgs/DiagnosticArray'
_ACTION = 'move_base_msgs/MoveBaseAction'
_RESULT = f'{_ACTION}Result[status.status='
_FAILS = 1.0 / 12.0  # of the goals, in normal operation
_HOLE_S = 6.0
_HEAD_OR_TAIL_S = (6.0, 20.0)


class Draft:
    """A robot while it is drawn: outputs are added one by one."""

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self.rng = np.random.default_rng(seed)
        # What timers that are added from now on are like: clocks differ by up to its `ppm`, and
        # half of them loop if it does.
        self.timing = Timer()
        self.namespace = ''  # put before all names that are added from now on, like `/robot1`
        self.conditions = Conditions()
        self.outputs: List[Output] = []
        self.activities: Dict[str, Activity] = {}
        self.subscriptions: Set[Tuple[str, str]] = set()
        self.far: FrozenSet[str] = frozenset()  # who is on the other side of the wireless link
        self._clocks: Dict[str, float] = {}

    def robot(self) -> Robot:
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
        ppm = self._clocks.setdefault(name, self.rng.uniform(-self.timing.ppm, self.timing.ppm))
        return self.add(name, topic, 'sensor_msgs/PointCloud2', replace(
            self.timing, period_s=1.0 / rate_hz, ppm=ppm, activity=activity,
            loop=self.timing.loop and self.rng.uniform() < 0.5))

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

    def add_chain(self, name: str, begin: int, rate_hz: float, length: int) -> int:
        """Add components that answer each to the one before, and return the last one's output."""
        for link in range(length):
            begin = self.add_answer(f'{name}_{link + 1}', begin, MOST_OF_PERIOD / rate_hz)
        return begin

    def add_drivers(self, number: int, rates_hz: Sequence[float]) -> None:
        """Add components with a timer of one of some rates each."""
        for each in range(number):
            self.add_timer(f'driver{each}', float(self.rng.choice(rates_hz)))

    @property
    def sources(self) -> List[str]:
        return sorted({output.source for output in self.outputs})

    def listen(self, number: int) -> None:
        """Let every component with a timer subscribe to some others that it does not answer to."""
        sources = self.sources
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


def add_task(draft: Draft, name: str, trigger: int) -> None:
    """Add a component that answers within 0.1 to 4 s; half of them tell how they get on."""
    delay = float(np.exp(draft.rng.uniform(np.log(0.1), np.log(2.5))))
    spread = draft.rng.uniform(0.05, 0.15)
    result = draft.add(name, 'result', f'{_ACTION}Result', Answer(trigger, delay, spread))
    if draft.rng.uniform() < 0.5:
        draft.add(name, 'feedback', f'{_ACTION}Feedback',
                  Feedback(result, delay / draft.rng.uniform(2.0, 6.0)))


def _timers(timing: Timer = Timer(), conditions: Conditions = Conditions()
            ) -> Callable[[Draft], None]:
    def drawn(draft: Draft) -> None:
        draft.timing, draft.conditions = timing, conditions
        add_timers_and_chains(draft)
    return drawn


def _large(draft: Draft) -> None:
    rates = draft.rng.choice((1.0, 2.0, 5.0, 10.0, 10.0, 10.0, 20.0), 25).tolist()
    ends = [(draft.add_timer(f'driver{number}', rate), rate) for number, rate in enumerate(rates)]
    heads = list(ends)
    for number in range(35):
        begin, rate = ends[int(draft.rng.integers(len(ends)))]
        ends.append((draft.add_chain(f'filter{number}', begin, rate, 1), rate))
        heads.append(ends[-1])
    # The other topics of 250, at 8 messages a second on average: 2000.
    shares = draft.rng.multinomial(250 - len(heads), [1.0 / len(heads)] * len(heads))
    for (index, _), number in zip(heads, shares.tolist()):
        draft.add_copies(index, number)
    draft.listen(4)
    draft.conditions = Conditions(lost=1e-3)


def _driving_docked(draft: Draft) -> None:
    draft.activities['driving'] = Activity(120.0, 120.0)
    add_timers_and_chains(draft)
    for number, rate in enumerate((10.0, 20.0, 50.0)):
        index = draft.add_timer(f'motion{number}', rate, activity='driving')
        draft.add_chain(f'motion_filter{number}', index, rate, number % 2 + 1)
    # Who has more to say while the robot drives.
    for number, rate in enumerate((5.0, 10.0)):
        draft.add_timer(f'planner{number}', rate)
        draft.add_timer(f'planner{number}', rate, 'motion', activity='driving')


def _rate_modes(draft: Draft) -> None:
    rng = draft.rng
    draft.activities['driving'] = Activity(60.0, 60.0)
    draft.add_drivers(3, RATES_HZ)
    for number in range(int(rng.integers(10, 16))):
        fast = float(rng.choice((20.0, 50.0)))
        index = draft.add(f'motion{number}', 'state', 'nav_msgs/Odometry', TwoRates(
            Timer(1.0 / fast), Timer(1.0 / float(rng.choice((1.0, 2.0)))), 'driving'))
        draft.add_chain(f'motion_filter{number}', index, fast, number % 2)


def _small(draft: Draft) -> None:
    rate = float(draft.rng.choice((5.0, 10.0, 20.0, 50.0)))
    index = draft.add_timer('driver', rate)
    draft.add_copies(index, int(draft.rng.integers(0, 2)))
    draft.add_chain('filter', index, rate, int(draft.rng.integers(1, 3)))


def _servers(draft: Draft) -> None:
    rng = draft.rng
    draft.add_drivers(2, (1.0, 10.0, 50.0))
    for server in range(2):
        for client in range(int(rng.integers(4, 7))):
            name = f'client{server}_{client}'
            asked = draft.add(name, 'request', 'std_msgs/String', Sporadic(rng.uniform(0.5, 4.0)))
            answer = draft.add_answer(f'server{server}', asked, 0.04, f'result{client}')
            draft.add_answer(name, answer, 0.04, 'done')


def _wireless(draft: Draft) -> None:
    add_timers_and_chains(draft)
    far = draft.rng.choice(draft.sources, len(draft.sources) // 3, replace=False).tolist()
    draft.conditions, draft.far = Conditions(heavy=0.01), frozenset(far)


def _events_only(draft: Draft) -> None:
    rng = draft.rng
    draft.activities['session'] = Activity(rng.uniform(60.0, 180.0), rng.uniform(120.0, 300.0))
    for number in range(2):
        draft.add(f'watchdog{number}', 'heartbeat', 'std_msgs/Empty',
                  Timer(float(rng.choice((1.0, 2.0, 5.0))), jitter_s=0.01))
    person = draft.add('speech', 'heard', 'std_msgs/String',
                       Sporadic(rng.uniform(5.0, 15.0), 'session'))
    button = draft.add('panel', 'pressed', 'std_msgs/Bool',
                       Sporadic(rng.uniform(10.0, 30.0), 'session'))
    for number in range(9):
        before = [index for index, output in enumerate(draft.outputs)
                  if not isinstance(output.emission, (Timer, Feedback))]
        add_task(draft, f'task{number}', int(rng.choice(before[:2] if number < 3 else before)))
    draft.subscriptions.add((draft.outputs[person].source, draft.outputs[button].source))


def _bursty(draft: Draft) -> None:
    rng = draft.rng
    rates = rng.choice((2.0, 5.0, 10.0, 20.0, 30.0, 50.0), int(rng.integers(5, 13)))
    for number, rate in enumerate(rates.tolist()):
        index = draft.add_timer(f'driver{number}', rate)
        if rate <= FASTEST_CHAIN_HZ and rng.uniform() < 0.6:
            draft.add_chain(f'filter{number}', index, rate, int(rng.integers(1, 4)))
    triggers = range(len(draft.outputs))
    for number in range(int(rng.integers(2, 6))):
        seen = f'seen{number}'
        draft.activities[seen] = Activity(rng.uniform(4.0, 15.0), rng.uniform(0.3, 1.0))
        draft.add_answer(f'tracker{number}', int(rng.choice(triggers)), 0.03, 'track', seen)
    draft.activities['session'] = Activity(rng.uniform(60.0, 180.0), rng.uniform(30.0, 120.0))
    speech = draft.add('speech', 'heard', 'std_msgs/String',
                       Sporadic(rng.uniform(5.0, 15.0), 'session'))
    for number in range(int(rng.integers(2, 6))):
        add_task(draft, f'task{number}', speech)
    draft.listen(2)


def _two_robots(draft: Draft) -> None:
    second = Draft(draft.seed)
    second.rng = draft.rng
    draft.namespace, second.namespace = '/robot1', '/robot2'
    for each in (draft, second):
        add_timers_and_chains(each, 0)
    shift = len(draft.outputs)
    for output in second.outputs:
        emission = output.emission
        if isinstance(emission, Answer):
            emission = replace(emission, trigger=emission.trigger + shift)
        draft.outputs.append(replace(output, emission=emission))
    draft.subscriptions |= second.subscriptions
    leader = draft.outputs[0].source
    draft.subscriptions |= {(leader, output.source) for output in second.outputs[:3]}
    draft.conditions = Conditions(lost=1e-4)


def _pausing_chains(draft: Draft) -> None:
    rng = draft.rng
    draft.add_drivers(int(rng.integers(3, 7)), (1.0, 5.0, 10.0, 50.0))
    anchors = []
    for number in range(3):
        rate = float(rng.choice((5.0, 10.0, 15.0, 20.0)))
        scan = draft.add_timer(f'laser{number}', rate)
        seen = f'seen{number}'
        draft.activities[seen] = Activity(rng.uniform(8.0, 40.0), rng.uniform(0.7, 8.0))
        longest = MOST_OF_PERIOD / rate
        legs = draft.add_answer(f'legs{number}', scan, longest, 'legs', seen)
        tracker = draft.add_answer(f'tracker{number}', legs, longest, 'track',
                                   share=rng.uniform(0.985, 0.998))
        anchor = draft.add_answer(f'anchor{number}', tracker, longest, 'anchor')
        draft.add_answer(f'attention{number}', anchor, longest, 'gaze', every=4)
        anchors.append((anchor, rate))
    draft.listen(2)
    # Answers to every fourth message that take about half of the time until the next one.
    for number, (anchor, rate) in enumerate(anchors):
        draft.add(f'planner{number}', 'plan', 'nav_msgs/Path', Answer(
            anchor, rng.uniform(0.4, 0.7) / rate, rng.uniform(0.15, 0.3), every=4))


def _dialogue(draft: Draft) -> None:
    rng = draft.rng
    draft.activities['session'] = Activity(rng.uniform(60.0, 180.0), rng.uniform(60.0, 240.0))
    draft.add_drivers(3, (1.0, 2.0, 10.0))
    asked = draft.add('microphone', 'speech', 'std_msgs/String',
                      Sporadic(rng.uniform(5.0, 12.0), 'session'))
    for name in ('recogniser', 'dialogue', 'voice'):
        delay = float(np.exp(rng.uniform(np.log(0.2), np.log(2.0))))
        asked = draft.add(name, 'said', 'std_msgs/String', Answer(
            asked, delay, rng.uniform(0.1, 0.4), share=rng.uniform(0.63, 0.99)))
        if rng.uniform() < 0.5:  # it tells its state as well
            draft.add_timer(name, float(rng.choice((0.5, 1.0, 2.0))), 'state')
    for number in range(3):
        add_task(draft, f'task{number}', asked)


def _long_pauses(draft: Draft) -> None:
    rng = draft.rng
    draft.add_drivers(4, (1.0, 5.0, 10.0, 50.0))
    for number in range(4):
        used = f'used{number}'
        draft.activities[used] = Activity(rng.uniform(3.0, 20.0), rng.uniform(20.0, 120.0))
        rate = float(rng.choice((10.0, 20.0, 50.0)))
        index = draft.add_timer(f'joystick{number}', rate, 'joy', used)
        draft.add_chain(f'teleop{number}', index, rate, number % 2)
    draft.listen(2)


def _of_one_make(draft: Draft, number: int) -> None:
    add_timers_and_chains(draft)
    rate = float(np.random.default_rng((draft.seed, number)).choice(RATES_HZ))
    draft.add(f'own{number}', 'data', 'sensor_msgs/Temperature', Timer(1.0 / rate))


def _everyday(draft: Draft) -> None:
    rng = draft.rng
    add_timers_and_chains(draft, 0)
    draft.add('map_server', '/map', 'nav_msgs/OccupancyGrid[latched]', Once())
    frames = [f'link{number}' for number in range(int(rng.integers(3, 12)))]
    draft.add('state_publisher', '/tf', _TRANSFORMS, Timer(1.0 / float(rng.choice(RATES_HZ[4:]))))
    _add_list(draft, 'state_publisher', '/tf', f'{_TRANSFORMS}[lists transforms.child_frame_id: ',
              ', '.join(frames), ', '.join(frames[1:]))
    for number in range(3):
        name = f'device{number}'
        draft.add_timer(name, float(rng.choice(RATES_HZ)))
        draft.add(name, '/diagnostics', _DIAGNOSTICS, Timer(1.0))
        _add_list(draft, name, '/diagnostics', f'{_DIAGNOSTICS}[lists status.level: ', '0', '0, 2')
    draft.add_timer('navigator', 5.0, 'status')
    draft.add('navigator', 'result', f'{_RESULT}3]', Sporadic(rng.uniform(5.0, 20.0)),
              f'{_RESULT}4]')
    for name in ('planner', 'navigator'):
        draft.add_timer(name, 10.0, 'command')
        for lines in ('rosgraph_msgs/Log[level=2]', WARNING):
            draft.add(name, LOG, lines, Sporadic(rng.uniform(3.0, 20.0)))
    draft.add_timer('gripper', 5.0, 'status')
    draft.add('gripper', 'result', f'{_RESULT}3]', Sporadic(rng.uniform(1.0, 5.0)), f'{_RESULT}4]',
              fails=_FAILS)


def _add_list(draft: Draft, name: str, topic: str, field: str, usual: str, other: str) -> None:
    """Add what messages of a component list: its values, and those of a fault."""
    draft.add(name, topic, f'{field}{usual}]', Timer(1.0), f'{field}{other}]')


def _near_timers(draft: Draft) -> None:
    rng = draft.rng
    draft.add_timer('driver', 10.0)
    for number in range(2):  # the longest gap of hours is two periods
        draft.add(f'imu{number}', 'data', 'sensor_msgs/Imu', Timer(0.05, jitter_s=0.012))
    for number, (rate, on_s, off_s) in enumerate(((40.0, 10.0, 0.12), (20.0, 6.0, 2.5))):
        seen = f'seen{number}'  # pauses of up to half a second, and of up to ten
        draft.activities[seen] = Activity(on_s, off_s * rng.uniform(0.8, 1.2))
        draft.add_timer(('laser', 'joystick')[number], rate, activity=seen)


def _hole(robot: Robot, number: int, seconds: float) -> Fault:
    begin_s = (seconds - _HOLE_S) / 2.0
    return Fault(CRASH, robot.regular[0], begin_s, begin_s + _HOLE_S) if number == 0 else NOTHING


def _head_or_tail(robot: Robot, number: int, seconds: float) -> Fault:
    length_s = float(np.random.default_rng((robot.seed, number)).uniform(*_HEAD_OR_TAIL_S))
    if number % 2 == 0:
        return Fault(CRASH, robot.regular[0], 0.0, length_s)
    return Fault(CRASH, robot.regular[1], seconds - length_s)


@dataclass(frozen=True)
class Family:
    """Robots of a kind."""

    told: str  # what they are, in a few words
    draw: Callable[[Draft], None] = _timers()  # draws a robot
    one_start: bool = False  # the recordings to learn from are all of one start
    watched_start: bool = False  # and so are those that are watched; else each is of another start
    # Returns what is wrong with a recording to learn from, by the robot, the number of the
    # recording and its length [s].
    flaw: Callable[[Robot, int, float], Fault] = lambda *_: NOTHING
    # Draws one of several robots of a make, by a number: each recording to learn from is of
    # another one, and all that is watched of one more; None: there is one robot.
    of_make: Optional[Callable[[Draft, int], None]] = None

    def robot(self, seed: int, number: Optional[int] = None) -> Robot:
        """Return the robot of a seed, at least 0; of a make, that of a number if one is given."""
        draft = Draft(seed)
        if number is None or self.of_make is None:
            self.draw(draft)
        else:
            self.of_make(draft, number)
        return draft.robot()


_STALLS = Conditions(stalls_an_hour=6.0)

FAMILIES: Dict[str, Family] = {  # all families by name, each with something of its own
    'timers': Family('exact timers of 0.5 to 100 Hz, seven chains of answers'),
    'timers_drift': Family('the same, clocks that differ by up to 50 ppm',
                           _timers(Timer(ppm=50.0))),
    'timers_one_start': Family('timers, recorded in one start, watched in others', one_start=True),
    'stalls': Family('timers, the same start, six stalls of 0.1 to 0.6 s an hour',
                     _timers(conditions=_STALLS), one_start=True, watched_start=True),
    'stalled_loops': Family('the same, half of the timers have a new phase after each stall',
                            _timers(Timer(loop=True), _STALLS), one_start=True,
                            watched_start=True),
    'wander': Family('timers whose rates wander by 5 % within hours', _timers(Timer(wander=0.05))),
    'large': Family('60 nodes, 250 topics, 2000 messages a second, 1 of 1000 lost', _large),
    'driving_docked': Family('2 min driving, 2 min docked, at random', _driving_docked),
    'day_night': Family('work takes up to 3 times as long, by the time of day',
                        _timers(conditions=Conditions(load_period_s=6 * 3600.0, most_load=3.0))),
    'jittery': Family('periods that vary by 2 %', _timers(Timer(variation=0.02))),
    'wireless': Family('a link on which 1 % of the delays are ten times as long', _wireless),
    'events_only': Family('actions, requests and speech, minutes of idleness', _events_only),
    'bursty': Family('15 to 40 components: timers, chains, trackers in bursts, tasks, speech',
                     _bursty),
    'two_robots': Family('two robots in namespaces', _two_robots),
    'pausing_chains': Family('chains of legs, tracker, anchor, attention, planner that pause '
                             'together', _pausing_chains),
    'dialogue': Family('speech, answers of which a share never comes, minutes of silence',
                       _dialogue),
    'long_pauses': Family('joysticks: seconds of messages, then a minute or two of none',
                          _long_pauses),
    'second_stalls': Family('timers, the same start, six stalls of 0.8 to 1.5 s an hour',
                            _timers(conditions=replace(_STALLS, stall_s=(0.8, 1.5))),
                            one_start=True, watched_start=True),
    'hole': Family('timers; in one of the recordings to train on, a driver is silent for 6 s',
                   flaw=_hole),
    'heads_and_tails': Family('timers; of the recordings to learn from, a driver comes late, and '
                              'another one ends early', flaw=_head_or_tail),
    'rate_modes': Family('20 or 50 Hz driving, 1 or 2 Hz docked, a minute each', _rate_modes),
    'small': Family('two to four nodes: a driver, and who answers to it', _small),
    'servers': Family('two servers with four to six clients each that ask now and then', _servers),
    'lossy': Family('timers; 1 of 5000 messages is lost, however slowly they come',
                    _timers(conditions=Conditions(lost=2e-4, lost_however_slow=2e-4))),
    'near_timers': Family('a driver; IMUs, a laser, a joystick that pause for up to .1, .5, 10 s',
                          _near_timers),
    'everyday': Family('timers and chains; transforms, a latched map, log lines, goals, '
                       'diagnostics', _everyday),
    'one_make': Family('timers; robots of one make with a node of their own each: learned from '
                       'some, watching another', of_make=_of_one_make),
}
