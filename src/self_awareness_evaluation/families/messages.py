"""What the messages of a simulated robot are besides their time: honest (docs/method.md, 3.10).

Stamps are a little older than the messages, numbers count them, and sizes and contents are those
of their types: some have one size, some vary, and some say the same again and again.
"""
from __future__ import annotations

import zlib

import numpy as np

from self_awareness import pack_attributes
from self_awareness_evaluation.families.scene import Scene

_HEADERS = 0.7  # share of the outputs whose messages have a header
_VARYING = 0.4  # of those whose sizes vary
_REPEATING = 0.3  # of those that repeat themselves
_PROCESSED_S = (0.001, 0.08)  # how old stamps are
_BYTES = (20.0, 1e6)
_JITTER = 0.2  # standard deviation of the logarithm of an age
_MOST_SPREAD = 0.5  # the same of sizes that vary
_HELD_S = (0.2, 60.0)  # mean time with the same content, of those that repeat themselves


def has_header(datatype: str, index: int) -> bool:
    """Return whether the messages of an output have a header, and so stamps and numbers."""
    return bool(_of_robot(datatype, index).uniform() < _HEADERS)


def attributes(datatype: str, scene: Scene, index: int, times: np.ndarray,
               numbers: np.ndarray, on_the_way_s: np.ndarray) -> np.ndarray:
    """Return the attributes of messages as they are heard (pack_attributes).

    Args:
        datatype, index: of the output.
        scene: decides what is random.
        times, numbers: when the messages come [s], and how many were sent before.
        on_the_way_s: how long they took [s].
    """
    of_robot = _of_robot(datatype, index)
    rng = scene.of_recording(f'attributes {index}')
    with_header, varies, repeats = of_robot.uniform(size=3) < (_HEADERS, _VARYING, _REPEATING)
    age_s = np.exp(of_robot.uniform(*np.log(_PROCESSED_S)))
    size = np.exp(of_robot.uniform(*np.log(_BYTES)))
    held_s = np.exp(of_robot.uniform(*np.log(_HELD_S)))
    count = len(times)
    ages = age_s * np.exp(_JITTER * rng.normal(size=count)) * scene.load(times) + on_the_way_s
    spread = of_robot.uniform(0.05, _MOST_SPREAD) if varies else 0.0
    sizes = np.maximum(size * np.exp(spread * rng.normal(size=count)), 1.0)
    steps = np.diff(numbers, prepend=numbers[:1] - 1)
    steps[:1] = -1
    gaps = np.diff(times, prepend=times[:1])
    same = (rng.uniform(size=count) < np.exp(-gaps / held_s)) & (repeats & ~varies)
    same[:1] = False
    if not with_header:
        ages = np.full(count, np.nan)
        steps = np.full(count, -1)
    return pack_attributes(ages, sizes.astype(np.uint64), steps, same)


def _of_robot(datatype: str, index: int) -> np.random.Generator:
    return np.random.default_rng((zlib.crc32(datatype.encode()), index))
