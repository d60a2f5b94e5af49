"""Telemetry that repeats the one before: known by its bytes exactly where reading it would say the same."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.model.errors import PayloadError
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import Evidence
from arboleda.wire.payloads import Telemetry, decode, read_angles
from arboleda.wire.repeats import SplitTelemetry
from arboleda.wire.strict import LIMIT_BYTES
from arboleda.wire.topics import Channel

from .test_bridge_any_order import BOARDS, HAPPENINGS

PLAIN = b'{"nodo":4,"estado":0,"seq":9,"arranque":1}'
NUMBERS = st.sampled_from(["0", "7", "07", "-1", "4294967295", "4294967296", "1e3", "1.0", "", "x", '"5"'])
PIECES = st.sampled_from(
    [
        '"nodo":4',
        '"estado":0',
        '"arranque":1',
        '"x":{"seq":3}',
        '"y\\"seq":3',
        '"\\u0073eq":5',
        '"seq" :6',
        '"z":"seq"',
        " ",
    ]
)


def read(raw: bytes) -> Telemetry | None:
    try:
        said = decode(Channel.TELEMETRY, raw, axes=None)
    except PayloadError:
        return None
    assert isinstance(said, Telemetry)
    return said


@st.composite
def messages(draw: st.DrawFn) -> tuple[bytes, bytes]:
    """Two that differ at most in a number, however odd the rest is."""
    pieces = draw(st.lists(PIECES, max_size=5).map(lambda odd: ['"nodo":4', '"estado":0', *odd]))
    pieces.insert(draw(st.integers(0, len(pieces))), '"seq":@')
    text = "{" + ",".join(draw(st.permutations(pieces))) + "}"
    first, second = (text.replace("@", draw(NUMBERS | st.integers(0, 99).map(str))) for _ in range(2))
    return first.encode(), second.encode()


@given(two=messages())
def test_what_is_known_again_reads_the_same_but_for_its_number(two: tuple[bytes, bytes]) -> None:
    first, second = two
    said = read(first)
    words = SplitTelemetry.of(first, said) if said else None
    number = words.number(second) if words else None
    if said and number is not None:
        assert read(second) == replace(said, seq=number if said.seq is not None else None)


@pytest.mark.parametrize("seq", [0, 10, 4294967295])
def test_a_plain_repeat_is_known_again(seq: int) -> None:
    said = read(PLAIN)
    assert said is not None
    words = SplitTelemetry.of(PLAIN, said)
    assert words is not None and words.number(PLAIN.replace(b"9", b"%d" % seq)) == seq


@pytest.mark.parametrize(
    "other",
    [
        PLAIN.replace(b"4", b"5"),
        PLAIN.replace(b"9", b"09"),
        PLAIN.replace(b"9", b""),
        PLAIN.replace(b"9", b"-9"),
        PLAIN.replace(b"9", b"4294967296"),
        PLAIN.replace(b"9", b"9" * 500),
        PLAIN[:-1],
        b"",
    ],
)
def test_another_message_is_not(other: bytes) -> None:
    said = read(PLAIN)
    assert said is not None
    words = SplitTelemetry.of(PLAIN, said)
    assert words is not None and words.number(other) is None


def test_a_message_without_a_number_is_known_by_all_its_bytes() -> None:
    raw = b'{"nodo":4,"estado":0}'
    said = read(raw)
    assert said is not None
    words = SplitTelemetry.of(raw, said)
    assert words is not None and (words.number(raw), words.number(raw + b" ")) == (0, None)


TURNING = b'{"q1_mov":1.5,"q2_mov":2.25,"q3_mov":-3.0,"estado":1,"seq":9}'
ODD = ["7", "-0", "1.5e3", "1e3", "01.5", ".5", "5.", "+1.5", "1000000.1", "NaN", '"1.5"', "[1.5]", "1.5 "]
ANGLES = st.sampled_from(ODD) | st.floats(-1e6, 1e6).map(lambda value: repr(round(value, 4)))


def read_arm(raw: bytes) -> Telemetry | None:
    try:
        said = decode(Channel.TELEMETRY, raw, axes=3)
    except PayloadError:
        return None
    assert isinstance(said, Telemetry)
    return said


@given(angles=st.tuples(ANGLES, ANGLES, ANGLES), number=NUMBERS)
def test_what_is_known_but_for_its_joints_reads_the_same_but_for_them(angles: tuple, number: str) -> None:
    keys = (f'"q{joint}_mov":{value}' for joint, value in enumerate(angles, start=1))
    second = ("{" + ",".join(keys) + ',"estado":1,"seq":' + number + "}").encode()
    said, begin = read_arm(TURNING), read_angles(second, 3)
    assert said is not None
    words = SplitTelemetry.of(TURNING, said)
    seq = words.turned(second, begin[1]).number(second) if words and begin else None
    if begin and seq is not None:
        assert read_arm(second) == replace(said, seq=seq, q_deg=begin[0])


@pytest.mark.parametrize("odd", ODD)
@pytest.mark.parametrize("joint", [b"1.5", b"2.25", b"-3.0"])
def test_joints_that_are_written_otherwise_have_to_be_read(joint: bytes, odd: str) -> None:
    assert read_angles(TURNING.replace(joint, odd.encode(), 1), 3) is None


def test_an_arm_that_moves_on_is_known_but_for_its_joints() -> None:
    second = b'{"q1_mov":11.5,"q2_mov":2.25,"q3_mov":0.0,"estado":1,"seq":10}'
    said = read_arm(TURNING)
    assert said is not None
    words, begin = SplitTelemetry.of(TURNING, said), read_angles(second, 3)
    assert words is not None and begin is not None
    assert begin[0] == (11.5, 2.25, 0.0)
    assert words.turned(second, begin[1]).number(second) == 10
    assert words.turned(second, begin[1]).number(second.replace(b":1,", b":0,")) is None


@pytest.mark.parametrize("raw", [TURNING, TURNING.replace(b',"seq":9', b"")], ids=["numbered", "unnumbered"])
def test_joints_that_make_a_message_too_long_have_to_be_read(raw: bytes) -> None:
    long = raw.replace(b"2.25", b"2.25" + b"0" * LIMIT_BYTES)
    said, begin = read_arm(raw), read_angles(long, 3)
    assert said is not None and begin is not None
    words = SplitTelemetry.of(raw, said)
    assert words is not None and words.turned(long, begin[1]).number(long) is None


@pytest.mark.parametrize("state", [state for state in MotionState if state is not MotionState.NO_LINK])
def test_joints_are_looked_at_alone_only_while_an_arm_moves(state: MotionState) -> None:
    raw = b'{"q1_mov":1.5,"q2_mov":2.25,"q3_mov":-3.0,"estado":%d}' % state.value
    said = read_arm(raw)
    assert said is not None
    words = SplitTelemetry.of(raw, said)
    assert words is not None and (words.joints > 0) == (state is MotionState.MOVING)


AGAIN = st.tuples(st.just("tell"), BOARDS)
DEGREES = st.floats(-2e6, 2e6).map(lambda degrees: max(-1e6, min(degrees, 1e6)))
TURNED = st.fixed_dictionaries(
    {"q_deg": st.tuples(DEGREES, DEGREES, DEGREES)},
    optional={"state": st.sampled_from([MotionState.MOVING, MotionState.STOPPED])},
)
MOVES = st.tuples(st.just("tell"), st.just("ra_1"), TURNED)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("evidence", Evidence, ids=lambda level: level.value)
@given(happenings=st.lists(AGAIN | MOVES | HAPPENINGS, max_size=30))
def test_a_bridge_that_knows_repeats_says_what_one_that_reads_all_would(
    make_linked, evidence: Evidence, happenings: list
) -> None:
    quick, thorough = make_linked(evidence=evidence), make_linked(evidence=evidence)
    for verb, *rest in happenings:
        for board in thorough.bridge._boards.values():
            board._words = None
        said, read = (
            bench.tell(rest[0], **(rest[1] if rest[1:] else {}))
            if verb == "tell"
            else getattr(bench, verb)(*rest)
            for bench in (quick, thorough)
        )
        assert said == read
        assert quick.bridge.counters == thorough.bridge.counters
        assert quick.bridge.next_deadline == thorough.bridge.next_deadline
