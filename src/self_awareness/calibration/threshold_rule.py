"""Chooses the threshold s* of eq. 5 on the ROC over windows (section III-D)."""
from __future__ import annotations

import math
import re
from dataclasses import dataclass

from self_awareness import Roc, RocPoint


@dataclass(frozen=True)
class ThresholdRule:
    """How the threshold is chosen: youden, closest, or fpr with a rate from 0 to less than 1."""

    method: str
    rate: float = 0.0

    @classmethod
    def parse(cls, text: str) -> ThresholdRule:
        """Read youden, closest or fpr=RATE.

        Raises:
            ValueError: another word, or a rate out of range.
        """
        if text in ('youden', 'closest'):
            return cls(text)
        match = re.fullmatch(r'fpr=(\d*\.?\d+(?:[eE]-?\d+)?)', text)
        if match is None or not float(match[1]) < 1.0:
            raise ValueError('expected youden, closest or fpr=RATE with 0 <= RATE < 1, '
                             f'not {text}')
        return cls('fpr', float(match[1]))

    def __str__(self) -> str:
        return f'fpr={self.rate:g}' if self.method == 'fpr' else self.method

    def choose(self, roc: Roc) -> RocPoint:
        """Return the point of the ROC.

        Raises:
            ValueError: the method needs abnormal windows and there are none, or no finite cut-off
                is better than to call every window normal, or every window abnormal, or more
                normal windows are silent than may be called abnormal.
        """
        if self.method != 'fpr' and math.isnan(roc.auc):
            raise ValueError(f'--cutoff {self} needs abnormal windows: name recordings of faults '
                             '(--faulty), let some be made (--inject), or choose by normal '
                             'windows alone (--cutoff fpr=RATE)')
        if self.method == 'fpr':
            point = roc.level(self.rate)
            # Silence scores 0, and no score is lower: nothing would be below such a threshold.
            if point.cutoff <= 0.0:
                raise ValueError(f'--cutoff {self} finds no threshold: a larger share of the '
                                 'normal windows than this scores 0, as silence does, and none '
                                 'scores less; allow a higher rate')
            return point
        point = roc.youden() if self.method == 'youden' else roc.closest()
        if not math.isfinite(point.cutoff):
            raise ValueError(f'--cutoff {self} finds no threshold: the scores of abnormal windows '
                             f'are not below the normal ones (AUC {roc.auc:.3f}); these faults '
                             'cannot be told by the score, so leave them out or choose by normal '
                             'windows alone (--cutoff fpr=RATE)')
        return point
