"""What the messages of the simulated robot are besides their time (docs/attributes.md)."""
from __future__ import annotations

import math
from io import BytesIO
from typing import Dict, NamedTuple, Sequence, Tuple

import numpy as np

from self_awareness import pack_attributes
from self_awareness.stamps import SECOND_NS
from self_awareness_follow_me.messages import MessageType
from self_awareness_follow_me.scenario import Scenario
from self_awareness_follow_me.simulation import Event

_HEADER = 16
"""Bytes of a header; the simulated robot names no frames."""


class MessageAttributes(NamedTuple):
    """Of one message.

    Args:
        age_s: since its stamp [s]; infinite: the stamp is 0; NaN: there is no header.
        size: of the whole message [bytes].
        step: of its number since the message before; -1: not known.
        same: whether the bytes behind the header are those of the message before.
    """

    age_s: float
    size: int
    step: int
    same: bool


class AttributeReader:
    """Reads the attributes of messages as the bag reader does: by their bytes.

    Args:
        scenario: the robot.
    """

    def __init__(self, scenario: Scenario) -> None:
        self._types = {datatype: MessageType(datatype)
                       for datatype in scenario.datatypes.values()}
        # By connection, number and content of the message before.
        self._before: Dict[Tuple[str, str], Tuple[int, bytes]] = {}

    def read(self, event: Event) -> MessageAttributes:
        """Return the attributes of the next message."""
        kind = self._types[event.datatype]
        written = BytesIO()
        kind.to_ros(event.message, event.number).serialize(written)
        data = written.getvalue()
        content = data[_HEADER:] if kind.has_header else data
        connection = (event.source, event.topic)
        before = self._before.get(connection)
        self._before[connection] = (event.number, content)
        if before is None:
            return MessageAttributes(_age_s(event, kind), len(data), -1, False)
        return MessageAttributes(_age_s(event, kind), len(data),
                                 event.number - before[0] if kind.has_header else -1,
                                 content == before[1])


def packed(read: Sequence[MessageAttributes]) -> np.ndarray:
    """Return attributes as numbers, uint32, as events have them."""
    return pack_attributes(np.array([each.age_s for each in read], dtype=np.float64),
                           np.array([each.size for each in read], dtype=np.uint64),
                           np.array([each.step for each in read], dtype=np.int64),
                           np.array([each.same for each in read], dtype=bool))


def _age_s(event: Event, kind: MessageType) -> float:
    if not kind.has_header:
        return math.nan
    stamp = event.message.stamp
    return math.inf if stamp == 0 else (event.stamp_ns - stamp) / SECOND_NS
