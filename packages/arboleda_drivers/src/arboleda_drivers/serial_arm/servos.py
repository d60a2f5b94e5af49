"""Registers of servos that an arm is made of, and what is written to them.

Sources: of Feetech's STS3215 the constants of the maker's client (`ftservo-python-sdk` on PyPI, `sms_sts.py`)
and Feetech's memory table of the STS series; of Dynamixel's X series the ROBOTIS e-Manual, and the control
tables in the maker's client (`dynamixel-sdk` on PyPI).
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from .packets import BROADCAST, Framing, Instruction, Packet, Protocol1, Protocol2

TICKS = 4096  # of one turn, of both makers
FEETECH_ALARMS = {1: "voltage", 2: "sensor", 4: "overheating", 8: "overcurrent", 32: "overload"}
DYNAMIXEL_ALARMS = {1: "voltage", 4: "overheating", 8: "sensor", 16: "electrical_shock", 32: "overload"}


@dataclass(frozen=True, kw_only=True)
class Reading:
    """Registers of one servo at one time; positions in ticks, speeds in ticks/s.

    `at` is the time (s) at which the servo was asked: it read them then or later. `marked`: its acceleration
    is set, which a servo forgets without power.
    """

    at: float
    torque: bool
    goal: int
    position: int
    load_percent: float | None = None  # None: the servo has no such register
    volts: float
    celsius: int
    alarms: tuple[str, ...] = ()
    marked: bool = True


@dataclass(frozen=True, kw_only=True)
class Goal:
    """Goal of one servo: position in ticks, speed in ticks/s, acceleration in ticks/s2."""

    position: int
    speed: float
    acceleration: float


class Maker(Protocol):
    """Servos of one maker: where their registers are, and how values are written there."""

    framing: Framing
    block: tuple[int, int]  # address and length of what is read of a servo
    mode: tuple[int, frozenset[int]]  # address of the operating mode, and those that hold a position
    positions: tuple[int, int]  # the least and the greatest goal
    reboots: bool  # alarms end by a reboot

    def reading(self, at: float, packet: Packet) -> Reading:
        """The state of a servo by a block of registers that was read at that time (s)."""

    def goals(self, goals: Mapping[int, Goal]) -> bytes:
        """The packet that gives servos their goals, all at once."""

    def torque(self, ids: Sequence[int], *, on: bool) -> bytes:
        """The packet that switches the torque of servos."""


def read(maker: Maker, id: int, address: int, length: int) -> bytes:
    """The packet that asks a servo for registers."""
    word = maker.framing.word
    data = address.to_bytes(word, "little") + length.to_bytes(word, "little")
    return maker.framing.packed(Packet(id=id, code=Instruction.READ, data=data))


def reboot(maker: Maker, id: int) -> bytes:
    """The packet that boots a servo."""
    return maker.framing.packed(Packet(id=id, code=Instruction.REBOOT))


def sync_write(framing: Framing, address: int, rows: Mapping[int, bytes]) -> bytes:
    """The packet that writes registers of several servos at once; none of them answers it."""
    length = len(next(iter(rows.values())))
    head = address.to_bytes(framing.word, "little") + length.to_bytes(framing.word, "little")
    data = head + b"".join(bytes([id]) + row for id, row in rows.items())
    return framing.packed(Packet(id=BROADCAST, code=Instruction.SYNC_WRITE, data=data))


class Feetech:
    """Servos of Feetech's STS series, such as the STS3215 of an SO-101."""

    framing: Framing = Protocol1()
    TORQUE, ACCELERATION = 40, 41
    block = (TORQUE, 31)
    mode = (33, frozenset({0}))
    positions = (0, TICKS - 1)
    reboots = False
    FORM = struct.Struct("<BBHHH7xBHHHBBxBBxxH")
    ACCELERATION_UNIT = 100.0  # ticks/s2

    def reading(self, at: float, packet: Packet) -> Reading:
        torque, acceleration, goal, _, _, _, position, _, load, volts, celsius, status, _, _ = (
            self.FORM.unpack(packet.data)
        )
        return Reading(
            at=at,
            torque=torque == 1,
            goal=signed(goal, 15),
            position=signed(position, 15),
            load_percent=signed(load, 10) / 10,
            volts=volts / 10,
            celsius=celsius,
            alarms=_alarms(FEETECH_ALARMS, packet.code | status),
            marked=acceleration != 0,
        )

    def goals(self, goals: Mapping[int, Goal]) -> bytes:
        rows = {
            id: struct.pack(
                "<BHHH",
                _within(goal.acceleration / self.ACCELERATION_UNIT, 1, 254),
                magnitude(goal.position, 15),
                0,
                _within(goal.speed, 1, 0x7FFF),
            )
            for id, goal in goals.items()
        }
        return sync_write(self.framing, self.ACCELERATION, rows)

    def torque(self, ids: Sequence[int], *, on: bool) -> bytes:
        return sync_write(self.framing, self.TORQUE, {id: bytes([int(on)]) for id in ids})


class Dynamixel:
    """Servos of Dynamixel's X series, of the operating modes that hold a position."""

    framing: Framing = Protocol2()
    TORQUE, PROFILE = 64, 108
    block = (TORQUE, 83)
    mode = (11, frozenset({3, 4, 5}))
    positions = (-(2**20), 2**20)
    reboots = True
    FORM = struct.Struct("<B5xB37xI4xi12xi8xHB")
    SPEED_UNIT = 0.229 / 60 * TICKS  # 0.229 rev/min
    ACCELERATION_UNIT = 214.577 / 3600 * TICKS  # 214.577 rev/min2

    def reading(self, at: float, packet: Packet) -> Reading:
        torque, status, acceleration, goal, position, volts, celsius = self.FORM.unpack(packet.data)
        return Reading(
            at=at,
            torque=torque == 1,
            goal=goal,
            position=position,
            volts=volts / 10,
            celsius=celsius,
            alarms=_alarms(DYNAMIXEL_ALARMS, status),
            marked=acceleration != 0,
        )

    def goals(self, goals: Mapping[int, Goal]) -> bytes:
        rows = {
            id: struct.pack(
                "<IIi",
                _within(goal.acceleration / self.ACCELERATION_UNIT, 1, 32767),
                _within(goal.speed / self.SPEED_UNIT, 1, 32767),
                goal.position,
            )
            for id, goal in goals.items()
        }
        return sync_write(self.framing, self.PROFILE, rows)

    def torque(self, ids: Sequence[int], *, on: bool) -> bytes:
        return sync_write(self.framing, self.TORQUE, {id: bytes([int(on)]) for id in ids})


MAKERS: dict[str, Maker] = {"feetech": Feetech(), "dynamixel": Dynamixel()}


def signed(value: int, bit: int) -> int:
    """The number whose sign is that bit of the value, as Feetech writes numbers."""
    return -(value & (1 << bit) - 1) if value >> bit & 1 else value


def magnitude(value: int, bit: int) -> int:
    """The value for a number whose sign is that bit of it."""
    return -value | 1 << bit if value < 0 else value


def _alarms(words: Mapping[int, str], bits: int) -> tuple[str, ...]:
    return tuple(word for bit, word in words.items() if bits & bit)


def _within(value: float, least: int, greatest: int) -> int:
    return min(max(round(value), least), greatest)
