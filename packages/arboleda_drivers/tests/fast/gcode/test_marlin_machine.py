"""The driver of a machine with Marlin, against a virtual one, under a clock moved by hand."""

from __future__ import annotations

import re

import pytest

from arboleda.drivers.port import DriverError
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import MotionState, Report
from arboleda_drivers.connections.link import CommandRequest, Opened
from arboleda_drivers.connections.stream import Event, Received, Write
from arboleda_drivers.gcode.dialects import machine
from arboleda_drivers.gcode.marlin_lines import (
    Busy,
    Capability,
    Firmware,
    Ok,
    Place,
    Refusal,
    Resend,
    Start,
    Trouble,
    numbered,
    parsed,
)
from arboleda_drivers.gcode.settings import Settings

from .gcode_rig import MarlinRig, gantry

STILL = MotionState.STOPPED
GANTRY, SETTINGS = gantry("marlin.yaml")
HELLO = ("ok", "FIRMWARE_NAME:Marlin 2.1.2", "Cap:EMERGENCY_PARSER:1", "ok")
AT_ZERO = "X:0.00 Y:0.00 Z:0.00 E:0.00 Count X:0 Y:0 Z:0"


class Talk:
    """Driver on a line that was opened just now; the test says what the controller says."""

    def __init__(self) -> None:
        self._machine = machine([GANTRY], SETTINGS)
        self._machine.step(100.0, [])
        self._step(Opened())

    def hear(self, *lines: str) -> list[str]:
        """The lines that the driver writes once it has heard these, without numbers."""
        return self._step(Received(data="".join(f"{line}\r\n" for line in lines).encode()))

    def ask(self, command: Command) -> list[str]:
        return self._step(CommandRequest(command=command))

    def greet(self) -> None:
        self.hear(*HELLO, "ok", "ok", AT_ZERO, "ok")

    def _step(self, event: Event) -> list[str]:
        out = self._machine.step(100.0, [event])
        for each in out:
            if isinstance(each, Report):
                self.report = each
        written = [each.data.decode().strip() for each in out if isinstance(each, Write)]
        return [re.sub(r"^N\d+ |\*\d+$", "", each) for each in written]


def mm(report: Report) -> tuple[float, ...]:
    assert report.q is not None
    return tuple(round(each * 1000, 2) for each in report.q)


def test_a_move_is_done_by_the_place_after_all_moves_have_ended() -> None:
    rig = MarlinRig()
    id = rig.move(60, 0, 0)
    accepted = rig.until(accepted=id)
    assert (accepted.state, accepted.done, accepted.q) == (
        MotionState.MOVING,
        rig.reports[0].done or "7-1",
        None,
    )
    done = rig.until(done=id, state=STILL)
    assert mm(done) == (60, 0, 0) and rig.marlin.place == (60, 0, 0)
    assert rig.written.index(b"G1X60.000Y0.000Z0.000F1800.0*") < rig.written.rindex(b"M400*")


def test_it_is_busy_for_long_and_the_line_stays() -> None:
    rig = MarlinRig(speed_percent=5)
    rig.until(done=rig.move(60, 0, 0), at_most_s=60)
    assert all(each.lost is None for each in rig.reports)


@pytest.mark.parametrize(("fault", "there"), [("lie", (0, 0, 0)), ("short", (58, 0, 0))])
def test_a_move_that_ends_elsewhere_is_done_there(fault: str, there: tuple[float, ...]) -> None:
    rig = MarlinRig(fault)
    assert mm(rig.until(done=rig.move(60, 0, 0), state=STILL)) == there  # the plant finds that


def test_it_has_to_be_homed_as_nobody_tells_whether_it_is() -> None:
    rig = MarlinRig(homed=False)
    assert (rig.report.state, rig.report.homed) == (MotionState.NOT_HOMED, False)
    rig.move(10, 0, 0)
    assert rig.told("refusal") == "not_homed"
    rig.until(done=rig.home(), state=STILL, homed=True)
    assert b"G28*" in rig.written


def test_a_machine_without_switches_counts_from_where_a_person_says_that_its_zero_is() -> None:
    rig = MarlinRig("slips", homing=False)
    assert b" M17*" in rig.written and b"G28" not in rig.written
    rig.move(200, 0, 0)
    rig.wait(1.0)
    rig.until(accepted=rig.stop())
    rig.marlin.push_to_zero()
    rig.until(done=rig.home(), state=STILL, homed=True)
    rig.until(done=rig.move(10, 0, 0))
    assert rig.marlin.place == pytest.approx((10, 0, 0))


def test_homing_that_finds_no_switch_halts_it_until_it_is_reset() -> None:
    rig = MarlinRig("homing_fails", homed=False)
    rig.home()
    assert rig.told("failure") == "halted"
    rig.until(state=MotionState.FAULT)
    rig.faults.switch("homing_fails", on=False)
    rig.home()
    assert rig.told("refusal") == "halted"
    boot = rig.report.boot_id
    rig.marlin.press_reset()
    assert rig.until(state=MotionState.NOT_HOMED).boot_id != boot
    rig.wait(0.5)
    rig.until(done=rig.home(), state=STILL)


def test_a_stop_drops_the_move_and_the_place_is_not_believed() -> None:
    rig = MarlinRig()
    rig.move(200, 0, 0)
    rig.wait(1.0)
    id = rig.stop(StopMode.LATCH)
    assert rig.line.written[-1] == b"M410\n"
    there = rig.marlin.place
    stopped = rig.until(accepted=id)
    assert stopped.homed is False and mm(rig.until(state=MotionState.NOT_HOMED)) == pytest.approx(
        there, abs=0.01
    )
    rig.wait(1.0)
    assert rig.marlin.place == there and 20 < there[0] < 60
    rig.until(done=rig.home(), state=MotionState.STOP_LATCHED)
    rig.stop(StopMode.CLEAR)
    rig.until(state=STILL)


def test_a_machine_that_keeps_its_place_goes_on_after_a_stop() -> None:
    rig = MarlinRig(stop_keeps_place=True)
    rig.move(200, 0, 0)
    rig.wait(1.0)
    rig.until(accepted=rig.stop(), state=STILL, homed=True)
    rig.until(done=rig.move(0, 0, 0))


def test_homing_finds_the_steps_that_a_stop_has_lost() -> None:
    rig = MarlinRig("slips")
    rig.move(200, 0, 0)
    rig.wait(1.0)
    rig.until(accepted=rig.stop())
    assert mm(rig.report)[0] == pytest.approx(rig.marlin.place[0] - 3.0, abs=0.01)
    rig.until(done=rig.home(), state=STILL)
    rig.until(done=rig.move(10, 0, 0))
    assert rig.marlin.place == (10, 0, 0)


def test_a_stop_at_rest_keeps_the_place() -> None:
    rig = MarlinRig()
    rig.until(accepted=rig.stop(), state=STILL, homed=True)


def test_a_stop_that_comes_before_the_move_is_read_is_said_again_after_it() -> None:
    """Marlin takes M410 as it comes, and reads the line of the move after that."""
    talk = Talk()
    talk.greet()
    talk.ask(Home(id="1-1", robot=GANTRY.name))
    talk.hear("ok", AT_ZERO, "ok")
    talk.ask(MoveJoints(id="1-2", robot=GANTRY.name, q=(0.1, 0.0, 0.0)))
    talk.hear("ok", "ok")
    assert talk.ask(Stop(id="1-3", robot=GANTRY.name, mode=StopMode.HALT)) == ["M410"]
    assert talk.hear("ok") == ["M410"]
    assert talk.hear("ok", "ok") == ["M114"]
    assert talk.report.accepted == "1-1"
    talk.hear(AT_ZERO, "ok")
    assert talk.report.accepted == "1-3"


@pytest.mark.parametrize("stopped", [False, True])
def test_a_machine_that_divides_its_moves_is_shut_down(stopped: bool) -> None:
    """Marlin itself went on to the end of such a move after M410."""
    talk = Talk()
    talk.greet()
    talk.ask(Home(id="1-1", robot=GANTRY.name))
    talk.hear("echo:busy: processing", "ok", AT_ZERO, "ok")
    talk.ask(MoveJoints(id="1-2", robot=GANTRY.name, q=(0.1, 0.0, 0.0)))
    assert talk.hear("ok", "ok", "echo:busy: paused for user")[-1].startswith("G1X100")
    if stopped:
        talk.ask(Stop(id="1-3", robot=GANTRY.name, mode=StopMode.HALT))
    assert talk.hear("echo:busy: processing") == ["M112"]
    assert (talk.report.failed, talk.report.done) == (None if stopped else "1-2", "1-1")
    assert talk.report.state is MotionState.MOVING and talk.report.homed is False
    assert talk.hear("echo:busy: processing", "Error:Printer halted. kill() called!") == []
    assert talk.report.accepted == "1-1"  # it moves on for a while


def test_a_stop_after_a_boot_leaves_the_motors_on() -> None:
    """The line that has them stay on is still said."""
    talk = Talk()
    talk.greet()
    talk.hear("start")
    assert talk.hear(*HELLO) == ["M113 S1"]
    assert talk.ask(Stop(id="1-1", robot=GANTRY.name, mode=StopMode.HALT)) == ["M410"]
    assert talk.hear("ok", "ok") == ["M84 S0"]
    assert talk.hear("ok") == ["M114"]
    talk.hear(AT_ZERO, "ok")
    assert talk.report.accepted == "1-1"


def test_homing_is_stopped_by_a_shutdown() -> None:
    """M410 would end one leg of it only, and Marlin would believe where that ended."""
    rig = MarlinRig()
    rig.home()
    rig.wait(0.3)
    id = rig.stop()
    assert b"M112\n" in rig.line.written and rig.line.written[-1] != b"M410\n"
    rig.wait(1.0)
    assert (
        rig.report.accepted != id and rig.report.state is MotionState.MOVING
    )  # nor does it say that it stands
    assert rig.until(accepted=id).state is MotionState.FAULT
    assert rig.report.q is None and ("health", "halted") in (rig.report.facts or ())
    rig.until(accepted=rig.stop())  # nothing moves any more


def test_a_machine_that_is_halted_stands_some_time_after_it_said_so() -> None:
    """Marlin waits for its message to get out before it stops its motors."""
    rig = MarlinRig()
    id = rig.move(200, 0, 0)
    rig.wait(1.0)
    rig.faults.switch("killed", on=True)
    assert rig.told("failure") == "halted"
    there, at = rig.marlin.place, rig.line.now
    stop = rig.stop()
    assert rig.report.accepted != stop
    rig.until(accepted=stop, state=MotionState.FAULT, failed=id)
    stood = rig.marlin.place
    assert there[0] + 10 < stood[0] and rig.line.now - at > 1.0
    rig.wait(2.0)
    assert rig.marlin.place == stood and rig.report.q is None


def test_a_stop_that_waits_behind_its_move_is_not_confirmed_before_it() -> None:
    rig = MarlinRig("deaf")
    rig.move(200, 0, 0)
    rig.wait(1.0)
    id = rig.stop()
    rig.wait(3.5)
    assert rig.report.accepted != id and rig.report.state is MotionState.MOVING
    assert rig.written.count(b"M410") == 2
    rig.until(accepted=id)
    assert rig.marlin.place == (200, 0, 0)


def test_a_firmware_whose_stops_would_wait_is_refused() -> None:
    rig = MarlinRig("no_parser", homed=False)
    rig.wait(1.0)
    assert "its M115 does not say EMERGENCY_PARSER:1" in str(rig.report.lost)
    rig.faults.switch("no_parser", on=False)
    rig.until(state=MotionState.NOT_HOMED)


def test_a_firmware_without_signs_of_life_is_refused() -> None:
    rig = MarlinRig("no_keepalive", homed=False)
    assert "it does not know M113 S1" in str(rig.report.lost)


def test_a_switch_that_is_hit_fails_the_move_and_the_place_is_lost() -> None:
    rig = MarlinRig("endstop_hit")
    rig.move(60, 0, 0)
    assert rig.told("failure") == "endstop_hit"
    rig.faults.switch("endstop_hit", on=False)
    rig.until(state=MotionState.NOT_HOMED, homed=False)
    rig.until(done=rig.home(), state=STILL, homed=True)


@pytest.mark.parametrize(("fault", "word"), [("unknown", "unknown_command"), ("motors_off", "not_homed")])
def test_what_it_does_not_do_is_refused_by_its_word(fault: str, word: str) -> None:
    rig = MarlinRig()
    rig.faults.switch(fault, on=True)
    id = rig.move(60, 0, 0)
    assert rig.told("refusal") == word
    assert rig.report.rejected == id and rig.report.homed is (fault == "unknown")


def test_a_protection_that_stops_it_lasts_until_the_reset() -> None:
    rig = MarlinRig()
    rig.move(200, 0, 0)
    rig.wait(0.5)
    rig.faults.switch("stopped", on=True)
    assert rig.told("failure") == "stopped"
    rig.until(state=MotionState.FAULT)
    rig.faults.switch("stopped", on=False)
    rig.move(0, 0, 0)
    assert rig.told("refusal") == "stopped"
    rig.marlin.press_reset()
    rig.until(state=MotionState.NOT_HOMED)


def test_a_boot_is_noticed_and_ends_what_was_open() -> None:
    rig = MarlinRig()
    boot = rig.report.boot_id
    rig.move(200, 0, 0)
    rig.wait(0.5)
    rig.marlin.press_reset()
    back = rig.until(state=MotionState.NOT_HOMED)
    assert back.boot_id != boot and back.accepted is None
    rig.wait(5.0)
    assert rig.written.count(b"G1X") == 1


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        ("unplugged", "the line is gone"),
        ("mute", "it has said nothing for 3 s"),
        ("mistaken", "none is sent again"),
    ],
)
def test_a_line_that_is_lost_says_why_and_comes_back_stopped_and_not_homed(fault: str, said: str) -> None:
    rig = MarlinRig()
    rig.move(290, 0, 0)
    rig.wait(1.0)
    rig.faults.switch(fault, on=True)
    if fault == "mistaken":
        rig.wait(9.0)
    assert any(said in str(each.lost) for each in rig.reports) or said in str(
        rig.until(state=MotionState.NO_LINK).lost
    )
    rig.faults.switch(fault, on=False)
    rig.until(state=MotionState.NOT_HOMED)
    assert rig.written.count(b"G1X") == 1


def test_a_move_that_is_left_at_work_is_stopped_when_the_line_is_back() -> None:
    rig = MarlinRig()
    rig.move(290, 0, 0)
    rig.wait(1.0)
    rig.faults.switch("unplugged", on=True)
    rig.until(state=MotionState.NO_LINK)
    rig.faults.switch("unplugged", on=False)
    rig.until(state=MotionState.NOT_HOMED)
    assert b"M410\n" in rig.line.written and rig.report.done != "7-2"


def test_a_machine_that_is_busy_when_its_line_is_back_reads_the_greeting_at_once() -> None:
    """Marlin counts lines anew when it does M110, which is after it has read the next one."""
    rig = MarlinRig()
    rig.move(290, 0, 0)
    rig.wait(1.0)
    rig.faults.switch("unplugged", on=True)
    rig.until(state=MotionState.NO_LINK)
    before = len(rig.reports)
    rig.faults.switch("unplugged", on=False)
    rig.until(state=MotionState.NOT_HOMED)
    assert not any("none is sent again" in str(each.lost) for each in rig.reports[before:])


def test_a_line_that_was_torn_takes_no_stop_with_it() -> None:
    rig = MarlinRig()
    rig.move(290, 0, 0)
    rig.wait(1.0)
    rig.faults.switch("unplugged", on=True)
    rig.until(state=MotionState.NO_LINK)
    assert rig.marlin.step(rig.line.now, b"M4") == b""
    rig.faults.switch("unplugged", on=False)
    rig.until(state=MotionState.NOT_HOMED)
    there = rig.marlin.place
    rig.wait(1.0)
    assert rig.marlin.place == there


def test_a_move_without_an_answer_ends_the_line() -> None:
    rig = MarlinRig()
    rig.faults.switch("no_ok", on=True)
    rig.move(20, 0, 0)
    assert "it has" in str(rig.until(state=MotionState.NO_LINK).lost)


def test_answers_of_an_earlier_connection_count_for_nothing() -> None:
    talk = Talk()
    assert talk.hear("ok", "ok", "ok") == []
    assert talk.hear("FIRMWARE_NAME:Marlin 2.1.2", "Cap:EMERGENCY_PARSER:1") == []
    assert talk.hear("ok") == ["M113 S1"]


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (["FIRMWARE_NAME:Repetier_0.92"], "it is no Marlin, it says Repetier_0.92"),
        (["FIRMWARE_NAME:Marlin 2.1.2", "ok"], "does not say EMERGENCY_PARSER:1"),
        ([*HELLO, "FIRMWARE_NAME:Marlin 2.1.2"], "without being asked"),
        ([*HELLO, "ok", "ok", "ok"], "its answer to M114 has no position"),
        ([*HELLO, "ok", "ok", "X:0.00 E:0.00 Count X:0", "ok"], "its answer to M114 has no position"),
        ([*HELLO, "Error:Line Number is not Last Line Number+1, Last Line: 0"], "none is sent again"),
    ],
)
def test_a_controller_that_answers_otherwise_loses_the_line(lines: list[str], said: str) -> None:
    talk = Talk()
    talk.hear(*lines)
    assert said in str(talk.report.lost)


def test_a_board_that_boots_when_its_line_is_opened_is_greeted_again() -> None:
    talk = Talk()
    assert talk.hear("start", "echo:Marlin 2.1.2") == ["", "M110 N0", "M115"]
    talk.hear(*HELLO, "ok", "ok", AT_ZERO, "ok")
    assert (talk.report.state, talk.report.boot_id) == (MotionState.NOT_HOMED, 1)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("ok", Ok()),
        ("ok N12 P15 B3", Ok()),
        ("X:0.00 Y:127.00 Z:145.00 E:0.00 Count X: 0 Y:10160 Z:116000", Place(position=(0.0, 127.0, 145.0))),
        ("X:350.0000 Y:-1.5000 Z:20.0000 Count A:28000B:12000 Z:4000", Place(position=(350.0, -1.5, 20.0))),
        ("echo:busy: processing", Busy(word="processing")),
        ("busy: paused for user", Busy(word="paused for user")),
        ("start", Start()),
        ("Resend: 12", Resend()),
        ("Error:checksum mismatch, Last Line: 11", Resend()),
        ("FIRMWARE_NAME:Marlin 2.1.2 (Aug  1 2024)", Firmware(name="Marlin 2.1.2 (Aug  1 2024)")),
        ("Cap:EMERGENCY_PARSER:1", Capability(name="EMERGENCY_PARSER", on=True)),
        ('echo:Unknown command: "M113 S1"', Refusal(word="unknown_command")),
        ("echo:Home XY First", Refusal(word="not_homed")),
        ("echo:endstops hit:  X:12.00", Trouble(word="endstop_hit")),
        ("Error:Printer halted. kill() called!", Trouble(word="halted")),
        ("Printer stopped due to errors. Fix the error and use M999 to restart.", Trouble(word="stopped")),
        ("Error:Probing failed", Trouble(word="error")),
        ("X:0.00 Y:127.00 Z:145.00 E:0.00", None),  # torn
        ("X:nan Y:0.00 Z:0.00 E:0.00 Count X:0 Y:0 Z:0", None),
        ("X:999999.00 Y:0.00 Z:0.00 E:0.00 Count X:0 Y:0 Z:0", None),
        ("okay", None),
        ("echo:SD card ok", None),
        ("", None),
    ],
)
def test_lines(text: str, line: object) -> None:
    assert parsed(text) == line


def test_a_line_has_its_number_and_its_checksum() -> None:
    """The example of a host that all of them send first."""
    assert numbered(0, "M110 N0") == "N0 M110 N0*125"


def test_grbl_keeps_its_place_by_itself() -> None:
    with pytest.raises(DriverError, match="stop_keeps_place is for dialect: marlin"):
        Settings(serial="/dev/ttyUSB0", stop_keeps_place=True)
