"""Which step comes when, with made-up time."""
from __future__ import annotations

from typing import Dict, Iterable, List, Optional, Tuple

import pytest
from hypothesis import given, settings, strategies

from self_awareness.recovery.ladder import HOUR_S, SHORTEST_HEALING_S, Fault, Ladder, Order
from self_awareness.recovery.rules import Call, Rule, Rules, Stop

PLAYER = Rule('/player', ('silent',), (Call('/player/reset'), Stop(('/player',)),
                                       Stop(('/player', '/slam'))))
SLAM = Rule('/slam', ('silent', 'slow'), (Stop(('/slam',)),))
STOP_BOTH = Rule('/player', ('silent',), (Stop(('/player', '/slam')),))
DELAY, WAIT = 5.0, 20.0
TICK = 0.5


def ladder(*rules: Rule, limit: int = 10, limit_of_all: int = 20, delay: float = DELAY) -> Ladder:
    return Ladder(Rules(rules or (PLAYER,), delay, WAIT, limit=limit, limit_of_all=limit_of_all))


def fault(component: str = '/player', kind: str = 'silent', incident: int = 1) -> Fault:
    return Fault(incident, component, kind, True)


def climb(tested: Ladder, begin: float, end: float, faults: Optional[Iterable[Fault]] = (fault(),)
          ) -> List[Tuple[float, str]]:
    """Let time pass, every step take no time; return what was ordered when."""
    ordered = []
    for tick in range(int((end - begin) / TICK)):
        now = begin + tick * TICK
        order = tested.advance(now, None if faults is None else list(faults))
        if order is not None:
            ordered.append((now, str(order.step)))
            tested.done(now)
    return ordered


def test_a_fault_has_to_stand_for_the_delay_then_each_step_has_twice_the_time() -> None:
    assert climb(ladder(), 0.0, 200.0) == [
        (DELAY, 'call /player/reset'),
        (DELAY + WAIT, 'stop /player'),
        (DELAY + 3.0 * WAIT, 'stop /player, /slam'),
        (DELAY + 7.0 * WAIT, 'stop /player, /slam')]


def test_who_comes_again_within_the_delay_is_left_alone() -> None:
    """It works, but slowly: every gap of it is a death to the monitor."""
    def dead(since: float) -> List[Fault]:
        return [Fault(1, '/player', 'silent', True, since)]

    tested = ladder()
    for tick in range(200):
        now = tick * TICK
        assert tested.advance(now, dead(now - now % (DELAY - TICK))) is None
    assert climb(tested, 100.0, 101.0 + DELAY, dead(100.0)) == [
        (100.0 + DELAY, 'call /player/reset')]
    # Between two steps, too.
    begin = 100.0 + DELAY + WAIT - 1.0
    assert climb(tested, begin, begin + DELAY + 1.0, dead(begin)) == [
        (begin + DELAY, 'stop /player')]


@pytest.mark.parametrize('gone, step', [(SHORTEST_HEALING_S - TICK, 'stop /player'),
                                        (SHORTEST_HEALING_S + TICK, 'call /player/reset')])
def test_healed_is_what_is_gone_for_long_enough(gone: float, step: str) -> None:
    tested = ladder(delay=0.0)
    assert climb(tested, 0.0, 1.0) == [(0.0, 'call /player/reset')]
    assert climb(tested, 1.0, 1.0 + gone, ()) == []
    assert [what for _, what in climb(tested, 1.0 + gone, 1.0 + gone + WAIT)][:1] == [step]


def test_what_comes_back_has_to_stand_for_the_delay_again() -> None:
    tested = ladder()
    assert climb(tested, 0.0, WAIT + 4.0) == [(DELAY, 'call /player/reset')]
    assert climb(tested, WAIT + 4.0, WAIT + 6.0, ()) == []
    assert climb(tested, WAIT + 6.0, 2.0 * WAIT) == [(WAIT + 6.0 + DELAY, 'stop /player')]


def test_another_kind_of_fault_of_the_same_component_is_not_healed() -> None:
    tested = ladder()
    assert len(climb(tested, 0.0, DELAY + 1.0)) == 1
    assert climb(tested, DELAY + 1.0, 100.0, [fault(kind='slow')]) == []
    assert tested.climbs()[0].tried == 1


def test_who_does_not_help_gives_up_at_the_limit_and_says_so_until_it_is_healed() -> None:
    tested = ladder(limit=2)
    assert len(climb(tested, 0.0, 3.0 * HOUR_S)) == 2
    standing, = tested.climbs()
    assert standing.gave_up == '2 actions in an hour, which is the limit'
    now = 3.0 * HOUR_S
    assert climb(tested, now, now + 2.0 * DELAY, ()) == []
    assert tested.climbs() == []
    assert len(climb(tested, now + 2.0 * DELAY, now + 4.0 * DELAY)) == 1


def test_all_rules_together_have_a_limit() -> None:
    tested = ladder(PLAYER, SLAM, limit=10, limit_of_all=3)
    assert len(climb(tested, 0.0, HOUR_S, [fault(), fault('/slam', incident=2)])) == 3
    assert {each.gave_up for each in tested.climbs()} == {
        '3 actions of all rules in an hour, which is the limit'}


def test_steps_of_before_the_start_count() -> None:
    tested = ladder(limit=2)
    tested.restore('/player', -HOUR_S)
    tested.restore('/player', -10.0)
    tested.restore('/slam', -5.0)
    assert len(climb(tested, 0.0, 1000.0)) == 1


def test_a_hold_lets_the_delay_begin_anew() -> None:
    tested = ladder()
    tested.hold(50.0)
    assert climb(tested, 0.0, 50.0) == []
    assert climb(tested, 50.0, 60.0)[0][0] == 50.0 + DELAY - TICK
    tested = ladder()
    tested.hold(1000.0)
    assert climb(tested, 0.0, 20.0) == []
    tested.hold(20.0)
    assert len(climb(tested, 20.0, 30.0)) == 1


def test_what_is_not_known_is_neither_mended_nor_healed() -> None:
    tested = ladder()
    assert climb(tested, 0.0, DELAY) == []
    assert climb(tested, DELAY, 100.0, None) == []
    assert climb(tested, 100.0, 100.0 + DELAY - TICK) == []
    assert climb(tested, 100.0 + DELAY - TICK, 101.0 + DELAY) != []
    assert climb(tested, 110.0, 200.0, None) == []
    assert tested.climbs()[0].tried == 1


def test_who_is_silent_because_it_was_stopped_for_another_is_no_fault() -> None:
    tested = ladder(STOP_BOTH, SLAM, delay=0.0)
    assert climb(tested, 0.0, TICK) == [(0.0, 'stop /player, /slam')]
    of_slam = [fault('/slam', incident=2)]
    assert climb(tested, TICK, WAIT, of_slam) == []
    assert climb(tested, WAIT, WAIT + TICK, of_slam) == [(WAIT, 'stop /slam')], 'not back'


def test_a_step_that_takes_long_leaves_others_their_time_from_its_end() -> None:
    tested = ladder(STOP_BOTH, SLAM, delay=0.0)
    both = [fault(), fault('/slam', incident=2)]
    order = tested.advance(0.0, both)
    assert order is not None and order.rule is STOP_BOTH
    tested.done(15.0)
    of_slam = both[1:]
    assert climb(tested, 15.0, 15.0 + WAIT, of_slam) == [], 'it was a fault of its own before'
    assert climb(tested, 15.0 + WAIT, 16.0 + WAIT, of_slam) == [(15.0 + WAIT, 'stop /slam')]


def test_rules_of_one_component_have_one_time() -> None:
    reset = Rule('/player', ('slow',), (Call('/player/reset'),))
    tested = ladder(reset, PLAYER)
    assert climb(tested, 0.0, DELAY + TICK, [fault(kind='slow')]) == [
        (DELAY, 'call /player/reset')]
    # It is silent while it resets itself.
    assert climb(tested, DELAY + TICK, DELAY + WAIT) == []
    assert climb(tested, DELAY + WAIT, DELAY + WAIT + TICK) == [
        (DELAY + WAIT, 'call /player/reset')]


_COMPONENTS = ('/player', '/slam')
_MOMENTS = strategies.lists(
    strategies.tuples(
        strategies.floats(0.0, 400.0),  # until the next moment [s]
        strategies.one_of(
            strategies.none(),
            strategies.lists(strategies.builds(
                Fault, strategies.just(1), strategies.sampled_from(_COMPONENTS),
                strategies.sampled_from(['silent', 'slow']), strategies.booleans()), max_size=3)),
        strategies.booleans(),  # whether a step that is done ends here
        strategies.sampled_from([0.0, 0.0, 0.0, 100.0])),  # hold so long [s]
    max_size=60)


@settings(max_examples=200, deadline=None, derandomize=True, database=None)
@given(moments=_MOMENTS, limit=strategies.integers(1, 3), limit_of_all=strategies.integers(1, 4),
       delay=strategies.sampled_from([0.0, 5.0]))
def test_whatever_happens_the_promises_hold(
        moments: List[Tuple[float, Optional[List[Fault]], bool, float]], limit: int,
        limit_of_all: int, delay: float) -> None:
    tested = Ladder(Rules((PLAYER, SLAM), delay, WAIT, limit=limit, limit_of_all=limit_of_all))
    now = held_until = 0.0
    busy = False
    ordered: List[Tuple[float, Order]] = []
    since: Dict[str, float] = {}  # component: for how long an incident of it has been open
    for passes, faults, ends, hold in moments:
        now += passes
        if hold:
            held_until = now + hold
            tested.hold(held_until)
        if busy and ends:
            tested.done(now)
            busy = False
        order = tested.advance(now, faults)
        if faults is None:  # what was open may still be, but has to stand anew
            since = dict.fromkeys(since, now)
        else:
            since = {each.component: since.get(each.component, now) for each in faults}
        if order is None:
            continue
        assert not busy and now >= held_until
        busy = True
        assert faults and order.fault in faults and order.fault.stands
        assert order.fault.kind in order.rule.kinds
        assert order.rule.component == order.fault.component
        assert now - since[order.rule.component] >= delay
        ordered.append((now, order))
        for rule, most in ((PLAYER, limit), (SLAM, limit), (None, limit_of_all)):
            assert sum(at > now - HOUR_S and rule in (None, each.rule)
                       for at, each in ordered) <= most
