"""Program of a PLC that drives a belt: orders in, values out, under a time that is handed to it.

One order at a time, named by a number. The part is loaded at the entry and carried to the exit; an eye
looks at it there. The gate of the exit is a cylinder, which may be switched at any time and is there at once.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

FAULTS = {
    "busy": "every order is rejected as busy",
    "deaf": "orders are not noticed: no number is echoed",
    "slow": "everything takes ten times as long",
    "jam": "a motion begins and never ends",
    "gives_up": "work fails half way, with the word jam",
    "forgets": "work ends, and its number is never echoed as done",
    "lies": "work is done at once, and nothing has moved",
    "blind": "the sensors of the belt go on to show what they showed",
    "drive_fault": "the drive reports a fault as soon as it should work",
    "reboots": "the PLC boots in the middle of each work, and has forgotten everything",
    "runs_on": "a halt does not halt",
    "frozen": "the program stands still, and the PLC goes on to answer",
    "nonsense": "the place of the part is a number that has no meaning",
    "bad_part": "the eye sees a bad part",
}
STOPPED, MOVING, FAULT, LATCHED = range(4)
BUSY, IS_LATCHED, UNKNOWN, GATE_CLOSED, BAD_SPEED = range(1, 6)
JAM, DRIVE = 1, 2
NONE, ENTRY, EXIT = range(3)
CLOSED, OPEN = range(2)
GOOD, BAD = 1, 2
LOAD, ADVANCE, GATE, SCAN = range(1, 5)
LENGTH_MM, LOAD_S, SCAN_S = 300, 1.0, 0.3
WATCH_S = 2.0  # it stops after this time without a heartbeat, once it had one


@dataclass(kw_only=True)
class PlcDisplay:
    """Values that the PLC shows, as numbers."""

    boot: int = 1
    alive: int = 0
    state: int = STOPPED
    accepted: int = 0
    done: int = 0
    rejected: int = 0
    reason: int = 0
    failed: int = 0
    failure: int = 0
    part_at: int = NONE
    gate: int = CLOSED
    mm_s: int = 0
    seen: int = GOOD


@dataclass(frozen=True, kw_only=True)
class Work:
    """Work of the belt, with its begin and end, s."""

    number: int
    verb: int
    sets: Mapping[str, int]
    began_at: float
    until: float


@dataclass(kw_only=True)
class Belt:
    """Program of the belt; call `scan` before reading. `faults` are the names of those that are on."""

    faults: Collection[str] = ()
    shown: PlcDisplay = field(default_factory=PlcDisplay)
    _work: Work | None = None
    _beat: tuple[int, float] | None = None
    _latched: bool = False

    def order(self, now: float, number: int, verb: int, to: int = 0, speed_mm_s: int = 0) -> None:
        """Take a new order: a changed number, a verb and its values."""
        self.scan(now)
        if "deaf" in self.faults or "frozen" in self.faults:
            return
        reason = self._objection(verb, to, speed_mm_s)
        if reason:
            self.shown.rejected, self.shown.reason = number, reason
            return
        self.shown.accepted = number
        if verb == GATE:
            self._gate(number, to)
            return
        takes_s = {LOAD: LOAD_S, SCAN: SCAN_S}.get(verb) or LENGTH_MM / speed_mm_s
        takes_s = 0.0 if "lies" in self.faults else takes_s * (10 if "slow" in self.faults else 1)
        sets = {LOAD: {"part_at": ENTRY}, ADVANCE: {"part_at": to}, SCAN: {}}[verb]
        self._work = Work(number=number, verb=verb, sets=sets, began_at=now, until=now + takes_s)
        moves = verb in (LOAD, ADVANCE)
        self.shown.state = MOVING if moves else self.shown.state
        self.shown.mm_s = speed_mm_s if verb == ADVANCE else 0
        self.scan(now)

    def halt(self, now: float) -> None:
        """Halt everything that moves."""
        self.scan(now)
        if not {"runs_on", "frozen"} & set(self.faults):
            self._stop()

    def latch(self, now: float, *, on: bool) -> None:
        """Halt, and refuse every order until the latch is switched off."""
        if on:
            self.halt(now)
        self._latched = on
        self._rest()

    def beat(self, now: float, number: int) -> None:
        """Take a heartbeat; its number must change, else the belt stops after WATCH_S."""
        if self._beat is None or self._beat[0] != number:
            self._beat = (number, now)

    def scan(self, now: float) -> None:
        """Run the program once."""
        if "frozen" in self.faults:
            return
        self.shown.alive = int(now * 10) % 65536
        if self._beat is not None and now - self._beat[1] > WATCH_S:
            self._beat = None
            self._stop()
        work = self._work
        if work is None:
            return
        middle = (work.began_at + work.until) / 2
        if "reboots" in self.faults and now >= middle:
            self._boot()
        elif "drive_fault" in self.faults and work.verb in (LOAD, ADVANCE):
            self._fail(DRIVE, FAULT)
        elif "gives_up" in self.faults and now >= middle:
            self._fail(JAM, STOPPED)
        elif now >= work.until and not ("jam" in self.faults and work.verb in (LOAD, ADVANCE)):
            self._end(work)

    def _objection(self, verb: int, to: int, speed_mm_s: int) -> int:
        if "busy" in self.faults or (self._work is not None and verb != GATE):
            return BUSY
        if self._latched:
            return IS_LATCHED
        if verb not in (LOAD, ADVANCE, GATE, SCAN):
            return UNKNOWN
        if verb == ADVANCE and self.shown.gate == CLOSED:
            return GATE_CLOSED
        return BAD_SPEED if verb == ADVANCE and not 0 < speed_mm_s <= 1000 else 0

    def _gate(self, number: int, to: int) -> None:
        if "lies" not in self.faults:
            self.shown.gate = to
        if "forgets" not in self.faults:
            self.shown.done = number

    def _end(self, work: Work) -> None:
        """End a work: set its values before its number is shown as done, so that a reader may trust them."""
        self._work = None
        for name, value in work.sets.items():
            if "lies" not in self.faults and not ("blind" in self.faults and name == "part_at"):
                setattr(self.shown, name, value)
        if work.verb == SCAN:
            self.shown.seen = BAD if "bad_part" in self.faults else GOOD
        self._rest()
        if "forgets" not in self.faults:
            self.shown.done = work.number

    def _fail(self, failure: int, state: int) -> None:
        assert self._work is not None
        self.shown.failed, self.shown.failure = self._work.number, failure
        self._work = None
        self._rest()
        self.shown.state = state

    def _stop(self) -> None:
        self._work = None
        self._rest()

    def _rest(self) -> None:
        if self._work is None:
            self.shown.mm_s = 0
            self.shown.state = LATCHED if self._latched else STOPPED

    def _boot(self) -> None:
        self.shown = PlcDisplay(
            boot=self.shown.boot % 65535 + 1, part_at=self.shown.part_at, gate=self.shown.gate
        )
        self._work, self._latched, self._beat = None, False, None
