"""Values that a machine shows, as the words and numbers of a kind of device."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.drivers import FactType, Value
from arboleda_drivers.meaning import Meaning

from .paths import steps


@dataclass(frozen=True, kw_only=True)
class Reading(Meaning):
    """Path to a value, and what the value means.

    `counted`: PyLabRobot counts it by what was ordered, and does not ask the machine; by default where
    nothing is called on the path.
    """

    read: str = ""
    counted: bool | None = None

    @property
    def is_counted(self) -> bool:
        """True for a value of which only PyLabRobot's own count is read."""
        return "()" not in self.read if self.counted is None else self.counted

    def __post_init__(self) -> None:
        steps(self.read)
        super().__post_init__()

    def value_of(self, raw: object, of: FactType) -> Value:
        """The value read, as that type; raises UnreadableValue if it has no meaning there."""
        return self.value(raw, of, self.read or "the result")
