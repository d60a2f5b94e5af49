"""Faults that people had happen to virtual devices, as the plant was told of them."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from arboleda.model.messages import FaultByHand
from arboleda.model.sentence import Sentence

KEPT = 20


@dataclass(frozen=True, kw_only=True)
class NumberedFault:
    """One such fault that began, or is over, `at` s of the plant's clock; `number` grows with each."""

    number: int
    at: float
    robot: str
    sentence: Sentence


class ProvokedFaults:
    """The last ones, oldest first."""

    def __init__(self) -> None:
        self.last: deque[NumberedFault] = deque(maxlen=KEPT)
        self._count = 0

    def note(self, fault: FaultByHand) -> None:
        """Take one in."""
        self._count += 1
        numbered = NumberedFault(number=self._count, at=fault.at, robot=fault.robot, sentence=fault.sentence)
        self.last.append(numbered)
