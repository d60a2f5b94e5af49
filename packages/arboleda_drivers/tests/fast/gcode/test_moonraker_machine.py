"""The driver at a virtual machine with Klipper behind Moonraker: pieces, stops, and what Klipper says."""

from __future__ import annotations

import json

import pytest

from arboleda.drivers.port import DriverError
from arboleda.model.commands import StopMode
from arboleda.model.messages import MotionState
from arboleda_drivers.gcode.moonraker_lines import parsed
from arboleda_drivers.gcode.moonraker_work import AHEAD_S, PIECE_S, STOP_S, Move
from arboleda_drivers.gcode.settings import Settings

from .gcode_rig import MoonrakerRig

SPEED_MM_S = 30.0  # half of the model's


def test_it_is_not_homed_until_it_has_been() -> None:
    rig = MoonrakerRig(homed=False)
    assert rig.report.state is MotionState.NOT_HOMED and rig.report.homed is False
    move = rig.move(10, 0, 0)
    assert rig.until(rejected=move).refusal == "not_homed"
    home = rig.home()
    assert rig.until(accepted=home).state is MotionState.NOT_HOMED
    assert rig.until(done=home).state is MotionState.STOPPED


def test_a_move_is_sent_in_pieces_as_it_goes_on() -> None:
    rig = MoonrakerRig()
    move = rig.move(150, 0, 0)
    rig.until(accepted=move)
    rig.wait(0.3)
    assert len(rig.pieces) <= AHEAD_S / PIECE_S + 1
    report = rig.until(done=move)
    assert report.q == pytest.approx((0.15, 0.0, 0.0)) and report.state is MotionState.STOPPED
    assert len(rig.pieces) == 150 / (SPEED_MM_S * PIECE_S)
    assert rig.moonraker.place == pytest.approx((150, 0, 0))


def test_an_answer_to_its_last_piece_is_no_end() -> None:
    rig = MoonrakerRig()
    move = rig.move(10, 0, 0)
    rig.until(accepted=move)
    assert rig.report.done != move and rig.report.state is MotionState.MOVING
    assert rig.until(done=move).q == pytest.approx((0.01, 0.0, 0.0))


def test_places_are_told_under_way() -> None:
    rig = MoonrakerRig()
    rig.move(150, 0, 0)
    rig.wait(2.0)
    assert rig.report.q is not None and 0.01 < rig.report.q[0] < 0.14


def test_a_move_to_where_it_is_is_done() -> None:
    rig = MoonrakerRig()
    rig.until(done=rig.move(0, 0, 0))


def test_a_stop_under_way_sends_no_more_and_keeps_the_place() -> None:
    rig = MoonrakerRig()
    move = rig.move(250, 0, 0)
    rig.wait(3.0)
    pieces, began_at, where = len(rig.pieces), rig.line.now, rig.moonraker.place[0]
    stop = rig.stop()
    report = rig.until(accepted=stop)
    assert len(rig.pieces) == pieces and rig.line.now - began_at < AHEAD_S + 1.0
    assert report.state is MotionState.STOPPED and report.homed is True and report.done != move
    assert rig.moonraker.place[0] - where <= (AHEAD_S + PIECE_S) * SPEED_MM_S
    assert report.q == pytest.approx((rig.moonraker.place[0] / 1000, 0, 0))
    rig.wait(3.0)
    assert len(rig.pieces) == pieces
    rig.until(done=rig.move(250, 0, 0))


def test_a_latch_stays_until_it_is_cleared() -> None:
    rig = MoonrakerRig()
    rig.until(accepted=rig.stop(StopMode.LATCH), state=MotionState.STOP_LATCHED)
    rig.until(accepted=rig.stop(StopMode.CLEAR), state=MotionState.STOPPED)


def test_a_stop_while_it_homes_shuts_klipper_down() -> None:
    rig = MoonrakerRig(homed=False)
    home = rig.home()
    rig.wait(0.5)
    stop = rig.stop()
    report = rig.until(accepted=stop)
    assert report.state is MotionState.FAULT and report.facts[0] == ("health", "shutdown")
    assert report.done != home and report.q is None
    assert rig.until(rejected=rig.home()).refusal == "shutdown"
    rig.moonraker.press_reset()
    rig.until(boot_id=2, state=MotionState.NOT_HOMED)
    rig.until(done=rig.home())


@pytest.mark.parametrize("fault", ["stall", "no_ok"])
def test_what_does_not_end_by_itself_is_shut_down(fault: str) -> None:
    rig = MoonrakerRig()
    rig.faults.switch(fault, on=True)
    rig.move(150, 0, 0)
    rig.wait(2.5)
    began_at = rig.line.now
    report = rig.until(accepted=rig.stop())
    assert report.state is MotionState.FAULT and STOP_S < rig.line.now - began_at < 5.0


def test_a_shutdown_that_is_not_taken_confirms_no_stop() -> None:
    rig = MoonrakerRig()
    rig.faults.switch("stall", on=True)
    rig.faults.switch("deaf", on=True)
    rig.move(150, 0, 0)
    rig.wait(2.5)
    stop = rig.stop()
    rig.wait(20.0)
    assert rig.report.accepted != stop and rig.report.state is MotionState.MOVING
    rig.faults.switch("deaf", on=False)
    rig.until(accepted=stop, state=MotionState.FAULT)


def test_a_move_whose_turn_does_not_come_is_refused_and_never_made() -> None:
    rig = MoonrakerRig()
    rig.faults.switch("busy_elsewhere", on=True)
    move = rig.move(50, 0, 0)
    assert rig.until(rejected=move).refusal == "busy_elsewhere"
    rig.faults.switch("busy_elsewhere", on=False)
    rig.wait(3.0)
    assert rig.pieces == [] and rig.moonraker.place[0] == 0.0
    rig.until(done=rig.move(50, 0, 0))


def test_a_turn_that_was_never_answered_keeps_no_later_move() -> None:
    rig = MoonrakerRig()
    rig.faults.switch("no_ok", on=True)
    rig.until(rejected=rig.move(50, 0, 0))
    rig.faults.switch("no_ok", on=False)
    rig.until(done=rig.move(50, 0, 0))


def test_a_client_that_moves_it_meanwhile_ends_the_move() -> None:
    rig = MoonrakerRig()
    rig.faults.switch("second_client", on=True)
    move = rig.move(150, 0, 0)
    assert rig.until(failed=move).failure == "moved_elsewhere"
    rig.faults.switch("second_client", on=False)
    rig.until(state=MotionState.STOPPED, homed=True)


def test_a_detour_by_another_client_between_two_pieces_ends_the_move() -> None:
    rig = MoonrakerRig()
    move = rig.move(250, 0, 0)
    rig.wait(2.0)
    klipper = rig.moonraker._klipper
    ordered, sent = klipper.ordered, len(rig.pieces)
    rig.moonraker._add((ordered[0], 90.0, 0.0), 50.0)
    klipper.ordered = ordered  # as the piece after it leads on
    assert rig.until(failed=move).failure == "moved_elsewhere"
    assert 2.0 < rig.moonraker.place[1] < 60.0 and len(rig.pieces) < sent + 8
    rig.until(state=MotionState.STOPPED, homed=True)


def test_a_way_has_places_near_it() -> None:
    move = Move(id="1", sent_at=0.0, start=(0, 0, 0), goal=(100, 0, 0), base=(0, 0, 0), mm_s=30.0)
    assert move.leads_by((50, 1.5, 0)) and move.leads_by((101, 0, 0))
    assert not move.leads_by((50, 3, 0)) and not move.leads_by((-3, 0, 0))


def test_a_machine_that_another_client_moves_takes_no_move() -> None:
    rig = MoonrakerRig()
    script = {
        "jsonrpc": "2.0",
        "id": 9999,
        "method": "printer.gcode.script",
        "params": {"script": "G1X90F900"},
    }
    rig.moonraker.step(rig.line.now, json.dumps(script).encode() + b"\n")
    rig.wait(1.0)
    assert rig.report.state is MotionState.MOVING and dict(rig.report.facts)["mode"] == "busy"
    assert rig.until(rejected=rig.move(10, 0, 0)).refusal == "not_idle"
    assert rig.until(rejected=rig.home()).refusal == "not_idle"


def test_an_offset_of_the_coordinates_does_not_count() -> None:
    rig = MoonrakerRig("offset")
    assert rig.until(done=rig.move(30, 20, 5)).q == pytest.approx((0.03, 0.02, 0.005))
    assert rig.moonraker.place == pytest.approx((30, 20, 5))


def test_beyond_its_travel_no_piece_is_sent() -> None:
    rig = MoonrakerRig(zeros_mm=(300.0, 0.0, 0.0))
    assert rig.until(rejected=rig.move(250, 0, 0)).refusal == "beyond_travel"
    assert rig.pieces == []


def test_an_error_rejects_a_move_before_it_is_taken() -> None:
    rig = MoonrakerRig("refuses")
    assert rig.until(rejected=rig.move(50, 0, 0)).refusal == "error"
    assert rig.until(state=MotionState.STOPPED).homed is True


def test_an_error_under_way_fails_it() -> None:
    rig = MoonrakerRig()
    move = rig.move(150, 0, 0)
    rig.wait(2.0)
    rig.faults.switch("refuses", on=True)
    assert rig.until(failed=move).failure == "error"
    rig.until(state=MotionState.STOPPED, homed=True)


def test_homing_that_finds_no_switch_fails_without_a_shutdown() -> None:
    rig = MoonrakerRig("homing_fails", homed=False)
    home = rig.home()
    assert rig.until(failed=home).failure == "homing_no_switch"
    rig.until(state=MotionState.NOT_HOMED)


@pytest.mark.parametrize(("fault", "word"), [("lie", (0, 0, 0)), ("short", (148, 0, 0))])
def test_a_move_that_ends_elsewhere_is_done_there(fault: str, word: tuple[float, ...]) -> None:
    rig = MoonrakerRig()
    rig.faults.switch(fault, on=True)
    report = rig.until(done=rig.move(150, 0, 0))
    assert report.q == pytest.approx(tuple(each / 1000 for each in word))


@pytest.mark.parametrize("state", ["shutdown", "error"])
def test_a_state_of_klipper_fails_the_move_until_a_restart(state: str) -> None:
    rig = MoonrakerRig()
    move = rig.move(150, 0, 0)
    rig.wait(1.0)
    rig.faults.switch(state, on=True)
    assert rig.until(failed=move).failure == "shutdown"  # which is the word of what it refuses in both
    rig.wait(2.0)
    assert rig.report.facts == (("health", state), ("mode", state)) and rig.report.state is MotionState.FAULT
    rig.faults.switch(state, on=False)
    rig.moonraker.press_reset()
    rig.until(boot_id=2, state=MotionState.NOT_HOMED)


def test_klipper_that_begins_anew_has_booted() -> None:
    rig = MoonrakerRig()
    move = rig.move(150, 0, 0)
    rig.wait(1.0)
    rig.faults.switch("boot", on=True)
    report = rig.until(at_most_s=5.0, boot_id=2, state=MotionState.FAULT)
    assert report.q is None and report.failed != move and dict(report.facts)["health"] == "disconnected"
    rig.faults.switch("boot", on=False)
    rig.until(boot_id=2, state=MotionState.NOT_HOMED)


def test_motors_that_were_switched_off_are_to_be_homed() -> None:
    rig = MoonrakerRig()
    rig.faults.switch("motors_off", on=True)
    rig.until(state=MotionState.NOT_HOMED, homed=False)


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("mute", "has not answered for 3 s"),
        ("no_key", "does not let the driver in: Unauthorized"),
        ("no_position", "has no position of the machine"),
        ("garbled", "has no position of the machine"),
        ("unplugged", "the line is gone"),
    ],
)
def test_a_line_that_is_no_use_is_lost_and_comes_back(fault: str, words: str) -> None:
    rig = MoonrakerRig()
    rig.faults.switch(fault, on=True)
    report = rig.until(state=MotionState.NO_LINK)
    while fault == "no_key" and words not in str(report.lost):
        report = rig.until(state=MotionState.NO_LINK)
    assert words in str(report.lost)
    rig.faults.switch(fault, on=False)
    rig.until(state=MotionState.STOPPED, homed=True)


def test_a_lost_line_ends_the_move_by_itself_and_what_is_left_is_awaited() -> None:
    rig = MoonrakerRig()
    rig.move(250, 0, 0)
    rig.wait(2.0)
    pieces = len(rig.pieces)
    rig.faults.switch("unplugged", on=True)
    rig.until(state=MotionState.NO_LINK)
    rig.wait(0.2)
    rig.faults.switch("unplugged", on=False)
    rig.until(state=MotionState.MOVING)
    rig.until(state=MotionState.STOPPED)
    assert len(rig.pieces) == pieces and rig.moonraker.place[0] < 150


@pytest.mark.parametrize(
    "line", ["[" * 100_000, '{"jsonrpc": "2.0", "id": true, "result": 1}', "7", "NaN", ""]
)
def test_what_is_no_answer_means_nothing(line: str) -> None:
    assert parsed(line) is None


@pytest.mark.parametrize(
    ("keys", "why"),
    [
        ({"serial": "/dev/ttyUSB0"}, "needs host and port"),
        ({"host": "h", "port": 7125, "homing": False}, "only what was homed"),
        ({"host": "h", "port": 7125, "stop_keeps_place": True}, "is for dialect: marlin"),
    ],
)
def test_settings_that_do_not_fit_are_refused(keys: dict[str, object], why: str) -> None:
    with pytest.raises(DriverError, match=why):
        Settings(dialect="moonraker", **keys)  # type: ignore[arg-type]
