"""Drivers whose machines are tried at bad lines in virtual time, and what is known of their lines."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from arboleda_driver_faults.vda5050 import SILENT_S
from arboleda_drivers.connections.replies_due import REPLY_S
from arboleda_drivers.connections.tcp_arm import SILENT_S as FRAMES_S
from arboleda_drivers.gcode import grbl_stop, marlin, moonraker
from arboleda_drivers.gcode.controller import ANSWER_S
from arboleda_drivers.serial_arm.bus import SILENT_S as SERVOS_S
from arboleda_drivers.serial_arm.packets import Instruction
from arboleda_drivers.vda5050 import stops

GRBL_STOPS = (b"!", b"\x18")
MARLIN_STOPS = (b"M410", b"M112")
SHORTEST_S = 3.0  # so long a line is bad at least


def never(message: Any) -> bool:
    """True for none: a stop without a telegram of its own."""
    return False


def _grbl(message: Any) -> bool:
    return message in GRBL_STOPS


def _marlin(message: Any) -> bool:
    return any(word in message for word in MARLIN_STOPS)


def _servos(message: Any) -> bool:
    return Instruction.SYNC_WRITE in message[:8]


def _ur(message: Any) -> bool:
    data = getattr(message, "data", b"")
    return b"stopj" in data or data == b"stop\n"


def _vehicle(message: Any) -> bool:
    actions = message.body.get("actions", ()) if message.topic == "instantActions" else ()
    return any(each["actionType"] in ("cancelOrder", "startPause") for each in actions)


def _own_topics(message: Any) -> bool:
    return bool(message.topic == "arm/stop")


def _dobot(message: Any) -> bool:
    return "Stop()" in getattr(message, "text", "")


@dataclass(frozen=True, kw_only=True)
class Tried:
    """Driver to try: the times that it waits for an answer, s, and its way to say a stop."""

    waits_s: tuple[float, ...]
    is_serial: bool = False
    has_bytes: bool = True
    is_stop: Callable[[Any], bool] = never
    telegram_s: float = 0.0  # so long another telegram may be on the line before a stop

    @property
    def lasts_s(self) -> float:
        """The time for which the line is bad."""
        return max(SHORTEST_S, 3.5 * max(self.waits_s))


TRIED = {
    "gcode-grbl": Tried(waits_s=(grbl_stop.SILENT_S, ANSWER_S), is_serial=True, is_stop=_grbl),
    "gcode-limp": Tried(waits_s=(grbl_stop.SILENT_S, ANSWER_S), is_serial=True, is_stop=_grbl),
    "gcode-marlin": Tried(waits_s=(marlin.SILENT_S,), is_serial=True, is_stop=_marlin),
    "gcode-marlin-limp": Tried(waits_s=(marlin.SILENT_S,), is_serial=True, is_stop=_marlin),
    "gcode-moonraker": Tried(waits_s=(moonraker.SILENT_S,)),
    "serial_arm-feetech": Tried(waits_s=(0.05, SERVOS_S), is_serial=True, is_stop=_servos, telegram_s=0.05),
    "serial_arm-dynamixel": Tried(waits_s=(0.05, SERVOS_S), is_serial=True, is_stop=_servos, telegram_s=0.05),
    **{
        f"vda5050-{version}": Tried(waits_s=(stops.AGAIN_S, SILENT_S), has_bytes=False, is_stop=_vehicle)
        for version in ("2.0", "2.1", "3.0")
    },
    **{
        f"mqtt-{level}": Tried(waits_s=(3.0,), has_bytes=False, is_stop=_own_topics)
        for level in ("ids", "facts")
    },
    "dobot": Tried(waits_s=(FRAMES_S, REPLY_S), is_stop=_dobot),
    "ur": Tried(waits_s=(FRAMES_S, REPLY_S), is_stop=_ur),
}
