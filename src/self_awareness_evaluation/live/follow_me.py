"""The simulated follow-me robot as processes: started, broken and mended."""
from __future__ import annotations

import contextlib
import itertools
import subprocess
from typing import Dict, Iterable, Iterator, List, Optional, Sequence, Tuple

from self_awareness_evaluation.live.processes import (STARTED_WITHIN_S, WARM_UP_S, Processes,
                                                      await_condition, wait)
from self_awareness_evaluation.live.rows import CRASH, DOUBLE, HALF, HANG
from self_awareness_evaluation.live.session import Broken, heard, listening, stopped
from self_awareness_evaluation.simulated import default_faults
from self_awareness_follow_me import induction
from self_awareness_follow_me.effects import Crash, Intruder, Silence
from self_awareness_follow_me.faults import effect_of
from self_awareness_follow_me.scenario import load_scenario


class FollowMe:
    """The robot at some speed; `rospy.init_node` has been called."""

    def __init__(self, processes: Processes, seed: int, speed: float = 1.0,
                 respawn: bool = False) -> None:
        """Start nothing yet; seed: of all starts, each of which has another one of its own; speed:
        in its usual one; respawn: roslaunch starts nodes again that end."""
        self._scenario = load_scenario()
        self._processes = processes
        self._seeds = itertools.count(1000 * seed + 1)
        self._speed = speed
        self._respawn = respawn
        self._running: Optional[subprocess.Popen] = None
        crashes = [name.partition(':')[2] for name in default_faults(self._scenario)
                   if name.startswith(f'{CRASH}:')]
        # One topic of each component that publishes all the time.
        self.topics: Dict[str, str] = {
            name: f'/{next(iter(self._scenario.component(name).outputs()))}' for name in crashes}

    def start(self) -> None:
        """Start all; wait until they do what they do all the time, or raise LiveError."""
        with heard(self._expected(self.topics)):
            self._running = self._processes.start(
                'robot', 'roslaunch', '--wait', 'self_awareness', 'follow_me.launch',
                f'seed:={next(self._seeds)}', f'speed:={self._speed:g}',
                f'respawn:={str(self._respawn).lower()}')
        wait(WARM_UP_S, 'warming up')

    def end(self) -> None:
        if self._running is not None:
            self._processes.end(self._running)
            self._running = None

    def culprits(self, name: str) -> Tuple[str, ...]:
        """Return the sources to blame for the fault of that name."""
        kind, _, component = name.partition(':')
        return (f'/{component}',) if kind == HANG else effect_of(self._scenario, name).culprits

    def possible(self) -> List[str]:
        """Return the faults that can hit at random: those of every regular component. Components
        that only speak now and then are left out: they may be silent for seconds."""
        found = []
        for name in (f'{kind}:{component}' for component in self.topics
                     for kind in (CRASH, HANG, HALF, DOUBLE)):
            with contextlib.suppress(ValueError):  # too busy to do as much twice as often
                self.culprits(name)
                found.append(name)
        return found

    def broken(self, name: str) -> Broken:
        """Return what induces and undoes a fault. Who was killed is started again, if roslaunch
        does not do it, and heard; the whole robot, too, if all were. It raises InduceError if it
        cannot be induced, and LiveError if who was killed is not heard again."""
        kind, _, component = name.partition(':')
        if kind == HANG:
            return stopped(induction.process_id(f'/{component}'))
        effect = effect_of(self._scenario, name)
        if isinstance(effect, Crash):
            return self._killed(effect)
        if isinstance(effect, Silence):
            return self._silenced()
        if isinstance(effect, Intruder):
            return self._intruded(effect)
        return induction.lasting(effect, name)

    @contextlib.contextmanager
    def _killed(self, effect: Crash) -> Iterator[None]:
        name = effect.component
        induction.crash(effect)
        yield
        with heard(self._expected([name] if name in self.topics else [])):
            if not self._respawn:
                self._processes.start(
                    name, 'rosrun', 'self_awareness', 'component', name, '--seed',
                    str(next(self._seeds)), '--speed', f'{self._speed:g}', f'__name:={name}')

    @contextlib.contextmanager
    def _silenced(self) -> Iterator[None]:
        induction.silence(self._scenario)
        yield
        self.end()
        self.start()

    @contextlib.contextmanager
    def _intruded(self, effect: Intruder) -> Iterator[float]:
        source, = effect.culprits
        topic = f'/{next(iter(effect.spec.outputs()))}'
        with listening([topic]) as last, induction.intruding(effect):
            # It takes seconds to start: the fault begins with its first message.
            await_condition(f'{source} publishes {topic}', lambda: last(source, topic) > 0.0,
                            STARTED_WITHIN_S)
            yield last(source, topic)

    def _expected(self, components: Iterable[str]) -> Sequence[Tuple[str, str]]:
        return [(f'/{name}', self.topics[name]) for name in components]
