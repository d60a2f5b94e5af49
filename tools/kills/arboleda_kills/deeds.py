"""Deeds of arms, as the boards tell them."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from enum import Enum
from typing import Any

PICK_UP, STATION = "pick-up", "station "  # how the names of poses begin
ALONE = ", where the mobile robot is not"  # after the name of a pick-up


class Did(str, Enum):
    PICKED = "picked"
    LET_GO = "let_go"
    WAS_TOLD = "was_told"


@dataclass(frozen=True, kw_only=True)
class Deed:
    """At a Unix time; `what`: the pose at which the arm stood, or the kind of command that it was told."""

    at: float
    cell: str
    robot: str
    did: Did
    what: str

    def data(self) -> dict[str, Any]:
        """As JSON has it."""
        return asdict(self) | {"did": self.did.value}

    @classmethod
    def of(cls, data: dict[str, Any]) -> Deed:
        """From what `data` made."""
        return cls(**data | {"did": Did(data["did"])})
