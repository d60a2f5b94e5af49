"""Mishaps: what a person can have go wrong by a button or a word, each made of faults of the simulator."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from arboleda.model.plant_model import PlantModel
from arboleda.recipes import Phrase, Sentence

from .faults import KINDS, OF_BOARDS, Fault
from .faults.titles import title


@dataclass(frozen=True, kw_only=True)
class Mishap:
    """One mishap: `faults` are the kinds that begin at once, each with the word of its form.

    `lasts`: for as long as the person says; `amount` is that of its faults. `longer` is the mishap that an
    instant one becomes where it is to last, "" where there is none.
    """

    name: str
    phrase: Phrase
    faults: tuple[tuple[str, str], ...]
    lasts: bool = True
    amount: float = 0.0
    longer: str = ""

    def targets(self, model: PlantModel) -> tuple[str, ...]:
        """Whom it can befall in this plant, as the simulator names them."""
        return tuple(
            target
            for target in KINDS[self.faults[0][0]].targets(model)
            if all(_possible(model, each) for each in self.of(target, at=0.0, seconds=1.0))
        )

    def of(self, target: str, *, at: float, seconds: float) -> tuple[Fault, ...]:
        """Its faults, for one target."""
        lasting = seconds if self.lasts else 0.0
        return tuple(
            Fault(kind=kind, at=at, seconds=lasting, target=target, word=word, amount=self.amount)
            for kind, word in self.faults
        )

    @property
    def sentence(self) -> Sentence:
        """The mishap in words."""
        return self.phrase()

    @property
    def is_of_boards(self) -> bool:
        """True if it needs boards and their connections alone, as a real start has them."""
        return all(kind in OF_BOARDS for kind, _ in self.faults)


def _possible(model: PlantModel, fault: Fault) -> bool:
    return KINDS[fault.kind].objection(fault, model) is None


def _mishap(
    name: str,
    *faults: tuple[str, str],
    english: str = "",
    lasts: bool = True,
    amount: float = 0.0,
    longer: str = "",
) -> Mishap:
    phrase = Phrase(f"mishap.{name}", english or title(*faults[0]))
    return Mishap(name=name, phrase=phrase, faults=faults, lasts=lasts, amount=amount, longer=longer)


MISHAPS = {
    each.name: each
    for each in (
        _mishap("reboot", ("reboot", "will"), lasts=False, longer="no_power"),
        _mishap("cut_link", ("partition", "up, lost"), ("partition", "down, lost")),
        _mishap("slow_link", ("delay", "up"), ("delay", "down"), amount=0.7),
        _mishap("no_power", ("brown_out", "")),
        _mishap("freeze", ("board_stall", "")),
        _mishap("driver_alarm", ("driver_alarm", "")),
        _mishap("lost_part", ("lost_part", ""), lasts=False),
        _mishap("no_part", ("no_part", "")),
        _mishap("no_grip", ("no_grip", "")),
        _mishap("stuck_effector", ("stuck_effector", "")),
        _mishap("opened_effector", ("opened_effector", ""), lasts=False),
        _mishap("lost_steps", ("lost_steps", "q1"), lasts=False, amount=40.0),
        _mishap("jam", ("gives_up", "atasco")),
        _mishap("busy", ("refuses", "ocupado")),
        _mishap("slow", ("ends_late", ""), english="It takes 5 s longer", amount=5.0),
        _mishap("never_ends", ("never_ends", "")),
        _mishap("only_says_done", ("only_says_done", "")),
        _mishap("opened_device", ("opened_device", ""), lasts=False),
        _mishap("broker_restart", ("broker_restart", "")),
        _mishap("bridge_restart", ("bridge_restart", "")),
        _mishap("plant_crash", ("plant_crash", ""), lasts=False),
    )
}


def possible(model: PlantModel) -> Iterator[tuple[str, dict[str, Any]]]:
    """Whom something can befall, robots by their names in the order of the file, with the mishaps of each:
    {target, mishaps}."""
    named = {robot.mqtt: robot.name for robot in model.robots.values()}
    by_target: dict[str, list[str]] = {target: [] for target in named}
    for mishap in MISHAPS.values():
        for target in mishap.targets(model):
            by_target.setdefault(target, []).append(mishap.name)
    for target, mishaps in by_target.items():
        if mishaps:
            yield named.get(target, target), {"target": target, "mishaps": mishaps}
