"""Verbs that are written: their values, their number, and what a busy, a done and an error say of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from arboleda.drivers import MotionState, Stop, StopMode
from arboleda.drivers.port import DriverError
from arboleda.model.commands import Command
from arboleda_drivers.opcua.keys import Sequence, Verb
from arboleda_drivers.opcua.machine import NodeValue, OpcUaDevice, Writing
from arboleda_drivers.opcua.nodes import Order, Variable, Write
from arboleda_drivers.opcua.settings import Settings
from arboleda_drivers.plc.plc_snapshot import UnreadableValue

from ..plc.plcs import PLCS

LOAD = Verb(write=(Write(node="i=1", value=4, type="byte"),))
SEQUENCE = Sequence(type="int32", write="i=2", busy="i=3", done="i=4", error=Variable(node="i=5"))
REST = {"i=2": 0, "i=3": False, "i=4": 0, "i=5": 0}


def made(**changes: Any) -> OpcUaDevice:
    """A belt that is only loaded, by the variables 1 to 5."""
    given: dict[str, Any] = {"sequence": SEQUENCE, "verbs": {"load": LOAD}} | changes
    machine = OpcUaDevice(PLCS["opcua"].device, Settings(url="opc.tcp://10.0.0.7:4840", **given))
    machine.begin({node: REST.get(node, 0) for node in machine.places})
    return machine


def load_command(id: str = "c1") -> Command:
    return PLCS["opcua"].device.kind.command(id=id, robot="belt", verb="load", values={})


def shown(**values: object) -> dict[str, object]:
    names = {"asked": "i=2", "busy": "i=3", "done": "i=4", "error": "i=5"}
    return REST | {names[name]: value for name, value in values.items()}


def test_the_number_is_written_last_in_a_step_of_its_own() -> None:
    value, number = (
        NodeValue(node="i=1", type="byte", value=4),
        NodeValue(node="i=2", type="int32", value=1),
    )
    order = made().order(load_command())
    assert order == Writing(steps=((value,), (number,)), begins_last=True)


def test_without_numbers_each_value_is_a_step() -> None:
    verb = Verb(write=(LOAD.write[0], replace(LOAD.write[0], node="i=6")))
    order = made(sequence=None, verbs={"load": verb}).order(load_command())
    assert isinstance(order, Writing)
    assert [[put.node for put in step] for step in order.steps] == [["i=1"], ["i=6"]]
    assert not order.begins_last


def test_busy_accepts_the_number_that_was_asked_for_and_the_arm_moves() -> None:
    machine = made()
    machine.order(load_command())
    waiting = machine.report(1.0, shown(asked=1))
    working = machine.report(2.0, shown(asked=1, busy=True))
    ended = machine.report(3.0, shown(asked=1, done=1))
    assert [each.accepted for each in (waiting, working, ended)] == [None, "c1", "c1"]
    assert [each.done for each in (waiting, working, ended)] == [None, None, "c1"]
    assert working.state is MotionState.MOVING and ended.state is MotionState.STOPPED


def test_a_busy_of_before_accepts_nothing() -> None:
    machine = made()
    machine.report(1.0, shown(busy=True))
    machine.order(load_command())
    assert machine.report(2.0, shown(asked=1, busy=True)).accepted is None
    machine.report(3.0, shown(asked=1))
    assert machine.report(4.0, shown(asked=1, busy=True)).accepted == "c1"


def test_an_error_fails_the_number_that_ended_with_it_and_no_other() -> None:
    machine = made()
    machine.order(load_command())
    failed = machine.report(1.0, shown(asked=1, done=1, error=7))
    assert (failed.failed, failed.failure, failed.done) == ("c1", "code 7", None)
    machine.order(load_command("c2"))
    cleared = machine.report(2.0, shown(asked=2, busy=True, done=1))
    assert (cleared.failed, cleared.failure, cleared.done, cleared.accepted) == ("c1", "code 7", None, "c2")
    ended = machine.report(3.0, shown(asked=2, done=2))
    assert (ended.done, ended.failed) == ("c2", None)
    next_error = machine.report(4.0, shown(asked=2, done=2, error=3))
    assert (next_error.done, next_error.failed) == ("c2", None)


@pytest.mark.parametrize(
    ("error", "word"), [(True, "no reason given"), (False, None), ("jam", "jam"), ("", None)]
)
def test_an_error_may_be_a_bool_or_text(error: object, word: str | None) -> None:
    machine = made()
    machine.order(load_command())
    assert machine.report(1.0, shown(asked=1, done=1, error=error)).failure == word


@pytest.mark.parametrize(("name", "value"), [("busy", 1), ("busy", None), ("error", 1.5), ("done", -1)])
def test_no_value_of_another_type_is_a_report(name: str, value: object) -> None:
    with pytest.raises(UnreadableValue, match=r"^i=[345] is "):
        made().report(1.0, shown(**{name: value}))


def test_a_number_that_is_asked_for_already_is_not_given() -> None:
    """The program would notice no change."""
    machine = made()
    machine.begin(shown(asked=1))
    order = machine.order(load_command())
    assert isinstance(order, Writing) and order.steps[-1][0].value == 2


@pytest.mark.parametrize(
    ("type", "last", "first"),
    [("sbyte", 127, 1), ("byte", 255, 1), ("int16", 32767, 1), ("float", 65535, 1.0)],
)
def test_numbers_begin_anew_where_their_type_ends(type: Any, last: int, first: object) -> None:
    machine = made(sequence=replace(SEQUENCE, type=type))
    machine.begin(shown(asked=last, done=last))
    order = machine.order(load_command())
    assert isinstance(order, Writing) and order.steps[-1][0].value == first


def test_numbers_of_a_type_of_floats_are_read_as_such() -> None:
    machine = made(sequence=replace(SEQUENCE, type="double"))
    machine.order(load_command())
    assert machine.report(1.0, shown(asked=1.0, done=1.0)).done == "c1"
    with pytest.raises(UnreadableValue, match=r"i=4 is 1\.5"):
        machine.report(2.0, shown(asked=1.0, done=1.5))
    with pytest.raises(UnreadableValue, match=r"i=4 is 1\.0"):
        made().report(1.0, shown(done=1.0))


def test_a_stop_is_written_without_a_number() -> None:
    machine = made(halt=Order(write=(Write(node="i=9", value=True, type="bool"),)))
    halt = machine.order(Stop(id="s", robot="belt", mode=StopMode.HALT))
    assert halt == Writing(steps=((NodeValue(node="i=9", type="bool", value=True),),), begins_last=True)


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({}, "needs either call, a method, or write"),
        ({"call": "i=1", "on": "i=2", "write": LOAD.write}, "needs either call, a method, or write"),
        ({"call": "i=1"}, "call needs on, the object"),
        ({"on": "i=1", "write": LOAD.write}, "on and given belong to call"),
    ],
)
def test_an_order_is_either_called_or_written(given: dict[str, Any], why: str) -> None:
    with pytest.raises(DriverError, match=why):
        Order(**given)


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"done": "i=1"}, "needs either accepted, a number, or busy"),
        ({"done": "i=1", "busy": "i=2"}, "busy needs write"),
        ({"done": "i=1", "accepted": "i=2", "type": "bool"}, "type is bool; allowed: sbyte"),
        (
            {"done": "i=1", "accepted": "i=2", "failed": "i=3", "error": Variable(node="i=4")},
            "error is in place of failed",
        ),
    ],
)
def test_a_handshake_that_proves_nothing_is_refused(given: dict[str, Any], why: str) -> None:
    with pytest.raises(DriverError, match=why):
        Sequence(**given)
