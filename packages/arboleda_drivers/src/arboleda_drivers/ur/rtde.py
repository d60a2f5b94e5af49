"""RTDE, version 2: packets of two bytes of length, one of type, and what that type holds, all big-endian.

Types and forms are those of the maker's guide and of its Python client: see docs/how-to/ur.md.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

from arboleda_drivers.connections.link import LinkBroken

HEADER = struct.Struct(">HB")
VERSION = 2
RATE_HZ = 125.0  # the highest of a CB3; an e-Series has up to 500
LONGEST = 2048  # bytes of a packet; what is sent here has some hundred
FARTHEST_RAD = 100.0  # no joint turns that far, those that turn without end aside


class Packet(IntEnum):
    """Type of a packet: the letter that the maker gave it."""

    VERSION = ord("V")
    TEXT = ord("M")
    DATA = ord("U")
    OUTPUTS = ord("O")
    INPUTS = ord("I")
    START = ord("S")
    PAUSE = ord("P")
    CONTROLLER = ord("v")


KINDS = frozenset(Packet)


class NotRtde(LinkBroken):
    """Error: what came is not RTDE, or not the answer that was due."""


class PacketReader:
    """Splitter of the stream into packets."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> list[tuple[int, bytes]]:
        """The packets that are complete now, by type; raises NotRtde for a header that none has.

        After lost bytes the next packet's begin completes one, and no header follows it: neither counts.
        """
        rest, found = self._rest + data, []
        while len(rest) >= HEADER.size:
            size, kind = HEADER.unpack_from(rest)
            if not HEADER.size <= size <= LONGEST or kind not in KINDS:
                raise NotRtde(f"its RTDE sends a packet of type {kind} and {size} bytes")
            if len(rest) < size:
                break
            found.append((kind, rest[HEADER.size : size]))
            rest = rest[size:]
        self._rest = rest
        return found


def packed(kind: Packet, payload: bytes = b"") -> bytes:
    """A packet as it is sent."""
    return HEADER.pack(HEADER.size + len(payload), kind) + payload


@dataclass(frozen=True, kw_only=True)
class Frame:
    """Data package of the driver's recipe; joints in rad, `timestamp_s` since the controller was switched on.

    `begun` and `done` are the registers in which our programs name themselves.
    """

    timestamp_s: float
    joints: tuple[float, ...]
    mode: int
    safety: int
    runtime: int
    outputs: int
    slider: float
    begun: int
    done: int


LAYOUT = struct.Struct(">B7d2iIQd2i")
FIELDS = (
    ("timestamp", "DOUBLE"),
    ("actual_q", "VECTOR6D"),
    ("robot_mode", "INT32"),
    ("safety_status", "INT32"),
    ("runtime_state", "UINT32"),
    ("actual_digital_output_bits", "UINT64"),
    ("target_speed_fraction", "DOUBLE"),
)
REGISTER = "INT32"


def outputs(register: int) -> tuple[tuple[str, str], ...]:
    """Names and types of what the controller sends, with two registers from this number on."""
    numbers = (register, register + 1)
    return (*FIELDS, *((f"output_int_register_{number}", REGISTER) for number in numbers))


def beat_name(register: int) -> str:
    """The name of the register to which the driver writes its heartbeat."""
    return f"input_int_register_{register}"


def recipe_of(payload: bytes, wanted: Sequence[tuple[str, str]]) -> int:
    """The number of the recipe by which a setup was answered; raises NotRtde, which names what it lacks."""
    types = payload[1:].decode("ascii", "replace").split(",")
    for (name, kind), found in zip(wanted, [*types, *[""] * len(wanted)], strict=False):
        if found == "NOT_FOUND":
            raise NotRtde(f"its RTDE has no {name}: its software is older than the driver needs")
        if found == "IN_USE":
            raise NotRtde(f"another client of RTDE writes {name}: give registers_from another number")
        if found != kind:
            raise NotRtde(f"its RTDE calls {name} {found or 'nothing'}, which should be {kind}")
    return payload[0]


def frame_of(payload: bytes, recipe: int) -> Frame | None:
    """Parses a data package; None if it cannot be one of this recipe, or cannot be true."""
    if len(payload) != LAYOUT.size or payload[0] != recipe:
        return None
    _, timestamp, *numbers = LAYOUT.unpack(payload)
    joints, (mode, safety, runtime, bits, slider, begun, done) = tuple(numbers[:6]), numbers[6:]
    if not all(math.isfinite(each) and abs(each) < FARTHEST_RAD for each in (*joints, slider)):
        return None
    if not (math.isfinite(timestamp) and timestamp >= 0 and -1 <= mode <= 20 and 0 <= runtime <= 5):
        return None
    return Frame(
        timestamp_s=timestamp,
        joints=joints,
        mode=mode,
        safety=safety,
        runtime=runtime,
        outputs=bits,
        slider=slider,
        begun=begun,
        done=done,
    )


def packed_frame(frame: Frame, recipe: int) -> bytes:
    """A data package as a controller sends it."""
    numbers = (frame.mode, frame.safety, frame.runtime, frame.outputs, frame.slider, frame.begun, frame.done)
    return packed(Packet.DATA, LAYOUT.pack(recipe, frame.timestamp_s, *frame.joints, *numbers))
