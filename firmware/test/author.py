"""What authors of random scripts have in common: times, messages, what was heard of the board."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from random import Random

from arboleda.sim.uplink import PERIOD_US
from arboleda.wire.epochs import AHEAD_S
from arboleda.wire.strict import UINT32

FIRST_BOOT = 100


class Ear:
    """Draws what commands say that was heard of a board. How much it has told since its boot is a guess: who
    writes its script cannot know."""

    def __init__(self, chance: Random) -> None:
        self._chance = chance
        self._told = 1

    def listen(self, pause_us: int) -> None:
        """The board tells in each period, and of the event that comes then."""
        self._told += pause_us // PERIOD_US + 1

    def reboot(self) -> None:
        self._told = 1

    def token(self) -> dict[str, object]:
        """`ficha`, or nothing of it."""
        kind = self._chance.choices(("none", "good", "bad"), (40, 55, 5))[0]
        good = "".join(self._chance.choices("az09AZ_.-", k=self._chance.randint(1, 12)))
        bad = self._chance.choice(("", "0123456789abc", 7, None, "a b", "\u00e9"))
        return {} if kind == "none" else {"ficha": good if kind == "good" else bad}

    def heard(self) -> dict[str, object]:
        """`visto`, mostly of late, or nothing of it."""
        kind = self._chance.choices(("none", "late", "long ago", "to come", "bad"), (45, 40, 6, 5, 4))[0]
        back = {"late": (1, 6), "long ago": (9, 50), "to come": (-90, -1)}
        if kind in back:
            return {"visto": max(1, self._told - self._chance.randint(*back[kind]))}
        bad = self._chance.choice((-1, 1.0, UINT32 + 1, "1", None, True))
        return {} if kind == "none" else {"visto": bad}


class AnyAuthor(ABC):
    """Writes one script for a board; the same seed, the same script. `channels`: what it is told on."""

    channels: tuple[str, ...]

    def __init__(self, chance: Random) -> None:
        self.chance = chance
        self.now_us = chance.choice((1_000_000, 2**32 - 2_000_000, 2**40))
        self._seq, self._epoch, self._boot = 0, 7, FIRST_BOOT
        self._ear = Ear(chance)

    def events(self, least: int, most: int) -> list[str]:
        """Some lines, each with its time, and a last time after them."""
        lines = []
        for _ in range(self.chance.randint(least, most)):
            pause_us = self._pause_us()
            self.now_us += pause_us
            self._ear.listen(pause_us)
            lines.append(f"{self.now_us} {self._event()}")
        self.now_us += self.chance.choice((10_000, 3_000_000))
        return lines

    def _pause_us(self) -> int:
        kinds = ((0, 3), (1, 2_000), (1_000, 300_000), (100_000, 1_500_000), (100_000, 2_400_000))
        return self.chance.randint(*self.chance.choice(kinds))

    def _mishap(self, reboot: str, *others: str) -> str:
        """The board's power is lost and back, or another one of these."""
        event = self.chance.choice((reboot, *others))
        if event == reboot:
            self._ear.reboot()
        return event

    def _message_on(self, channel: str) -> str:
        labels = {**self._stamp(channel), **self._ear.heard(), **self._ear.token()}
        raw = json.dumps({**self._body(channel), **labels}).encode()
        if self.chance.random() < 0.05:
            raw = self._damaged(raw)
        retained = int(self.chance.random() < 0.04)
        return f"message {self.channels.index(channel)} {retained} {raw.hex()}"

    def _beaten(self) -> dict[str, object]:
        """The epoch of a beat, now and then one of the future."""
        ahead = self.chance.choices((0, 1, AHEAD_S, AHEAD_S + 1, UINT32 - self._epoch), (60, 10, 1, 3, 3))[0]
        return {"epoca": self._epoch + ahead}

    def _damaged(self, raw: bytes) -> bytes:
        at = self.chance.randrange(len(raw))
        return (
            raw[:at] + self.chance.randbytes(self.chance.randrange(3)) + raw[at + self.chance.randrange(3) :]
        )

    @abstractmethod
    def _event(self) -> str:
        """What happens at one time."""

    @abstractmethod
    def _body(self, channel: str) -> dict[str, object]:
        """What a message says but for its numbers."""

    @abstractmethod
    def _stamp(self, channel: str) -> dict[str, object]:
        """Its numbers."""
