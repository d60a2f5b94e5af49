"""Random scripts of timed events for the board of the valve of examples/own_board, and what the plant's
virtual board of it says under them."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from random import Random

from arboleda.kinds.declared import Device
from arboleda.plant_file.loader import load
from arboleda.sim.board import Board
from arboleda.sim.body import BodyReport
from arboleda.sim.machine import MachineBody

from .author import FIRST_BOOT, AnyAuthor
from .virtual import Virtual

CHANNELS = ("orden", "paro", "latido")
PLANT = Path(__file__).parents[2] / "examples/own_board/plant.yaml"
VALUES: dict[str, tuple[dict[str, object], ...]] = {
    "open": ({},),
    "close": ({},),
    "level": ({},),
    "dose": ({"ml": 5}, {"ml": 10}, {"ml": 5}, {"ml": 7}, {"ml": 5.0}, {"ml": True}, {"ml": "5"}, {}),
}


@cache
def valve() -> Device:
    """The device, as its plant file declares it."""
    found = load(PLANT).robots["valve"]
    assert isinstance(found, Device)
    return found


class Author(AnyAuthor):
    """Of scripts for the board of the valve."""

    channels = CHANNELS

    def __init__(self, seed: int) -> None:
        super().__init__(Random(seed))

    def script(self) -> list[str]:
        """Its lines."""
        lines = [f"boot {self.now_us} {FIRST_BOOT}", f"{self.now_us} connect 1", *self.events(5, 30)]
        return [*lines, f"{self.now_us} connect 1"]

    def _event(self) -> str:
        if self.chance.random() < 0.93:
            return self._message_on(self.chance.choices(CHANNELS, (70, 15, 15))[0])
        self._boot += 1
        return self._mishap(f"reboot {self._boot}", "fail", "repair", "repair", "connect 0", "connect 1")

    def _body(self, channel: str) -> dict[str, object]:
        if channel == "orden":
            verb = self.chance.choice((*VALUES, "dose", "open", "fly"))
            values = self.chance.choice(VALUES.get(verb, ({}, {"ml": 5})))
            stray = self.chance.random() < 0.03
            given = {**values, **({"stray": 1} if stray else {})}
            return {"verbo": verb, **({"valores": given} if given or self.chance.random() < 0.2 else {})}
        return {"paro": self.chance.choice((0, 0, 0, 1, 2, 3))} if channel == "paro" else {}

    def _stamp(self, channel: str) -> dict[str, object]:
        fate = self.chance.random()
        if fate < 0.05:
            self._epoch += self.chance.randint(-1, 2)
        self._seq = max(self._seq + (1 if fate < 0.8 else self.chance.randint(-9, 2)), 0)
        if channel == "latido":
            return self._beaten()
        if fate > 0.97:
            odd: tuple[dict[str, object], ...] = ({}, {"seq": self._seq}, {"seq": "1", "epoca": self._epoch})
            return self.chance.choice(odd)
        return {"seq": self._seq, "epoca": self._epoch}


class Forgetting(MachineBody):
    """A device whose facts are in its board's memory: a reset forgets them all. The core has no whole numbers
    where a fact is a number: 5 is said as 5.0."""

    def reset(self) -> None:
        super().reset()
        self.facts = {name: type.first for name, type in self.kind.facts.items()}

    def tell(self) -> BodyReport:
        types = self.kind.facts
        return BodyReport(
            facts=tuple(
                (name, float(value) if types[name].type is float else value)
                for name, value in self.facts.items()
            )
        )


class Reference(Virtual):
    """The virtual board of the valve, told the lines of a script."""

    def __init__(self, now_us: int) -> None:
        board = Board(valve(), Forgetting(valve().kind), boot_id=FIRST_BOOT, now_us=now_us)
        super().__init__(valve(), board, now_us, CHANNELS)
