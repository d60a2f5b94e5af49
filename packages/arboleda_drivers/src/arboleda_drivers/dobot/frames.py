"""The feedback of a controller: 1,440 bytes every 8 ms, of which a driver needs eight numbers."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from enum import IntEnum

SIZE = 1440
TEST_VALUE = 0x0123456789ABCDEF
LENGTH = SIZE.to_bytes(2, "little")  # every frame begins with it
COUNT = struct.Struct("<Q")
JOINTS = struct.Struct("<6d")
INPUTS_AT, OUTPUTS_AT, MODE_AT, TIME_AT, RUN_AT, TEST_AT = 8, 16, 24, 32, 40, 48
TARGET_AT, ACTUAL_AT = 192, 432
COMMAND_AT = 1112
FARTHEST_DEG = 1000.0  # no joint of any CR arm turns that far


class Mode(IntEnum):
    """Operating mode of the controller, its RobotMode."""

    INIT = 1
    BRAKE_OPEN = 2
    POWER_OFF = 3
    DISABLED = 4
    IDLE = 5
    DRAG = 6
    RUNNING = 7
    JOG = 8
    ERROR = 9
    PAUSED = 10
    COLLISION = 11


@dataclass(frozen=True, kw_only=True)
class Feedback:
    """Feedback frame; `command` is its CurrentCommandId, joints are in degrees, times in ms."""

    mode: Mode
    command: int
    joints_deg: tuple[float, ...]
    time_ms: int
    run_ms: int  # since the controller was switched on
    outputs: int = 0

    def packed(self) -> bytes:
        """The frame as a controller sends it; unused fields are 0."""
        frame = bytearray(SIZE)
        frame[:2] = LENGTH
        numbers = {OUTPUTS_AT: self.outputs, MODE_AT: self.mode, TIME_AT: self.time_ms, RUN_AT: self.run_ms}
        for at, number in {**numbers, TEST_AT: TEST_VALUE, COMMAND_AT: self.command}.items():
            COUNT.pack_into(frame, at, number)
        for at in (TARGET_AT, ACTUAL_AT):
            JOINTS.pack_into(frame, at, *self.joints_deg)
        return bytes(frame)


def unpacked(frame: bytes) -> Feedback | None:
    """Parses a feedback frame; None if it cannot be one."""
    if len(frame) != SIZE or frame[:2] != LENGTH or _count(frame, TEST_AT) != TEST_VALUE:
        return None
    mode, joints = _count(frame, MODE_AT), JOINTS.unpack_from(frame, ACTUAL_AT)
    if mode not in MODES or not all(math.isfinite(each) and abs(each) < FARTHEST_DEG for each in joints):
        return None
    return Feedback(
        mode=Mode(mode),
        command=_count(frame, COMMAND_AT),
        joints_deg=joints,
        time_ms=_count(frame, TIME_AT),
        run_ms=_count(frame, RUN_AT),
        outputs=_count(frame, OUTPUTS_AT),
    )


class FrameReader:
    """Splitter of the feedback stream into frames; bytes that form none are skipped up to the next frame."""

    def __init__(self) -> None:
        self._rest = b""
        self.refused = 0  # skipped bytes

    def feed(self, data: bytes) -> list[Feedback]:
        """The frames that are complete now, in order."""
        rest, found = self._rest + data, []
        while len(rest) >= SIZE:
            # After lost bytes the next frame's begin completes this one, and no frame follows it.
            follows = rest[SIZE : SIZE + 2]
            frame = unpacked(rest[:SIZE]) if LENGTH.startswith(follows) else None
            if frame is not None:
                found.append(frame)
            cut = SIZE if frame is not None else _next_beginning(rest)
            self.refused += 0 if frame is not None else cut
            rest = rest[cut:]
        self._rest = rest
        return found


def _next_beginning(rest: bytes) -> int:
    at = rest.find(LENGTH, 1)
    return len(rest) - 1 if at < 0 else at


def _count(frame: bytes, at: int) -> int:
    number: int = COUNT.unpack_from(frame, at)[0]
    return number


MODES = frozenset(Mode)
