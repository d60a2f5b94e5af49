"""Random scripts of timed events for a board, as lines that test/scripted.cpp reads."""

from __future__ import annotations

import json
from dataclasses import dataclass
from random import Random

CHANNELS = ("juntas", "efector", "paro", "referencia", "latido")
RETARGET_US = 100_000  # the core lets a moving arm's target change so often
PERIOD_US = 100_000
AHEAD_S, UINT32 = 366 * 86_400, 2**32 - 1
PLACES = ((2333, 11, 0), (0, 0, 0))


@dataclass(frozen=True, kw_only=True)
class Setting:
    """How the board of a script is configured; `limited`: targets come no faster than RETARGET_US."""

    ids: bool
    limited: bool
    start: tuple[int, ...]

    def lines(self, now_us: int) -> list[str]:
        config = f"config {int(self.ids)} {RETARGET_US if self.limited else 0} 1"
        at = " ".join(str(steps) for steps in self.start)
        places = ["place " + " ".join(str(steps) for steps in place) for place in PLACES]
        return [config, f"boot {now_us} 100", f"at {at}", *places]


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

    def heard(self) -> dict[str, object]:
        """`visto`, mostly of late, or nothing of it."""
        kind = self._chance.choices(("none", "late", "long ago", "to come", "bad"), (45, 40, 6, 5, 4))[0]
        back = {"late": (1, 6), "long ago": (9, 50), "to come": (-90, -1)}
        if kind in back:
            return {"visto": max(1, self._told - self._chance.randint(*back[kind]))}
        bad = self._chance.choice((-1, 1.0, UINT32 + 1, "1", None, True))
        return {} if kind == "none" else {"visto": bad}


class Author:
    """Writes one script; the same seed, the same script."""

    def __init__(self, seed: int) -> None:
        self.chance = Random(seed)
        start = self.chance.choice(((0, 0, 0), PLACES[0], (-7000, 100, 250)))
        self.setting = Setting(
            ids=self.chance.random() < 0.85, limited=self.chance.random() < 0.5, start=start
        )
        self.now_us = self.chance.choice((1_000_000, 2**32 - 2_000_000, 2**40))
        self._first_us = self.now_us
        self._seq, self._epoch, self._boot = 0, 7, 100
        self._ear = Ear(self.chance)

    def script(self) -> list[str]:
        """Its lines."""
        lines = [*self.setting.lines(self.now_us), f"{self.now_us} connect 1"]
        for _ in range(self.chance.randint(4, 14)):
            pause_us = self._pause_us()
            self.now_us += pause_us
            self._ear.listen(pause_us)
            lines.append(f"{self.now_us} {self._event()}")
        self.now_us += self.chance.choice((10_000, 3_000_000))
        return [*lines, f"{self.now_us} probe"]

    def _pause_us(self) -> int:
        least = RETARGET_US if self.setting.limited else 0
        kinds = ((0, 3), (1, 2_000), (1_000, 300_000), (100_000, 1_500_000), (100_000, 2_400_000))
        return least + self.chance.randint(*self.chance.choice(kinds))

    def _event(self) -> str:
        kind = self.chance.choices(("message", "mischief", "probe"), (80, 10, 10))[0]
        return self._message() if kind == "message" else self._mischief() if kind == "mischief" else kind

    def _mischief(self) -> str:
        self._boot += 1
        joint, steps = self.chance.randrange(3), self.chance.randint(-50, 50)
        reboot = f"reboot {self._boot} {self.chance.randrange(2)}"
        bits = [f"{word} {self.chance.randrange(2)}" for word in ("supplied", "grips", "stuck", "connect")]
        event = self.chance.choice(
            (reboot, "fail", "repair", "repair", f"slip {joint} {steps}", "drop", *bits)
        )
        if event == reboot:
            self._ear.reboot()
        return event

    def _message(self) -> str:
        # without beats no silence ends a move, after which the next target would have to wait
        beats = 0 if self.setting.limited else 15
        channel = self.chance.choices(CHANNELS, (45, 12, 18, 10, beats))[0]
        raw = json.dumps({**self._body(channel), **self._stamp(channel), **self._ear.heard()}).encode()
        if self.chance.random() < 0.05:
            raw = self._damaged(raw)
        retained = int(self.chance.random() < 0.04)
        return f"message {CHANNELS.index(channel)} {retained} {raw.hex()}"

    def _body(self, channel: str) -> dict[str, object]:
        if channel == "juntas":
            return {f"q{joint + 1}": self._angle(joint) for joint in range(3)}
        values = {
            "efector": (0, 1, 1, 2),
            "paro": (0, 0, 1, 2, 2, 3),
            "referencia": (1, 1, 1, 0),
            "latido": (0,),
        }
        key = {"referencia": "ref", "latido": "nota"}.get(channel, channel)
        return {key: self.chance.choice(values[channel])}

    def _angle(self, joint: int) -> float:
        """Mostly within the limits, often on a place, at a limit, or half way between two motor steps."""
        place = ((45.00357, 9.9, 0.0), (0.0, 0.0, 0.0))[self.chance.randrange(2)][joint]
        limits = ((-150, 150), (-135, 135), (0, 254.7))[joint]
        step = (0.01929, 0.9, 0.9)[joint]
        half = round((self.chance.randrange(100) + 0.5) * step, 6)
        free = round(self.chance.uniform(limits[0] - 2, limits[1] + 2), self.chance.randrange(6))
        near = round(self.chance.uniform(0, 6 * step), 4)
        return self.chance.choices(
            (place, free, near, half, self.chance.choice(limits)), (25, 25, 30, 10, 3)
        )[0]

    def _stamp(self, channel: str) -> dict[str, object]:
        fate = self.chance.random()
        if fate < 0.06:
            self._epoch += self.chance.randint(-1, 2)
        self._seq += 1 if fate < 0.85 else self.chance.randint(-2, 2)
        self._seq = max(self._seq, 0)
        if channel == "latido":
            ahead = self.chance.choices(
                (0, 1, AHEAD_S, AHEAD_S + 1, UINT32 - self._epoch), (60, 10, 1, 3, 3)
            )[0]
            return {"epoca": self._epoch + ahead}
        if not self.setting.ids and fate > 0.3:
            return {}
        return {"seq": self._seq, "epoca": self._epoch} if fate < 0.97 else {"seq": self._seq}

    def _damaged(self, raw: bytes) -> bytes:
        at = self.chance.randrange(len(raw))
        return (
            raw[:at] + self.chance.randbytes(self.chance.randrange(3)) + raw[at + self.chance.randrange(3) :]
        )
