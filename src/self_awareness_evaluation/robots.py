"""The robots that are simulated."""
from __future__ import annotations

from typing import Optional, Tuple

from self_awareness_evaluation import simulated
from self_awareness_evaluation.detectors import scenario_graph
from self_awareness_evaluation.families.protocol import AFTER_DEATH_S, KINDS, Records
from self_awareness_evaluation.records import FAMILIES, NORMAL, OWN, Learning, Robot
from self_awareness_evaluation.windowed_events import WindowedEvents
from self_awareness_follow_me.scenario import load_scenario


def of_family(family: str, seed: int, hours: float, kinds: Tuple[str, ...] = KINDS,
              most: Optional[int] = None, after_death_s: float = AFTER_DEATH_S) -> Robot:
    """Return a robot of a family.

    Args:
        family: one of kinds.FAMILIES.
        seed: of the robot.
        hours: of normal operation.
        kinds: of faults, of protocol.KINDS.
        most: faults of each kind; None: every component in turn.
        after_death_s: a record lasts for so long after the death of who speaks when asked [s].
    """
    records = Records(family, seed)
    return Robot(
        FAMILIES, f'{family} {seed}', records.robot.sources, records.robot.graph,
        records.training, records.calibration, lambda: records.watched(hours),
        lambda: records.faults(kinds, most, after_death_s))


def own(seed: int, faults: Tuple[str, ...]) -> Robot:
    """Return the simulated follow-me robot; faults: kinds of simulation.InducedFault."""
    scenario = load_scenario()

    def normal(name: str, length_s: float) -> WindowedEvents:
        return simulated.normal_record(scenario, seed, name, length_s)

    return Robot(
        OWN, f'{OWN} {seed}', {f'/{spec.name}' for spec in scenario.components},
        scenario_graph(),
        lambda learning: [normal(name, learning.training_s) for name in simulated.TRAINING_NAMES],
        lambda learning: [normal(simulated.CALIBRATION_NAME, learning.calibration_s)],
        lambda: [normal(NORMAL, simulated.NORMAL_TEST_S)],
        lambda: (simulated.fault_record(scenario, seed, kind) for kind in faults))


def own_learning(calibration_s: float) -> Learning:
    """Return what is learned from the own robot: as in the paper, but for the calibration [s]."""
    return Learning(len(simulated.TRAINING_NAMES), simulated.RECORD_S, 1, calibration_s)


def family_of(robot: str) -> str:
    """Return the name of a robot without its seed."""
    return robot.rpartition(' ')[0]
