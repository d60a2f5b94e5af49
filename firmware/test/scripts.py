"""Random scripts of timed events for a board, as lines that test/scripted.cpp reads."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

from .author import FIRST_BOOT, AnyAuthor

CHANNELS = ("juntas", "efector", "paro", "referencia", "latido")
RETARGET_US = 100_000  # the core lets a moving arm's target change so often
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
        return [config, f"boot {now_us} {FIRST_BOOT}", f"at {at}", *places]


class Author(AnyAuthor):
    """Of scripts for the board of a SCARA."""

    channels = CHANNELS

    def __init__(self, seed: int) -> None:
        super().__init__(Random(seed))
        start = self.chance.choice(((0, 0, 0), PLACES[0], (-7000, 100, 250)))
        self.setting = Setting(
            ids=self.chance.random() < 0.85, limited=self.chance.random() < 0.5, start=start
        )

    def script(self) -> list[str]:
        """Its lines."""
        lines = [*self.setting.lines(self.now_us), f"{self.now_us} connect 1"]
        lines += self.events(4, 14)
        return [*lines, f"{self.now_us} probe"]

    def _pause_us(self) -> int:
        return super()._pause_us() + (RETARGET_US if self.setting.limited else 0)

    def _event(self) -> str:
        kind = self.chance.choices(("message", "mischief", "probe"), (80, 10, 10))[0]
        return self._message() if kind == "message" else self._mischief() if kind == "mischief" else kind

    def _mischief(self) -> str:
        self._boot += 1
        joint, steps = self.chance.randrange(3), self.chance.randint(-50, 50)
        reboot = f"reboot {self._boot} {self.chance.randrange(2)}"
        bits = [f"{word} {self.chance.randrange(2)}" for word in ("supplied", "grips", "stuck", "connect")]
        return self._mishap(reboot, "fail", "repair", "repair", f"slip {joint} {steps}", "drop", *bits)

    def _message(self) -> str:
        # without beats no silence ends a move, after which the next target would have to wait
        beats = 0 if self.setting.limited else 15
        return self._message_on(self.chance.choices(CHANNELS, (45, 12, 18, 10, beats))[0])

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
            return self._beaten()
        if not self.setting.ids and fate > 0.3:
            return {}
        return {"seq": self._seq, "epoca": self._epoch} if fate < 0.97 else {"seq": self._seq}
