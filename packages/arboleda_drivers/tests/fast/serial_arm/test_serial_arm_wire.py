"""Packets and registers of bus servos."""

from __future__ import annotations

import pytest

from arboleda.drivers.port import DriverError
from arboleda_drivers.serial_arm.packets import (
    BadPacket,
    Framing,
    Packet,
    PacketReader,
    Protocol1,
    Protocol2,
    crc16,
)
from arboleda_drivers.serial_arm.servos import MAKERS, Feetech, Goal, magnitude, read, signed
from arboleda_drivers.serial_arm.settings import ServoGripper, ServoJoint, Settings

FRAMINGS = pytest.mark.parametrize("framing", [Protocol1(), Protocol2()])


def test_the_examples_of_the_makers_manuals() -> None:
    """Protocol 1.0: ping of servo 1. Protocol 2.0: ping of servo 1, and the read of 4 bytes at 132."""
    assert Protocol1().packed(Packet(id=1, code=1)) == bytes.fromhex("ffff010201fb")
    assert Protocol2().packed(Packet(id=1, code=1)) == bytes.fromhex(
        "fffffd00010300 01 194e".replace(" ", "")
    )
    assert read(MAKERS["dynamixel"], 1, 132, 4) == bytes.fromhex("fffffd0001070002840004001d15")
    assert crc16(b"") == 0


@FRAMINGS
@pytest.mark.parametrize(
    "data", [b"", b"\x00", b"\xff\xff\xfd\x01", b"\xff" * 9, b"\xff\xff\xfd\xff\xff\xfd\xfd"]
)
def test_what_is_packed_is_unpacked(framing: Framing, data: bytes) -> None:
    packet = Packet(id=7, code=3, data=data)
    for reply in (False, True):
        wire = framing.packed(packet, reply=reply)
        reader = PacketReader(framing, replies=reply)
        assert [each for at in range(len(wire)) for each in reader.feed(wire[at : at + 1])] == [packet]
        assert reader.refused == 0


@FRAMINGS
def test_stray_bytes_are_skipped(framing: Framing) -> None:
    wire = framing.packed(Packet(id=7, code=0, data=b"12"), reply=True)
    reader = PacketReader(framing, replies=True)
    assert len(reader.feed(b"\x31\xff" + wire + b"\x00\xff\xff\xff" + wire)) == 2


@FRAMINGS
def test_a_packet_with_one_bit_wrong_is_none(framing: Framing) -> None:
    wire = framing.packed(Packet(id=7, code=0, data=b"123"), reply=True)
    for bit in range(8 * len(wire)):
        broken = bytearray(wire)
        broken[bit // 8] ^= 1 << bit % 8
        assert PacketReader(framing, replies=True).feed(bytes(broken)) == []


def test_a_reply_of_protocol_2_is_no_instruction() -> None:
    wire = Protocol2().packed(Packet(id=7, code=3, data=b"1"))
    with pytest.raises(BadPacket):
        Protocol2().unpacked(wire, reply=True)


def test_numbers_of_feetech_have_their_sign_apart() -> None:
    assert [magnitude(value, 15) for value in (5, 0, -5)] == [5, 0, 0x8005]
    assert [signed(value, 15) for value in (5, 0, 0x8005)] == [5, 0, -5]


def test_a_speed_of_0_is_never_written() -> None:
    """For both makers it means: as fast as it can."""
    goals = {1: Goal(position=100, speed=0.0, acceleration=0.0)}
    row = Feetech().goals(goals)[-9:-1]
    assert row == bytes([1, 1, 100, 0, 0, 0, 1, 0])
    assert MAKERS["dynamixel"].goals(goals)[-14:-2] == bytes([1, 0, 0, 0, 1, 0, 0, 0, 100, 0, 0, 0])


def test_a_joint_may_be_reversed_and_have_its_zero_anywhere() -> None:
    joint = ServoJoint(id=1, zero=1000, reversed=True, least=500, most=1500)
    assert joint.ticks(joint.angle(1234)) == 1234
    assert joint.angle(500) > 0 > joint.angle(1500)
    ends = (0, 4095)
    assert joint.can_reach(500, ends) and not joint.can_reach(499, ends) and not joint.can_reach(1501, ends)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({}, "needs either serial"),
        ({"serial": "/dev/x", "host": "h", "port": 1}, "needs either serial"),
        ({"host": "h"}, "port is 0"),
        ({"serial": "/dev/x", "baud": 1}, "baud is 1"),
        ({"serial": "/dev/x", "speed_percent": 0}, "speed_percent is 0; allowed: 1 to 100"),
        ({"serial": "/dev/x", "poll_s": 1.0}, "poll_s is 1"),
        ({"serial": "/dev/x", "reply_s": 1.0}, "reply_s is 1"),
        ({"serial": "/dev/x", "joints": (ServoJoint(id=1), ServoJoint(id=1))}, "servo 1 is there twice"),
        (
            {"serial": "/dev/x", "joints": (ServoJoint(id=1, zero=9000),)},
            "zero of servo 1 is 9000; allowed: 0 to 4095",
        ),
        ({"serial": "/dev/x", "gripper": ServoGripper(id=6, open=9000, closed=0)}, "open of the gripper"),
    ],
)
def test_settings_that_cannot_be(keys: dict[str, object], said: str) -> None:
    with pytest.raises(DriverError, match=said):
        Settings(**{"joints": (ServoJoint(id=1),), **keys})  # type: ignore[arg-type]


def test_servos_that_cannot_be() -> None:
    with pytest.raises(DriverError, match="id is 253; allowed: 0 to 252"):
        ServoJoint(id=253)
    with pytest.raises(DriverError, match="least must be the smaller one"):
        ServoJoint(id=1, least=5, most=5)
    with pytest.raises(DriverError, match="nearer than twice near"):
        ServoGripper(id=6, open=100, closed=50)
    with pytest.raises(DriverError, match="ticks_per_s is 0"):
        ServoGripper(id=6, open=1000, closed=50, ticks_per_s=0)
