"""Person at the cell, who is asked something and answers on one of the plant's screens."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.model.commands import Question
from arboleda.model.messages import Report
from arboleda.model.plant_model import Evidence, Link, Robot

PATIENCE_S = 600.0  # a question without a deadline of its own waits so long


@dataclass(frozen=True, kw_only=True)
class AskPerson(Question):
    """A question with the answers that can be given, for at most `patience_s` s."""

    question: str
    offered: tuple[str, ...]
    patience_s: float = PATIENCE_S

    @property
    def text(self) -> str:
        return self.question

    @property
    def answers(self) -> tuple[str, ...]:
        return self.offered

    @property
    def at_most_s(self) -> float:
        return self.patience_s


@dataclass(frozen=True, kw_only=True)
class Person(Robot):
    """Person who is always there, as far as the plant knows; never lost, homed or held."""

    @property
    def kind_name(self) -> str:
        return "person"

    @property
    def homes(self) -> bool:
        return False

    @property
    def works(self) -> bool:
        return False

    def objection(self, report: Report) -> str | None:
        return None


def person(name: str) -> Person:
    """A person with this name."""
    return Person(
        name=name, mqtt=name, link=Link.SCREEN, evidence=Evidence.IDS, timeout_s=PATIENCE_S, has_stop=True
    )
