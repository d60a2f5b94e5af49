"""Variables and methods of the belt: the values of its program by name, and the faults on the way."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence

from arboleda_drivers.opcua.server import Bad
from arboleda_drivers.plc.virtual.machine import ADVANCE, GATE, LOAD, SCAN, Belt

PLACES = ("part_at", "gate", "mm_s", "seen")
ECHO = ("boot", "alive", "state", "reason", "failure", "accepted", "rejected", "failed", "done")
VERBS = {"Load": LOAD, "Advance": ADVANCE, "Gate": GATE, "Scan": SCAN}
ARGUMENTS = {"Load": 0, "Advance": 2, "Gate": 1, "Scan": 0}
SPOILT: dict[str, object] = {
    "bad_status": Bad(status="BadSensorFailure"),
    "null": None,
    "text": "exit",
    "nonsense": 77,
}


class BeltProgram:
    """Variables and methods that an OPC UA server serves; each access also moves the program on in time."""

    variables: Mapping[str, str] = dict.fromkeys((*PLACES, *ECHO), "uint16")
    methods: Mapping[str, Sequence[str]] = {
        **{verb: ["uint16"] * (arguments + 1) for verb, arguments in ARGUMENTS.items()},
        **dict.fromkeys(("Halt", "Latch", "Clear"), ()),
    }

    def __init__(
        self, faults: Collection[str], clock: Callable[[], float], *, belt: Belt | None = None
    ) -> None:
        self._faults, self._clock = faults, clock
        self._belt = belt or Belt(faults=faults)
        self._beaten = False

    def show(self) -> Mapping[str, object]:
        self._belt.scan(self._clock())
        values: dict[str, object] = {name: getattr(self._belt.shown, name) for name in self.variables}
        for fault, value in SPOILT.items():
            if fault in self._faults:
                values["part_at"] = value
        return values

    def call(self, method: str, arguments: Sequence[object]) -> str | None:
        if "refuses_calls" in self._faults:
            return "BadUserAccessDenied"
        now, numbers = self._clock(), [each for each in arguments if isinstance(each, int)]
        if len(numbers) != len(arguments) or len(arguments) != len(self.methods[method]):
            return "BadInvalidArgument"
        if method in VERBS:
            to, speed = [*numbers[:-1], 0, 0][:2]
            self._belt.order(now, numbers[-1], VERBS[method], to, speed)
        elif method == "Halt":
            self._belt.halt(now)
        else:
            self._belt.latch(now, on=method == "Latch")
        return None

    def beat(self, value: object) -> None:
        """Take the heartbeat of a client. It is 0 until one writes; without any client it is not watched."""
        self._beaten = self._beaten or value != 0
        if self._beaten and isinstance(value, int):
            self._belt.beat(self._clock(), value)

    def is_mute(self) -> bool:
        return "mute" in self._faults
