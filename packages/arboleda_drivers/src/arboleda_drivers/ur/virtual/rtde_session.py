"""RTDE of a virtual controller for one client: its recipes, its rate, and what it may write."""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Callable, Mapping
from typing import Any

from arboleda_drivers.ur.rtde import NotRtde, Packet, PacketReader, packed

FORMS = {
    "DOUBLE": "d",
    "VECTOR6D": "6d",
    "INT32": "i",
    "UINT32": "I",
    "UINT64": "Q",
    "UINT8": "B",
    "BOOL": "?",
}
OUTPUTS = {
    "timestamp": "DOUBLE",
    "target_q": "VECTOR6D",
    "target_qd": "VECTOR6D",
    "actual_q": "VECTOR6D",
    "actual_qd": "VECTOR6D",
    "robot_mode": "INT32",
    "safety_mode": "INT32",
    "safety_status": "INT32",
    "runtime_state": "UINT32",
    "robot_status_bits": "UINT32",
    "safety_status_bits": "UINT32",
    "speed_scaling": "DOUBLE",
    "target_speed_fraction": "DOUBLE",
    "actual_digital_output_bits": "UINT64",
    **{f"output_int_register_{number}": "INT32" for number in range(48)},
}
INPUTS = {
    "speed_slider_mask": "UINT32",
    "speed_slider_fraction": "DOUBLE",
    "standard_digital_output_mask": "UINT8",
    "standard_digital_output": "UINT8",
    "configurable_digital_output_mask": "UINT8",
    "configurable_digital_output": "UINT8",
    **{f"input_int_register_{number}": "INT32" for number in range(48)},
}
FASTEST_HZ = 500.0
VERSION_OF_CONTROLLER = (5, 12, 0, 0)
Values = Mapping[str, Any]


class RtdeSession:
    """One client of RTDE; `write` takes the inputs that it sends, by name."""

    def __init__(self, write: Callable[[Values], None]) -> None:
        self._write = write
        self._reader = PacketReader()
        self._outputs: tuple[str, ...] = ()
        self._inputs: dict[int, tuple[str, ...]] = {}
        self._started = False
        self.period_s = 1 / FASTEST_HZ
        self.due_at = math.inf

    def hear(self, now: float, data: bytes, *, is_old: bool, in_use: bool) -> bytes:
        """The answer to bytes of the client; raises NotRtde where they are none of the protocol."""
        out = b""
        for kind, payload in self._reader.feed(data):
            out += self._answer(now, kind, payload, is_old=is_old, in_use=in_use)
        return out

    def frame(self, now: float, values: Values, *, period_s: float | None = None) -> bytes:
        """The data package of its recipe; the next one is due a period later."""
        self.due_at = now + (self.period_s if period_s is None else period_s)
        numbers: list[Any] = []
        for name in self._outputs:
            value = values[name]
            numbers += value if isinstance(value, tuple) else [value]
        return packed(Packet.DATA, struct.pack(">B" + _form(self._outputs, OUTPUTS), 1, *numbers))

    def _answer(self, now: float, kind: int, payload: bytes, *, is_old: bool, in_use: bool) -> bytes:
        if kind == Packet.VERSION:
            return packed(Packet.VERSION, bytes([payload == b"\0\x02" and not is_old]))
        if kind == Packet.CONTROLLER:
            return packed(Packet.CONTROLLER, struct.pack(">4I", *VERSION_OF_CONTROLLER))
        if kind == Packet.OUTPUTS:
            (rate_hz,) = struct.unpack_from(">d", payload)
            self.period_s = 1 / min(max(rate_hz, 1.0), FASTEST_HZ) if math.isfinite(rate_hz) else 1.0
            self._outputs = _names(payload[8:])
            return packed(Packet.OUTPUTS, b"\x01" + _types(self._outputs, OUTPUTS))
        if kind == Packet.INPUTS:
            names, number = _names(payload), len(self._inputs) + 1
            if in_use:
                return packed(Packet.INPUTS, b"\0" + b",".join(b"IN_USE" for _ in names))
            self._inputs[number] = names
            return packed(Packet.INPUTS, bytes([number]) + _types(names, INPUTS))
        if kind in (Packet.START, Packet.PAUSE):
            self._started = kind == Packet.START and all(name in OUTPUTS for name in self._outputs)
            self.due_at = now if self._started and self._outputs else math.inf
            return packed(Packet(kind), bytes([self._started or kind == Packet.PAUSE]))
        if kind == Packet.DATA and self._started and payload and payload[0] in self._inputs:
            self._take(self._inputs[payload[0]], payload[1:])
            return b""
        if kind == Packet.TEXT:
            return b""
        raise NotRtde(f"a packet of type {kind} at this time")

    def _take(self, names: tuple[str, ...], payload: bytes) -> None:
        form = ">" + _form(names, INPUTS)
        if struct.calcsize(form) != len(payload):
            raise NotRtde("a data package of another recipe")
        self._write(dict(zip(names, struct.unpack(form, payload), strict=True)))


def _names(payload: bytes) -> tuple[str, ...]:
    return tuple(re.findall(r"[^,]+", payload.decode("ascii", "replace")))


def _types(names: tuple[str, ...], known: Mapping[str, str]) -> bytes:
    return ",".join(known.get(name, "NOT_FOUND") for name in names).encode()


def _form(names: tuple[str, ...], known: Mapping[str, str]) -> str:
    return "".join(FORMS[known[name]] for name in names)
