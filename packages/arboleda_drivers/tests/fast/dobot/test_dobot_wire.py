"""Bytes of a Dobot: frames and replies, whole, cut and wrong."""

from __future__ import annotations

import random

import pytest

from arboleda_drivers.dobot.frames import SIZE, Feedback, FrameReader, Mode, unpacked
from arboleda_drivers.dobot.replies import LONGEST, NotAReply, ReplyReader

FRAME = Feedback(
    mode=Mode.RUNNING,
    command=7,
    joints_deg=(1.0, -2.0, 3.5, 0.0, 180.0, -90.0),
    time_ms=1_700_000_000_000,
    run_ms=60_000,
    outputs=3,
)


def test_a_frame_is_read_as_it_was_packed() -> None:
    assert len(FRAME.packed()) == SIZE
    assert unpacked(FRAME.packed()) == FRAME


def test_frames_are_read_however_they_are_cut() -> None:
    data, chance = FRAME.packed() * 5, random.Random(3)
    reader, found = FrameReader(), []
    while data:
        cut = chance.randint(1, 2000)
        found += reader.feed(data[:cut])
        data = data[cut:]
    assert found == [FRAME] * 5 and reader.refused == 0


def test_what_is_no_frame_is_passed_over_up_to_the_next() -> None:
    reader = FrameReader()
    found = reader.feed(b"hello" + FRAME.packed()[: SIZE - 100] + FRAME.packed() * 2)
    found += reader.feed(FRAME.packed())
    assert found == [FRAME] * 3 and reader.refused > 0


def test_a_frame_that_the_next_one_would_complete_is_refused() -> None:
    reader, lacking = FrameReader(), FRAME.packed()[:400] + FRAME.packed()[404:]
    assert reader.feed(lacking) == []
    assert reader.feed(FRAME.packed()) == [FRAME] and reader.refused == SIZE - 4


@pytest.mark.parametrize(
    "wrong",
    [
        FRAME.packed()[:-1],
        FRAME.packed()[:48] + bytes(8) + FRAME.packed()[56:],
        FRAME.packed()[:24] + b"\x0c" + FRAME.packed()[25:],
        FRAME.packed()[:432] + b"\x00\x00\x00\x00\x00\x00\xf8\x7f" + FRAME.packed()[440:],
    ],
    ids=["short", "test value", "mode 12", "a joint that is no number"],
)
def test_a_wrong_frame_is_none(wrong: bytes) -> None:
    assert unpacked(wrong) is None


def test_replies_are_read_one_by_one() -> None:
    reader = ReplyReader()
    first, second = reader.feed(b"0,{12},MovJ(joint={1,2,3,4,5,6});-5,{},Stop();0,{[[116],[],[]")
    assert (first.error, first.number, first.command) == (0, 12, "MovJ")
    assert (second.error, second.word) == (-5, "script_running")
    (third,) = reader.feed(b"]},GetErrorID();\n")
    assert third.alarms == (116,)


def test_a_controller_that_is_not_in_tcp_mode_says_so_in_its_own_way() -> None:
    (reply,) = ReplyReader().feed(b"Control Mode Is Not Tcp")
    assert reply.error == -1 and reply.word == "not_in_tcp_mode"


@pytest.mark.parametrize("data", [b"oops;", b"0,{oops;", b"x" * (LONGEST + 1), b"\xff\xfe;"])
def test_nonsense_is_no_reply(data: bytes) -> None:
    with pytest.raises(NotAReply):
        ReplyReader().feed(data)


def test_alarms_are_read_where_the_last_brace_is_missing() -> None:
    """As in the example of the maker's README_V4.pdf, 3.40."""
    reader = ReplyReader()
    (alarm,) = reader.feed(b"0,{[[17,116],[],[],[],[2],[],[]],GetErrorId();")
    assert (alarm.error, alarm.alarms, alarm.command) == (0, (17, 116, 2), "GetErrorId")
    with pytest.raises(NotAReply):
        reader.feed(b"0,{12,MovJ();")


@pytest.mark.parametrize(
    ("error", "word"),
    [
        (-8, "licence_expired"),
        (-30001, "wrong_type_of_value_1"),
        (-40002, "value_out_of_range_2"),
        (-50003, "wrong_type_of_option_3"),
        (-60001, "option_out_of_range_1"),
        (-100001, "error -100001"),
        (-30000, "error -30000"),
        (-9, "error -9"),
    ],
)
def test_refusals_have_words(error: int, word: str) -> None:
    (reply,) = ReplyReader().feed(f"{error},{{}},MovJ();".encode())
    assert reply.word == word
