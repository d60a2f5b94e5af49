"""The belt that `arboleda virtual` plays behind a PLC, and what the drivers report of each of its faults."""

from __future__ import annotations

import itertools

import pytest

from arboleda.drivers import MotionState, Report, Stop, StopMode
from arboleda_driver_faults.plc import LineBroken
from arboleda_drivers.modbus.virtual.memory import DEVICE_BUSY, FAULTS, ILLEGAL_ADDRESS, BeltMemory
from arboleda_drivers.opcua.server import Bad
from arboleda_drivers.opcua.virtual.program import BeltProgram
from arboleda_drivers.plc.plc_snapshot import UnreadableValue
from arboleda_drivers.s7.machine import LEAST_PDU
from arboleda_drivers.s7.virtual.memory import FAULTS as S7_FAULTS
from arboleda_drivers.s7.virtual.memory import BeltMemory as S7Memory
from arboleda_drivers.virtual.faults import Faults

from .plcs import EACH, PLCS, Line


def stop(mode: StopMode) -> Stop:
    return Stop(id="s", robot="belt", mode=mode)


@EACH
def test_a_part_is_carried_to_the_exit_and_looked_at(plc: str) -> None:
    line = Line(plc)
    line.tell("load")
    loading = line.after(0.5)
    assert (loading.accepted, loading.state) == ("c1", MotionState.MOVING)
    assert line.after(1.0).fact("part_at") == "entry"
    line.tell("gate", to="open")
    line.tell("advance", to="exit", speed_mm_s=200)
    assert line.after(0.5).fact("mm_s") == 200
    report = line.after(1.5)
    assert (report.done, report.state, report.fact("part_at")) == ("c1", MotionState.STOPPED, "exit")
    line.tell("scan")
    assert line.after(0.1).answered is None
    assert (line.after(0.5).answered, line.after(0.1).answer) == ("c1", "good")


@EACH
def test_a_closed_gate_rejects(plc: str) -> None:
    line = Line(plc)
    line.tell("advance", to="exit", speed_mm_s=200)
    assert line.after(0.1).refusal == "gate_closed"


@EACH
def test_a_latch_ends_work_and_refuses_more_until_it_is_cleared(plc: str) -> None:
    line = Line(plc)
    line.tell("load")
    line.send(stop(StopMode.LATCH))
    report = line.after(2.0)
    assert (report.state, report.done) == (MotionState.STOP_LATCHED, None)
    line.tell("load")
    assert line.after(0.1).refusal == "latched"
    line.send(stop(StopMode.CLEAR))
    assert line.after(0.1).state is MotionState.STOPPED


@EACH
def test_it_stops_by_itself_when_the_heartbeat_ends(plc: str) -> None:
    line = Line(plc, "slow")
    line.tell("load")
    if plc == "opcua":
        line.wire.beat(0)  # nobody yet
    assert line.after(2.5).state is MotionState.MOVING
    line.wire.beat(1)
    assert line.after(1.9).state is MotionState.MOVING
    assert line.after(0.5).state is MotionState.STOPPED


@EACH
@pytest.mark.parametrize(
    ("fault", "field", "value"),
    [
        ("busy", "refusal", "busy"),
        ("deaf", "accepted", None),
        ("slow", "state", MotionState.MOVING),
        ("jam", "state", MotionState.MOVING),
        ("gives_up", "failure", "jam"),
        ("forgets", "done", None),
        ("drive_fault", "state", MotionState.FAULT),
        ("reboots", "boot_id", 2),
    ],
)
def test_a_fault_shows_in_what_is_reported(plc: str, fault: str, field: str, value: object) -> None:
    sound, faulty = Line(plc), Line(plc, fault)
    for line in (sound, faulty):
        line.tell("load")
    assert getattr(faulty.after(3.0), field) == value
    assert getattr(sound.after(3.0), field) != value


@EACH
@pytest.mark.parametrize("fault", ["lies", "blind"])
def test_done_without_the_fact_is_reported_as_such(plc: str, fault: str) -> None:
    line = Line(plc, fault)
    line.tell("load")
    report = line.after(2.0)
    assert (report.done, report.fact("part_at")) == ("c1", "none")


@pytest.mark.parametrize(
    ("plc", "fault", "why"),
    [
        ("modbus", "frozen", "stands still"),
        ("modbus", "nonsense", "input 10 is 77"),
        ("opcua", "frozen", "alive is"),
        ("opcua", "nonsense", "is 77"),
        ("opcua", "null", "is None"),
        ("opcua", "text", "is 'exit'"),
        ("s7", "frozen", "stands still"),
        ("s7", "nonsense", r"DB1\.DBW18 is 77, for which there is no word"),
    ],
)
def test_what_cannot_be_believed_is_no_report(plc: str, fault: str, why: str) -> None:
    line = Line(plc)
    line.after(0.2)
    line.switch(fault)
    with pytest.raises(UnreadableValue, match=why):
        line.after(2.0)


@EACH
def test_a_halt_may_not_halt_and_the_eye_may_see_a_bad_part(plc: str) -> None:
    line = Line(plc, "runs_on", "bad_part", "slow")
    line.tell("load")
    line.send(stop(StopMode.HALT))
    assert line.after(0.5).state is MotionState.MOVING
    line.after(10)
    line.tell("scan")
    assert line.after(4.0).answer == "bad"


def test_faults_of_modbus() -> None:
    faults = Faults(FAULTS)
    memory = BeltMemory(faults, lambda: 100.0)
    packet = bytes([0, 1, 0, 0, 0, 5, 1, 3, 2, 0, 7])
    assert memory.trace(True, packet) == packet
    faults.switch("wrong_unit", on=True)
    assert memory.trace(True, packet)[6] == 0
    faults.switch("noise", on=True)
    assert memory.trace(True, packet) != packet
    faults.switch("mute", on=True)
    assert (memory.trace(True, packet), memory.trace(False, packet)) == (b"", packet)
    faults.switch("refuses_reads", on=True)
    faults.switch("refuses_writes", on=True)
    assert memory.read("input", 0, 1) == ILLEGAL_ADDRESS
    assert memory.write("coil", 0, [1]) == DEVICE_BUSY


def test_faults_of_opcua() -> None:
    line = Line("opcua")
    line.switch("refuses_calls")
    assert line.tell("load") == "BadUserAccessDenied"
    line.switch("bad_status")
    with pytest.raises(LineBroken, match=str(Bad(status="BadSensorFailure").status)):
        line.after(0.1)
    line.switch("mute")
    with pytest.raises(LineBroken, match="does not answer"):
        line.after(0.1)


def test_faults_of_an_s7() -> None:
    line = Line("s7", "refuses_writes")
    assert line.tell("load") == "error_8404"
    line.switch("refuses_reads")
    with pytest.raises(LineBroken, match="nothing can be read"):
        line.after(0.1)


@pytest.mark.parametrize("given", [[], [1, 2], ["1"], [1.0]])
def test_other_arguments_than_its_own_are_refused_over_opcua(given: list[object]) -> None:
    line = Line("opcua")
    program = BeltProgram(line.rig.faults, lambda: line.rig.now, belt=line.rig.belt)
    assert program.call("Load", given) == "BadInvalidArgument"
    assert line.after(0.2).state is MotionState.STOPPED


def test_a_belt_that_gives_up_between_two_requests_to_an_s7_has_not_just_stopped() -> None:
    plc, now = PLCS["s7"], itertools.count(100.0, 0.3)
    machine, memory = plc.made(), S7Memory(Faults(S7_FAULTS, ["gives_up"]), lambda: next(now))
    for put in machine.order(plc.told("load")).puts:
        memory.write(put.place.db, put.place.byte, put.raw)

    def report() -> Report:
        held = {each: memory.read(each.db) for each in machine.blocks(LEAST_PDU)}
        raw = {each: bytes_[each.byte : each.byte + each.length] for each, bytes_ in held.items()}
        told: Report = machine.report(next(now), machine.values(raw))
        return told

    stopped = next(each for each in iter(report, None) if each.state is MotionState.STOPPED)
    assert (stopped.failed, stopped.failure) == ("c1", "jam")
