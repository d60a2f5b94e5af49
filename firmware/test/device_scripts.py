"""Random scripts of timed events for the board of the valve of examples/own_board, and what the plant's
virtual board of it says under them."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from random import Random

from arboleda.app.config import load
from arboleda.kinds.declared import Device
from arboleda.sim.board import Board
from arboleda.sim.body import Told
from arboleda.sim.machine import MachineBody
from arboleda.wire.epochs import AHEAD_S
from arboleda.wire.strict import UINT32
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Delivery

from .scripts import Ear

CHANNELS = ("orden", "paro", "latido")
PLANT = Path(__file__).parents[2] / "examples/own_board/plant.yaml"
FIRST_BOOT = 100
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


class Author:
    """Writes one script; the same seed, the same script."""

    def __init__(self, seed: int) -> None:
        self.chance = Random(seed)
        self.now_us = self.chance.choice((1_000_000, 2**32 - 2_000_000, 2**40))
        self._seq, self._epoch, self._boot = 0, 7, FIRST_BOOT
        self._ear = Ear(self.chance)

    def script(self) -> list[str]:
        """Its lines."""
        lines = [f"{self.now_us} boot {FIRST_BOOT}", f"{self.now_us} connect 1"]
        for _ in range(self.chance.randint(5, 30)):
            pause_us = self._pause_us()
            self.now_us += pause_us
            self._ear.listen(pause_us)
            lines.append(f"{self.now_us} {self._event()}")
        self.now_us += self.chance.choice((10_000, 3_000_000))
        return [*lines, f"{self.now_us} connect 1"]

    def _pause_us(self) -> int:
        kinds = ((0, 3), (1, 2_000), (1_000, 300_000), (100_000, 1_500_000), (100_000, 2_400_000))
        return self.chance.randint(*self.chance.choice(kinds))

    def _event(self) -> str:
        if self.chance.random() < 0.93:
            return self._message()
        self._boot += 1
        reboot = f"reboot {self._boot}"
        event = self.chance.choice((reboot, "fail", "repair", "repair", "connect 0", "connect 1"))
        if event == reboot:
            self._ear.reboot()
        return event

    def _message(self) -> str:
        channel = self.chance.choices(CHANNELS, (70, 15, 15))[0]
        raw = json.dumps({**self._body(channel), **self._stamp(channel), **self._ear.heard()}).encode()
        if self.chance.random() < 0.05:
            raw = self._damaged(raw)
        retained = int(self.chance.random() < 0.04)
        return f"message {CHANNELS.index(channel)} {retained} {raw.hex()}"

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
            ahead = self.chance.choices(
                (0, 1, AHEAD_S, AHEAD_S + 1, UINT32 - self._epoch), (60, 10, 1, 3, 3)
            )[0]
            return {"epoca": self._epoch + ahead}
        if fate > 0.97:
            return self.chance.choice(({}, {"seq": self._seq}, {"seq": "1", "epoca": self._epoch}))
        return {"seq": self._seq, "epoca": self._epoch}

    def _damaged(self, raw: bytes) -> bytes:
        at = self.chance.randrange(len(raw))
        return raw[:at] + self.chance.choice((b"", b"x", b"{", b'"', b"\xff")) + raw[at + 1 :]


class Forgetting(MachineBody):
    """A device whose facts are in its board's memory: a reset forgets them all. The core has no whole numbers
    where a fact is a number: 5 is said as 5.0."""

    def reset(self) -> None:
        super().reset()
        self.facts = {name: type.first for name, type in self.kind.facts.items()}

    def tell(self) -> Told:
        types = self.kind.facts
        return Told(
            facts=tuple(
                (name, float(value) if types[name].type is float else value)
                for name, value in self.facts.items()
            )
        )


class Reference:
    """The virtual board, told the lines of a script."""

    def __init__(self) -> None:
        self.said: list[str] = []

    def run(self, lines: list[str]) -> list[str]:
        """What the board said, a line each: time, kind, payload."""
        for line in lines:
            at_us, what, *words = line.split()
            if what == "boot":
                self.now_us = int(at_us)
                self.board = Board(
                    valve(), Forgetting(valve().kind), boot_id=int(words[0]), now_us=self.now_us
                )
                continue
            self._until(int(at_us))
            getattr(self, f"_{what}")(*words)
            self._collect()
            self._until(int(at_us))
        return self.said

    def _until(self, until_us: int) -> None:
        while (due_us := self.board.next_deadline_us) is not None and due_us <= until_us:
            self._advance(max(due_us, self.now_us))
        self._advance(until_us)

    def _advance(self, now_us: int) -> None:
        self.now_us = now_us
        self.board.advance(now_us)
        self._collect()

    def _collect(self) -> None:
        for sent in self.board.take():
            kind = "P" if sent.retain else "S"
            self.said.append(f"{self.now_us} {kind} {sent.payload.decode()}")

    def _message(self, channel: str, retained: str, raw: str = "") -> None:
        where = topic(valve().mqtt, Channel(CHANNELS[int(channel)]))
        payload = bytes.fromhex(raw)
        delivery = Delivery(at=0.0, topic=where, payload=payload, retain=retained == "1")
        self.board.receive(self.now_us, delivery)

    def _connect(self, up: str) -> None:
        self.board.connect(self.now_us, up == "1")

    def _reboot(self, boot_id: str) -> None:
        self.board.reboot(self.now_us, int(boot_id))

    def _fail(self) -> None:
        self.board.fail(self.now_us)

    def _repair(self) -> None:
        self.board.repair(self.now_us)
