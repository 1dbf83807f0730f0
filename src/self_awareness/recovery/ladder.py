"""Which step of which rule is due, and when: knows neither ROS nor the clock."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Iterable, List, Optional, Sequence, Tuple

from self_awareness.recovery.rules import Rule, Rules, Step, Stop

HOUR_S = 3600.0
SHORTEST_HEALING_S = 5.0
"""What is gone for less than this is not healed [s]: a node that dies again and again is there for
moments."""


@dataclass(frozen=True)
class Fault:
    """What is wrong with a component."""

    incident: int  # id of the one that is open
    component: str  # that is to blame for it, or abnormal besides
    kind: str  # what is wrong with it
    stands: bool  # it is abnormal at this moment; false: the alarm is only held, or waits
    # Of one that has died, when it was first known that it does not come [s]; each time that it
    # comes, this begins anew. Other kinds come and go: it is not known.
    since: float = float('-inf')


@dataclass(frozen=True)
class Order:
    """A step of a rule that is to be done now, its number (1 the first), and why."""

    rule: Rule
    number: int
    step: Step
    fault: Fault


@dataclass
class Climb:
    """How far a rule is with what it mends."""

    rule: Rule
    next_at: float  # when a step may come, if the fault stands then [s]
    tried: int = 0  # steps so far
    gone_since: Optional[float] = None  # when the fault was gone; None: it is there
    gave_up: str = ''  # why nothing more will be done; empty: more will


class Ladder:
    """Decides by rules on one step after the other; times are steady [s], and never go back.

    A fault has to stand for `delay` before the first step, and who has died must not come within
    the `delay` before any step. A step that did not help in time is followed by the next one,
    the last one by itself; each has twice the time of the one before. A rule that has done its
    steps of an hour gives up, until the fault is healed: gone for `delay`, and for
    SHORTEST_HEALING_S at least, without interruption.
    """

    def __init__(self, rules: Rules) -> None:
        self._rules = rules
        self._healing = max(rules.delay, SHORTEST_HEALING_S)
        self._climbs: Dict[Rule, Climb] = {}
        # Of the steps of the last hour, when they were done [s], and for which rules they count.
        self._steps: List[Tuple[float, Sequence[Rule]]] = []
        self._busy: Optional[Order] = None
        self._restarting: Dict[str, float] = {}  # node that a step has stopped: until when
        self._held_until = float('-inf')

    def restore(self, component: str, at: float) -> None:
        """Count a step of before the start: when it was done [s], and for which component."""
        self._steps.append((at, [rule for rule in self._rules.rules
                                 if rule.component == component]))

    def hold(self, until: float) -> None:
        """Order nothing before a time [s]; one in the past ends the hold."""
        self._held_until = until

    def advance(self, now: float, faults: Optional[Sequence[Fault]]) -> Optional[Order]:
        """Return what is to be done now; then done() has to follow.

        Args:
            now: [s].
            faults: all that are open; None: nothing is known, so that nothing is done, and nothing
                is taken for healed.
        """
        if faults is None:
            for climb in self._climbs.values():
                climb.gone_since = None
            self._wait_anew(now)
            return None
        for rule in self._rules.rules:
            self._look(now, rule, faults)
        if now < self._held_until:
            self._wait_anew(now)
            return None
        if self._busy is not None:
            return None
        for rule, climb in sorted(self._climbs.items(), key=lambda item: item[1].next_at):
            fault = _fault_of(rule, faults)
            if fault is not None and fault.stands and climb.next_at <= now and not climb.gave_up:
                climb.gave_up = self._limit_of(now, rule)
                if not climb.gave_up:
                    return self._order(now, rule, climb, fault)
        return None

    def done(self, now: float) -> None:
        """The step that was ordered is done, or has failed."""
        assert self._busy is not None
        order, self._busy = self._busy, None
        climb = self._climbs[order.rule]
        waits_until = now + self._rules.wait * 2.0 ** (climb.tried - 1)
        for rule, each in self._climbs.items():
            if rule.component == order.rule.component:
                each.next_at = max(each.next_at, waits_until)
        self._note_restarts(now, order)

    def climbs(self) -> List[Climb]:
        """Return how the rules are that have something to mend."""
        return list(self._climbs.values())

    def _look(self, now: float, rule: Rule, faults: Sequence[Fault]) -> None:
        """Take in whether there is something to mend for a rule."""
        climb = self._climbs.get(rule)
        if climb is None:
            # Who is silent because the step of another rule has stopped it is no new fault.
            if _fault_of(rule, faults) and self._restarting.get(rule.component, now) <= now:
                # A step of another rule for the same component has its time, too.
                self._climbs[rule] = Climb(rule, max([now + self._rules.delay, *(
                    each.next_at for other, each in self._climbs.items()
                    if other.component == rule.component)]))
        elif any(fault.component == rule.component for fault in faults):
            if climb.gone_since is not None:
                climb.gone_since = None
                climb.next_at = max(climb.next_at, now + self._rules.delay)
            fault = _fault_of(rule, faults)
            if fault is not None:
                climb.next_at = max(climb.next_at, fault.since + self._rules.delay)
        elif self._busy is None or self._busy.rule is not rule:
            if climb.gone_since is None:
                climb.gone_since = now
            if climb.tried == 0 or now - climb.gone_since >= self._healing:
                del self._climbs[rule]

    def _wait_anew(self, now: float) -> None:
        for climb in self._climbs.values():
            climb.next_at = max(climb.next_at, now + self._rules.delay)

    def _limit_of(self, now: float, rule: Rule) -> str:
        """Return why a rule may do nothing more; empty: it may."""
        self._steps = [each for each in self._steps if each[0] > now - HOUR_S]
        own, of_all = sum(rule in rules for _, rules in self._steps), len(self._steps)
        if own >= self._rules.limit:
            return f'{own} actions in an hour, which is the limit'
        if of_all >= self._rules.limit_of_all:
            return f'{of_all} actions of all rules in an hour, which is the limit'
        return ''

    def _order(self, now: float, rule: Rule, climb: Climb, fault: Fault) -> Order:
        at = min(climb.tried, len(rule.steps) - 1)
        step = rule.steps[at]
        climb.tried += 1
        self._steps.append((now, [rule]))
        self._busy = Order(rule, at + 1, step, fault)
        self._note_restarts(now, self._busy)
        return self._busy

    def _note_restarts(self, now: float, order: Order) -> None:
        """Let the nodes that a step stops for another one have the time to start."""
        if not isinstance(order.step, Stop):
            return
        until = now + self._rules.wait
        for node in order.step.nodes:
            if node != order.rule.component:
                self._restarting[node] = until
                for rule, climb in self._climbs.items():
                    if rule.component == node:
                        climb.next_at = max(climb.next_at, until)


def _fault_of(rule: Rule, faults: Iterable[Fault]) -> Optional[Fault]:
    return next((fault for fault in faults if fault.component == rule.component
                 and fault.kind in rule.kinds), None)
