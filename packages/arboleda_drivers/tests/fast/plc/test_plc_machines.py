"""Orders of drivers of PLCs for a command, and reports by values that they read; on the example's belt."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.drivers import Home, MotionState, NotSent, Stop, StopMode
from arboleda_drivers.modbus.machine import WriteRequest
from arboleda_drivers.opcua.machine import Call
from arboleda_drivers.plc.plc_snapshot import UnreadableValue

from .plcs import EACH, PLCS

BELT = "ns=2;s=Device"


def register(table: str, address: int, *values: int) -> WriteRequest:
    return WriteRequest(table=table, address=address, values=values)


def comparable(order: Any) -> Any:
    """An order to an S7 by its addresses and bytes."""
    puts = getattr(order, "puts", None)
    return order if puts is None else [(each.place.text, each.raw) for each in puts]


@pytest.mark.parametrize(
    ("plc", "ordered"),
    [
        ("modbus", (register("holding", 0, 2, 2, 200, 1),)),
        (
            "opcua",
            Call(method="ns=2;s=Advance", on=BELT, given=(("uint16", 2), ("uint16", 200), ("uint16", 1))),
        ),
        (
            "s7",
            [
                ("DB2.DBB0", b"\2"),
                ("DB2.DBW2:INT", b"\0\2"),
                ("DB2.DBD4:DINT", b"\0\0\0\xc8"),
                ("DB2.DBW8", b"\0\1"),
            ],
        ),
    ],
)
def test_an_order_is_its_values_and_its_number_last(plc: str, ordered: object) -> None:
    order = PLCS[plc].made().order(PLCS[plc].told("advance", to="exit", speed_mm_s=200))
    assert comparable(order) == ordered
    assert getattr(order, "begins_last", True)


@pytest.mark.parametrize(
    ("plc", "without_numbers"),
    [
        ("modbus", (register("holding", 0, 1),)),
        ("opcua", Call(method="ns=2;s=Load", on=BELT)),
        ("s7", [("DB2.DBB0", b"\1")]),
    ],
)
def test_without_numbers_facts_and_state_are_all_that_is_said(plc: str, without_numbers: object) -> None:
    belt = PLCS[plc]
    plain = belt.made(sequence=None)
    assert comparable(plain.order(belt.told("load"))) == without_numbers
    report = plain.report(5.0, belt.shown(plain, state=1, part_at=1))
    assert (report.state, report.fact("part_at")) == (MotionState.MOVING, "entry")
    assert (report.accepted, report.done, report.rejected, report.failed) == (None, None, None, None)


@pytest.mark.parametrize(
    ("plc", "halt", "latch", "clear"),
    [
        ("modbus", (register("coil", 0, 1),), (register("coil", 1, 1),), (register("coil", 1, 0),)),
        ("opcua", *(Call(method=f"ns=2;s={name}", on=BELT) for name in ("Halt", "Latch", "Clear"))),
        ("s7", [("DB2.DBX12.0", b"\1")], [("DB2.DBX13.0", b"\1")], [("DB2.DBX13.0", b"\0")]),
    ],
)
def test_stops_have_orders_of_their_own_without_a_number(
    plc: str, halt: object, latch: object, clear: object
) -> None:
    machine = PLCS[plc].made()
    for mode, wanted in ((StopMode.HALT, halt), (StopMode.LATCH, latch), (StopMode.CLEAR, clear)):
        assert comparable(machine.order(Stop(id="s", robot="belt", mode=mode))) == wanted


@EACH
def test_accepted_and_done_name_the_command(plc: str) -> None:
    machine = PLCS[plc].made()
    machine.order(PLCS[plc].told("load"))
    report = machine.report(5.0, PLCS[plc].shown(machine, accepted=1, done=1, part_at=1))
    assert (report.accepted, report.done, report.state) == ("c1", "c1", MotionState.STOPPED)
    assert dict(report.facts or ()) == {"part_at": "entry", "gate": "closed", "mm_s": 0}


@EACH
def test_numbers_of_an_earlier_session_name_no_command(plc: str) -> None:
    belt = PLCS[plc]
    machine = belt.made()
    machine.begin(belt.shown(machine, accepted=1, done=1))
    machine.order(belt.told("load"))
    assert machine.report(5.0, belt.shown(machine, accepted=1, done=1)).done is None
    assert machine.report(6.0, belt.shown(machine, accepted=2, done=2)).done == "c1"


@EACH
def test_a_rejection_and_a_failure_have_their_words(plc: str) -> None:
    machine = PLCS[plc].made()
    machine.order(PLCS[plc].told("load"))
    report = machine.report(5.0, PLCS[plc].shown(machine, rejected=1, reason=1, failed=1, failure=9))
    assert (report.rejected, report.refusal) == ("c1", "busy")
    assert (report.failed, report.failure) == ("c1", "code 9")


@EACH
def test_a_query_is_answered_with_its_number(plc: str) -> None:
    belt = PLCS[plc]
    machine = belt.made()
    machine.order(belt.told("scan"))
    waiting = machine.report(5.0, belt.shown(machine, accepted=1, seen=2))
    answered = machine.report(6.0, belt.shown(machine, accepted=1, done=1, seen=2))
    assert (waiting.answered, waiting.answer) == (None, None)
    assert (answered.answered, answered.answer, answered.done) == ("c1", "bad", None)


@EACH
def test_a_value_without_a_word_is_no_report(plc: str) -> None:
    machine = PLCS[plc].made()
    place = PLCS[plc].at["part_at"]
    with pytest.raises(UnreadableValue, match=f"{place} is 77, for which there is no word"):
        machine.report(5.0, PLCS[plc].shown(machine, part_at=77))


@EACH
def test_a_program_that_stands_still_is_noticed(plc: str) -> None:
    machine = PLCS[plc].made()
    still = PLCS[plc].shown(machine, alive=3)
    machine.report(5.0, still)
    machine.report(5.9, still)
    place = PLCS[plc].at["alive"]
    with pytest.raises(UnreadableValue, match=f"the program of the PLC stands still: {place} is 3 for 1 s"):
        machine.report(6.1, still)


@EACH
def test_what_the_mapping_does_not_know_is_not_sent(plc: str) -> None:
    with pytest.raises(NotSent, match="has no word for Home"):
        PLCS[plc].made().order(Home(id="c1", robot="belt"))


@pytest.mark.parametrize("plc", ["opcua", "s7"])
def test_what_says_that_it_is_done_is_read_before_the_facts(plc: str) -> None:
    places = PLCS[plc].made().places
    at = [places.index(PLCS[plc].at[name]) for name in ("done", "accepted", "state", "part_at")]
    assert at == sorted(at)
