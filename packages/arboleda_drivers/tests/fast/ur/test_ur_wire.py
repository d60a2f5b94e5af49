"""Bytes to and from a controller of Universal Robots, whole, cut and wrong."""

from __future__ import annotations

import math
import random
import struct

import pytest

from arboleda.model.messages import MotionState
from arboleda_drivers.ur import primary, programs, rtde
from arboleda_drivers.ur.arm_state import Mode, Runtime, hindrance, motion_state
from arboleda_drivers.ur.rtde import HEADER, LAYOUT, Frame, NotRtde, Packet, PacketReader

from ..connections.arms import ARM

FRAME = Frame(
    timestamp_s=12.5,
    joints=(0.1, -0.2, 0.3, 0.0, 3.1, -1.5),
    mode=Mode.RUNNING,
    safety=1,
    runtime=Runtime.PLAYING,
    outputs=1 << 16,
    slider=0.5,
    begun=7,
    done=6,
)
RECIPE = 1
DATA = rtde.packed_frame(FRAME, RECIPE)
WANTED = rtde.outputs(24)


def test_a_frame_is_read_as_it_was_packed() -> None:
    ((kind, payload),) = PacketReader().feed(DATA)
    assert kind == Packet.DATA and rtde.frame_of(payload, RECIPE) == FRAME


def test_packets_are_read_however_they_are_cut() -> None:
    data, chance = DATA * 5, random.Random(3)
    reader, found = PacketReader(), []
    while data:
        cut = chance.randint(1, 60)
        found += reader.feed(data[:cut])
        data = data[cut:]
    assert [rtde.frame_of(payload, RECIPE) for _, payload in found] == [FRAME] * 5


@pytest.mark.parametrize("size", [0, 2, rtde.LONGEST + 1])
def test_a_length_that_no_packet_has_is_refused(size: int) -> None:
    with pytest.raises(NotRtde, match=f"a packet of type 85 and {size} bytes"):
        PacketReader().feed(HEADER.pack(size, Packet.DATA))


def test_a_frame_that_the_next_one_would_complete_is_refused() -> None:
    with pytest.raises(NotRtde):
        PacketReader().feed(DATA[:40] + DATA[43:] + DATA)


def wrong(**changes: float) -> bytes:
    values = {**vars(FRAME), **changes}
    return rtde.packed_frame(Frame(**values), RECIPE)[HEADER.size :]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "payload",
    [
        DATA[HEADER.size : -1],
        b"\x02" + DATA[HEADER.size + 1 :],
        wrong(joints=(0.0, math.nan, 0.0, 0.0, 0.0, 0.0)),  # type: ignore[arg-type]
        wrong(joints=(0.0, 200.0, 0.0, 0.0, 0.0, 0.0)),  # type: ignore[arg-type]
        wrong(timestamp_s=-1.0),
        wrong(timestamp_s=math.inf),
        wrong(slider=math.nan),
        wrong(mode=99),
        wrong(runtime=6),
    ],
)
def test_a_wrong_frame_is_none(payload: bytes) -> None:
    assert rtde.frame_of(payload, RECIPE) is None


@pytest.mark.parametrize(
    ("types", "why"),
    [
        ("DOUBLE,VECTOR6D,INT32,NOT_FOUND", "its RTDE has no safety_status: its software is older"),
        ("DOUBLE,VECTOR6D,UINT32", "its RTDE calls robot_mode UINT32, which should be INT32"),
        ("", "its RTDE calls timestamp nothing, which should be DOUBLE"),
        ("DOUBLE,VECTOR6D", "its RTDE calls robot_mode nothing"),
    ],
)
def test_a_setup_that_lacks_something_names_it(types: str, why: str) -> None:
    with pytest.raises(NotRtde, match=why):
        rtde.recipe_of(b"\x01" + types.encode(), WANTED)


def test_the_layout_is_that_of_the_names() -> None:
    forms = {"DOUBLE": "d", "VECTOR6D": "6d", "INT32": "i", "UINT32": "I", "UINT64": "Q"}
    assert LAYOUT.size == struct.calcsize(">B" + "".join(forms[kind] for _, kind in WANTED))


def test_errors_of_programs_are_read_among_all_that_the_controller_says() -> None:
    state = primary.HEADER.pack(9, 16) + b"abcd"
    data = state + primary.packed_code(210, "read-only") + state + primary.packed_exception(3, "no such name")
    reader, found = primary.PackageReader(), []
    for at in range(len(data)):
        found += reader.feed(data[at : at + 1])
    assert [each.code for each in found] == [210, 0]
    assert [each.text for each in found] == ["C210A0 read-only", "line 3: no such name"]


def test_a_message_that_is_no_error_is_none() -> None:
    text = primary.MESSAGE.pack(0, -1, 0) + b"hello"
    short = primary.MESSAGE.pack(0, -1, primary.ERROR_CODE) + b"abc"
    reader = primary.PackageReader()
    for body in (text, short, b""):
        assert reader.feed(primary.HEADER.pack(5 + len(body), primary.ROBOT_MESSAGE) + body) == []
    with pytest.raises(ValueError, match="a package of 4 bytes"):
        reader.feed(primary.HEADER.pack(4, 16))


def test_a_move_names_itself_at_its_begin_and_end_and_is_watched() -> None:
    text = programs.move(7, (0.1,) * 6, speed=1.0, acceleration=2.0, register=24)
    assert text.splitlines() == [
        "def arboleda_move_7():",
        '  rtde_set_watchdog("input_int_register_24", 1, "stop")',
        "  write_output_integer_register(24, 7)",
        "  movej([0.100000,0.100000,0.100000,0.100000,0.100000,0.100000], a=2.0000, v=1.0000)",
        "  write_output_integer_register(25, 7)",
        "end",
    ]


def test_a_stop_brakes_between_its_names() -> None:
    text = programs.stop(8, acceleration=4.0, register=30)
    assert [line.strip() for line in text.splitlines()][1:4] == [
        "write_output_integer_register(30, 8)",
        "stopj(4.0000)",
        "write_output_integer_register(31, 8)",
    ]


@pytest.mark.parametrize(
    ("output", "line"),
    [
        (0, "set_standard_digital_out(0, True)"),
        (9, "set_configurable_digital_out(1, True)"),
        (17, "set_tool_digital_out(1, True)"),
    ],
)
def test_an_output_is_counted_as_rtde_does(output: int, line: str) -> None:
    assert programs.switch(output, on=True).splitlines() == ["sec arboleda_switch():", f"  {line}", "end"]


def test_no_joint_goes_faster_than_its_own_speed() -> None:
    here, there = (0.0,) * 6, (1.0, 0.5, 0.5, 2.0, 0.0, 0.0)
    speed, acceleration = programs.leading(ARM.joints, here, there)
    for joint, way in zip(ARM.joints, there, strict=True):
        assert speed * way / 2.0 <= joint.speed + 1e-9
        assert acceleration * way / 2.0 <= joint.acceleration + 1e-9
    assert programs.leading(ARM.joints, here, here) == (ARM.joints[0].speed, ARM.joints[0].acceleration)


@pytest.mark.parametrize(
    ("changes", "state", "word"),
    [
        ({}, MotionState.MOVING, ""),
        ({"runtime": Runtime.STOPPED}, MotionState.STOPPED, ""),
        ({"runtime": Runtime.PAUSED}, MotionState.MOVING, ""),
        ({"safety": 2, "runtime": Runtime.STOPPED}, MotionState.STOPPED, ""),
        ({"safety": 3}, MotionState.FAULT, "protective_stop"),
        ({"safety": 99}, MotionState.FAULT, "safety_status 99"),
        ({"mode": Mode.IDLE}, MotionState.NOT_HOMED, "brakes_not_released"),
        ({"mode": 15}, MotionState.NOT_HOMED, "robot_mode 15"),
        ({"mode": Mode.BACKDRIVE}, MotionState.MOVING, "moved_by_hand"),
    ],
)
def test_what_a_frame_shows(changes: dict[str, int], state: MotionState, word: str) -> None:
    frame = Frame(**{**vars(FRAME), **changes})
    assert (motion_state(frame), hindrance(frame)) == (state, word)
