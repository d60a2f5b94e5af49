"""Mappings of an S7 in a plant file: what is wrong is told with its place and what to write."""

from __future__ import annotations

import pytest
from plc.mappings import EXAMPLE, Example

from arboleda.model.plant_model import Robot
from arboleda.plant_file import loader
from arboleda_drivers.s7.settings import Settings

MAPPED = Example(file="s7.yaml", driver="s7", settings=Settings)
LOAD = "load: {write: [{at: DB2.DBB0, value: 1}]}"
MM_S = 'mm_s: {at: "DB1.DBW22:INT"}'
GATE = "gate: {at: DB1.DBX20.0, words: {closed: 0, open: 1}}"
SPEED = '{at: "DB2.DBD4:DINT", value: $speed_mm_s}'
HOST = "host: 127.0.0.1"
ACCEPTED = "accepted: DB1.DBW6"
HALT = "halt: [{at: DB2.DBX12.0, value: true}]"


@pytest.fixture(scope="module")
def belt() -> Robot:
    return loader.load(EXAMPLE / "s7.yaml").robots["belt"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("name: s7_conveyor", "name: another"),
        (ACCEPTED, "busy: DB1.DBX6.0"),
        (LOAD, "load: {write: [{at: M0.0, value: true}]}"),
        (SPEED, "{at: DB2.DBW4, value: $speed_mm_s}"),
        ("- {at: DB2.DBB0, value: 3}", "- {at: DB2.DBX0.0, value: $to, words: {closed: 0, open: 1}}"),
        ("heartbeat: DB2.DBW10", "heartbeat: MB7"),
    ],
)
def test_a_mapping_that_is_good(belt: Robot, old: str, new: str) -> None:
    assert MAPPED.problems(belt, old, new) == ()


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (LOAD, "", "verbs: load of a belt is missing: say what is written for it"),
        (LOAD, "load: {}", "verbs.load: nothing is written for load"),
        (LOAD, "load: {write: [{at: IB0, value: 1}]}", "IB0 is an input, which nobody writes; allowed: DB"),
        (LOAD, "load: {write: [{at: DB2.DBB0, value: 300}]}", "300 is no BYTE"),
        (LOAD, "load: {write: [{at: DB2.DBX0.0, value: 1}]}", "1 is no BOOL"),
        (LOAD, "load: {write: [{at: DB2.DBX0.0, value: a, words: {a: 2}}]}", "a: 2 is no BOOL"),
        (MM_S, "speed: {at: DB1.DBW22}", "facts.speed: a belt has no fact speed; there are"),
        (MM_S, "mm_s: {at: DB1}", "facts.mm_s: 'DB1' is no address; write it as DB1.DBX0.0"),
        (MM_S, "mm_s: {at: DB1.DBX22.0}", "mm_s.at: DB1.DBX22.0 is of the type BOOL, and the value is"),
        (MM_S, 'mm_s: {at: "DB1.DBD24:REAL"}', "is of the type REAL, and the value is"),
        (GATE, "gate: {at: DB1.DBX20.0}", "is a number, and the value is closed, open; write words"),
        (GATE, "gate: {at: DB1.DBX20.0, words: {closed: 0}}", "gate: has no number for open"),
        (SPEED, "{at: DB2.DBB4, value: $speed_mm_s}", "400 is no BYTE; write a type that holds"),
        (SPEED, "{at: DB2.DBX4.0, value: $speed_mm_s}", "at: the value is 100, 200, 400; allowed: BYTE"),
        (SPEED, "{at: DB2.DBW4, value: $sped}", "advance has no parameter sped"),
        (HALT, "", "halt is missing: say what is written ends a motion"),
        (HALT, "halt: [{at: DB2.DBX12.0, value: $to}]", "halt has no parameters; write a value"),
        (ACCEPTED, "", "needs either accepted, a number, or busy"),
        (ACCEPTED, "busy: DB1.DBW6", "busy is DB1.DBW6, which is no bit"),
        (ACCEPTED, 'accepted: "DB1.DBD6:REAL"', "accepted is DB1.DBD6:REAL, of the type REAL; allowed: BYTE"),
        (", latched: 3}}", ", stuck: 3}}", "state.words.stuck: there is no state stuck"),
        (HOST, 'host: ""', "host is empty"),
        (HOST, f"{HOST}\n            slot: 40", "allowed: rack 0 to 7, slot 0 to 31"),
        (HOST, f"{HOST}\n            poll_s: 5", "poll_s is 5; allowed: 0.005 to 0.5"),
        (HOST, f"{HOST}\n            timeout_s: 9", "timeout_s is 9; allowed: 0.01 to 5"),
        ("alive: DB1.DBW14", "alive: M0.5", "alive is M0.5, of the type BOOL; allowed: BYTE"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(belt: Robot, old: str, new: str, told: str) -> None:
    problems = MAPPED.problems(belt, old, new)
    assert any(told in each for each in problems), problems
