"""`/{robot}/status`: a report survives the hop, and a foreign status is refused by key."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.errors import PayloadError
from arboleda.model.messages import MotionState, Receipt, Report, Tokens
from arboleda.model.sentence import OWN
from arboleda.testing import shipped
from arboleda.wire import rejections
from arboleda.wire.board import DENIED
from arboleda.wire.status import STALE, Status, from_status, to_status

ROBOTS = shipped("sis_a").robots
UINT = st.integers(0, 2**32 - 1)
IDS = st.none() | st.from_regex(r"[0-9]{1,10}-[0-9]{1,6}", fullmatch=True)
TOKEN = st.none() | st.from_regex(r"[A-Za-z0-9_.-]{1,12}", fullmatch=True)
FLAG = st.none() | st.booleans()
SAID = {
    "epoch": st.none() | UINT,
    "boot_id": st.none() | UINT,
    "accepted": IDS,
    "done": IDS,
    "state": st.none() | st.sampled_from(MotionState),
    "homed": FLAG,
    "receipt": st.none() | st.builds(Receipt, UINT, UINT, st.none() | UINT),
    "tokens": st.none() | st.builds(Tokens, TOKEN, TOKEN),
}
ON = SetEffector(id="", robot="ra1", on=True)
FAR = MoveJoints(id="", robot="ra1", q=(9.0, 0.0, 0.0))
OBEYED = rejections.obeyed(ROBOTS["ra1"], ON, "/teleop")
OTHERS = (
    OBEYED,
    rejections.obeyed(ROBOTS["ra1"], ON, ""),
    rejections.refused(ROBOTS["ra1"], FAR, "limite", "/teleop", by_board=False),
    OWN(text="somebody moved it"),
)
FOREIGN = st.sampled_from([{}, *({"foreign": said, "foreign_obeyed": 3} for said in OTHERS)])
OF_ARMS = {"effector": FLAG, "piece": FLAG}
JOINTS = st.none() | st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 3)
REJECTED = st.sampled_from([{}, {"rejected": "7-1", "refusal": "sin_ref"}])


@given(said=st.fixed_dictionaries({**SAID, **OF_ARMS}), q=JOINTS, rejected=REJECTED, foreign=FOREIGN)
def test_a_report_of_an_arm_comes_back(said: dict, q: tuple | None, rejected: dict, foreign: dict) -> None:
    report = Report(at=3.0, robot="ra1", q=q, **said, **rejected, **foreign)
    assert from_status(3.0, ROBOTS["ra1"], to_status(ROBOTS["ra1"], report)) == report


@given(said=st.fixed_dictionaries(SAID), node=st.none() | st.integers(0, 8))
def test_a_report_of_a_mobile_comes_back(said: dict, node: int | None) -> None:
    report = Report(at=3.0, robot="rm_sis_a", node=node, **said)
    assert from_status(3.0, ROBOTS["rm_sis_a"], to_status(ROBOTS["rm_sis_a"], report)) == report


def test_it_reads_like_a_diagnostic() -> None:
    report = Report(
        at=3.0,
        robot="ra1",
        epoch=9,
        state=MotionState.MOVING,
        q=(0.5, -0.25, 0.0),
        homed=True,
        accepted="7-1",
    )
    assert to_status(ROBOTS["ra1"], report) == Status(
        name="arboleda: ra1",
        hardware_id="ra_1",
        level=0,
        message="moving",
        values={"epoch": "9", "accepted": "7-1", "state": "1", "q": "0.5,-0.25,0.0", "homed": "true"},
    )


def test_a_robot_without_link_is_stale() -> None:
    status = to_status(ROBOTS["ra1"], Report(at=0.0, robot="ra1", state=MotionState.NO_LINK))
    assert (status.level, status.message) == (STALE, "no link")


BAD = {
    "epoch not a number": {"epoch": "nine"},
    "epoch in other digits": {"epoch": "٣"},
    "epoch too large": {"epoch": "4294967296"},
    "boot_id negative": {"boot_id": "-1"},
    "an empty id": {"accepted": ""},
    "an id with a blank": {"done": "7 1"},
    "an unknown state": {"state": "7"},
    "q too short": {"q": "0.0,0.0"},
    "q not finite": {"q": "0.0,0.0,nan"},
    "q infinite by size": {"q": "0.0,0.0,1e999"},
    "q with an underscore": {"q": "0.0,0.0,1_0"},
    "q empty": {"q": ""},
    "node of an arm": {"node": "1"},
    "homed as a number": {"homed": "1"},
    "piece in capitals": {"piece": "True"},
    "rejected alone": {"rejected": "7-1"},
}


@pytest.mark.parametrize("values", BAD.values(), ids=BAD.keys())
def test_a_wrong_value_is_refused_by_key(values: dict[str, str]) -> None:
    good = to_status(ROBOTS["ra1"], Report(at=0.0, robot="ra1", state=MotionState.STOPPED))
    with pytest.raises(PayloadError, match=next(iter(values))):
        from_status(0.0, ROBOTS["ra1"], replace(good, values={**good.values, **values}))


@pytest.mark.parametrize(
    ("robot", "key", "value"),
    [
        ("rm_sis_a", "effector", "true"),
        ("rm_sis_a", "piece", "false"),
        ("rm_sis_a", "q", "0"),
        ("ra1", "node", "0"),
    ],
)
def test_what_its_kind_of_robot_cannot_say_is_refused_by_key(robot: str, key: str, value: str) -> None:
    good = to_status(ROBOTS[robot], Report(at=0.0, robot=robot, state=MotionState.STOPPED))
    with pytest.raises(PayloadError, match=f"{key} .*{robot}"):
        from_status(0.0, ROBOTS[robot], replace(good, values={**good.values, key: value}))


def test_the_status_of_another_robot_is_refused() -> None:
    status = to_status(ROBOTS["rm_sis_a"], Report(at=0.0, robot="rm_sis_a"))
    with pytest.raises(PayloadError, match="rm_sis_a"):
        from_status(0.0, ROBOTS["ra1"], status)


@given(values=st.dictionaries(st.sampled_from(["epoch", "q", "node", "state", "homed", "done"]), st.text()))
def test_whatever_the_values_the_answer_is_a_report_or_a_payload_error(values: dict) -> None:
    status = Status(name="arboleda: ra1", hardware_id="", level=0, message="", values=values)
    try:
        sentence = repr(from_status(0.0, ROBOTS["ra1"], status))
    except PayloadError as error:
        sentence = str(error)
    assert sentence.isprintable()


@pytest.mark.parametrize(
    "made_of",
    [
        None,
        "",
        "no JSON",
        "[" * 1500,
        "[]",
        '{"key": "foreign.obeyed"}',
        '{"key": "foreign.obeyed", "values": {}}',
        '{"key": "foreign.obeyed", "values": {"robot": null}}',
        '{"key": "robot.offline", "values": {"robot": "ra1"}}',
        json.dumps(rejections.obeyed(ROBOTS["ra1"], ON, "/panel").data()),
    ],
)
def test_what_a_sentence_is_made_of_counts_only_where_it_says_the_same(made_of: str | None) -> None:
    status = to_status(ROBOTS["ra1"], Report(at=0.0, robot="ra1", foreign=OBEYED))
    values = {key: value for key, value in status.values.items() if key != "foreign_said"}
    if made_of is not None:
        values["foreign_said"] = made_of
    report = from_status(0.0, ROBOTS["ra1"], replace(status, values=values))
    assert report.foreign == OWN(text=str(OBEYED))


def test_why_there_is_no_link_crosses_too() -> None:
    status = to_status(ROBOTS["ra1"], Report(at=0.0, robot="ra1", state=MotionState.NO_LINK, lost=DENIED()))
    assert from_status(0.0, ROBOTS["ra1"], status).lost == DENIED()


@pytest.mark.parametrize(("characters", "read"), [(2000, True), (2001, False)])
def test_what_a_sentence_is_made_of_is_read_up_to_2000_characters(characters: int, read: bool) -> None:
    status = to_status(ROBOTS["ra1"], Report(at=0.0, robot="ra1", foreign=OBEYED))
    values = {**status.values, "foreign_said": json.dumps(OBEYED.data()).ljust(characters)}
    report = from_status(0.0, ROBOTS["ra1"], replace(status, values=values))
    assert report.foreign == (OBEYED if read else OWN(text=str(OBEYED)))
