"""The driver of a machine with GRBL, against a virtual one, under a clock moved by hand."""

from __future__ import annotations

import pytest

from arboleda.drivers.port import DriverError
from arboleda.model.commands import StopMode
from arboleda.model.messages import MotionState, Report
from arboleda_drivers.gcode.grbl_lines import Alarm, Answer, Banner, Demand, LockSign, State, Status, parsed
from arboleda_drivers.gcode.lines import LineReader
from arboleda_drivers.gcode.settings import Settings

from .gcode_rig import GrblRig

STILL = MotionState.STOPPED


def mm(report: Report) -> tuple[float, ...]:
    assert report.q is not None
    return tuple(round(each * 1000, 2) for each in report.q)


def test_ok_is_no_end_and_the_position_is() -> None:
    rig = GrblRig()
    id = rig.move(-60, 0, 0)
    accepted = rig.until(accepted=id)
    assert accepted.state is MotionState.MOVING and accepted.done is None
    done = rig.until(done=id)
    assert (done.state, mm(done)) == (STILL, (-60, 0, 0))
    assert b"G90G21G53G1X-60.000Y0.000Z0.000F1800.0\n" in rig.written


@pytest.mark.parametrize("fault", ["late_start", "lie", "short"])
def test_a_machine_that_idles_is_believed_after_a_while_and_at_its_place(fault: str) -> None:
    rig = GrblRig(fault)
    id = rig.move(-60, 0, 0)
    done = rig.until(done=id)
    expected = {"late_start": (-60, 0, 0), "lie": (0, 0, 0), "short": (-58, 0, 0)}[fault]
    assert mm(done) == expected  # where it is not at its goal, the plant finds that


def test_a_locked_machine_is_homed() -> None:
    rig = GrblRig(homed=False)
    assert (rig.report.state, rig.report.homed) == (MotionState.NOT_HOMED, False)
    rig.move(-10, 0, 0)
    assert rig.told("refusal") == "locked"
    id = rig.home()
    rig.until(done=id, state=STILL, homed=True)
    assert rig.written.endswith(b"$H\n")


def test_a_homing_under_way_says_nothing_and_is_waited_for() -> None:
    """GRBL answers no query before its homing has ended."""
    rig = GrblRig(homed=False)
    id = rig.home()
    rig.until(done=id, homed=True)
    assert all(each.lost is None for each in rig.reports)


def test_a_machine_without_switches_is_unlocked() -> None:
    rig = GrblRig(homed=False, homing=False)
    rig.until(done=rig.home(), state=STILL)
    assert rig.written.endswith(b"$X\n")


def test_a_machine_without_switches_that_counts_elsewhere_is_not_at_its_zero() -> None:
    rig = GrblRig(homing=False)
    rig.until(done=rig.home(), homed=True)
    rig.faults.switch("hard_limit", on=True)
    rig.move(-60, 0, 0)
    assert rig.told("failure") == "hard_limit"
    rig.faults.switch("hard_limit", on=False)
    rig.home()
    rig.wait(1.0)
    assert (rig.told("failure"), rig.report.homed) == ("not_at_zero", False)
    rig.grbl.begin_at_zero()
    rig.wait(1.0)
    rig.until(done=rig.home(), state=STILL, homed=True)


def test_a_machine_without_switches_that_somebody_else_unlocks_is_not_homed() -> None:
    rig = GrblRig(homed=False, homing=False)
    rig.grbl.step(rig.line.now, b"$X\n")
    rig.wait(2.0)
    assert (rig.report.state, rig.report.homed) == (MotionState.NOT_HOMED, False)


def test_a_late_answer_about_its_lock_is_none_to_a_move() -> None:
    rig = GrblRig("no_ok")
    id = rig.move(-60, 0, 0)
    rig.says("[OPT:V,15,128]")
    rig.says("ok")
    assert rig.report.accepted != id
    rig.says("ok")
    assert rig.report.accepted == id


def test_homing_of_a_ready_machine_shows_that_it_was_not() -> None:
    """The plant believes a homing that it has seen."""
    rig = GrblRig(homing=False)
    before = len(rig.reports)
    rig.until(done=rig.home(), homed=True)
    assert rig.reports[before].homed is False


def test_homing_that_finds_no_switch_fails_by_its_alarm() -> None:
    rig = GrblRig("homing_fails", homed=False)
    boot = rig.report.boot_id
    rig.home()
    assert rig.told("failure") == "homing_no_switch"
    rig.wait(1.0)
    assert (rig.report.state, rig.report.boot_id) == (MotionState.FAULT, boot)  # its banner is no boot


def test_a_stop_holds_the_feed_and_empties_the_queue() -> None:
    rig = GrblRig()
    rig.move(-200, 0, 0)
    rig.wait(1.0)
    id = rig.stop(StopMode.LATCH)
    assert rig.line.written[-1] == b"!"
    rig.until(accepted=id)
    held = rig.until(state=MotionState.STOP_LATCHED)
    assert -60 < mm(held)[0] < -20 and held.homed
    assert rig.written.endswith(b"!\x18")
    rig.wait(1.0)
    assert mm(rig.report) == mm(held)
    rig.stop(StopMode.CLEAR)
    rig.until(state=STILL)
    rig.until(done=rig.move(0, 0, 0))


def test_a_stop_at_rest_and_while_homing() -> None:
    rig = GrblRig()
    rig.until(accepted=rig.stop(), state=STILL)
    boot = rig.report.boot_id
    rig.home()
    rig.wait(0.3)
    id = rig.stop()
    assert rig.line.written[-1] == b"\x18"  # homing hears no feed hold
    rig.until(accepted=id)
    rig.until(homed=False, boot_id=boot)


@pytest.mark.parametrize("fault", ["deaf", "no_reset"])
def test_a_stop_that_is_not_taken_is_not_confirmed(fault: str) -> None:
    rig = GrblRig(fault)
    rig.move(-200, 0, 0)
    rig.wait(1.0)
    id = rig.stop()
    rig.wait(1.5)
    assert rig.report.accepted != id and rig.report.state is MotionState.MOVING


@pytest.mark.parametrize("alarm", ["hard_limit", "soft_limit"])
def test_an_alarm_after_which_it_hears_only_a_reset_fails_a_move_and_home_leads_out(alarm: str) -> None:
    rig = GrblRig(alarm)
    boot = rig.report.boot_id
    rig.move(-60, 0, 0)
    assert rig.told("failure") == alarm
    rig.wait(2.0)
    assert (rig.report.state, rig.report.homed, rig.report.boot_id) == (MotionState.FAULT, False, boot)
    assert ("health", alarm) in (rig.report.facts or ())
    rig.faults.switch(alarm, on=False)
    rig.until(done=rig.home(), state=STILL, homed=True)
    assert all(each.lost is None for each in rig.reports)


def test_one_that_waits_for_a_reset_when_the_line_is_opened_is_led_out() -> None:
    rig = GrblRig("hard_limit", "no_reset")
    rig.move(-60, 0, 0)
    rig.until(state=MotionState.NO_LINK)
    rig.faults.switch("no_reset", on=False)
    rig.faults.switch("hard_limit", on=False)
    rig.until(state=MotionState.NOT_HOMED)
    rig.until(done=rig.home(), state=STILL, homed=True)


def test_an_open_door_is_a_fact_and_nothing_goes_on_when_it_is_closed() -> None:
    rig = GrblRig()
    rig.move(-200, 0, 0)
    rig.wait(1.0)
    rig.faults.switch("door", on=True)
    assert rig.told("failure") == "door"
    rig.until(facts=(("health", "door"), ("door", "open"), ("mode", "door")))
    there = rig.grbl.place
    rig.faults.switch("door", on=False)
    rig.until(state=STILL)
    rig.wait(2.0)
    assert rig.grbl.place == pytest.approx(there, abs=5)
    assert ("door", "closed") in (rig.report.facts or ())


def test_a_feed_hold_that_somebody_presses_ends_the_move() -> None:
    rig = GrblRig("hold_pressed")
    rig.move(-60, 0, 0)
    assert rig.told("failure") == "hold"
    rig.until(state=STILL)


def test_a_boot_is_noticed_and_a_reset_of_ours_is_none() -> None:
    rig = GrblRig()
    boot = rig.report.boot_id
    rig.until(accepted=rig.stop(), state=STILL, boot_id=boot)
    rig.move(-200, 0, 0)
    rig.wait(0.5)
    rig.faults.switch("boot", on=True)
    rig.wait(0.3)
    rig.faults.switch("boot", on=False)
    back = rig.until(state=MotionState.NOT_HOMED)
    assert back.boot_id != boot and back.accepted is None


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        ("unplugged", "the line is gone"),
        ("mute", "it has told no status for 1 s"),
        ("no_position", "set $10=1"),
    ],
)
def test_a_line_that_is_lost_says_why_and_comes_back_held(fault: str, said: str) -> None:
    rig = GrblRig()
    rig.move(-200, 0, 0)
    rig.wait(1.0)
    rig.faults.switch(fault, on=True)
    assert said in str(rig.until(state=MotionState.NO_LINK).lost)
    rig.faults.switch(fault, on=False)
    rig.until(state=STILL)
    assert rig.grbl.place[0] > -200 and rig.report.done is None


def test_a_move_without_an_answer_ends_the_line() -> None:
    rig = GrblRig("no_ok")
    rig.move(-20, 0, 0)
    assert "it has not answered a move for 3 s" in str(rig.until(state=MotionState.NO_LINK).lost)


def test_what_grbl_refuses_is_refused_by_its_word() -> None:
    rig = GrblRig("error")
    rig.move(-20, 0, 0)
    assert rig.told("refusal") == "beyond_travel"


def test_the_zero_of_an_axis_may_be_anywhere() -> None:
    rig = GrblRig(zeros_mm=(-100.0, 0.0, 0.0))
    assert mm(rig.report) == (100, 0, 0)
    rig.until(done=rig.move(-20, 0, 0))
    assert rig.grbl.place == (-120, 0, 0)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("ok", Answer()),
        ("error:20", Answer(error=20)),
        ("ALARM:1", Alarm(code=1)),
        ("Grbl 1.1h ['$' for help]", Banner()),
        ("GrblHAL 1.1f ['$' or '$HELP' for help]", Banner(firmware="GrblHAL")),
        ("Grbl 3.9 [FluidNC v3.9.1 (esp32-wifi) '$' for help]", Banner(firmware="FluidNC")),
        ("[MSG:Reset to continue]", Demand()),
        ("[MSG:ERR: Reset to continue]", Demand()),
        ("$22=1", LockSign(name="$22", locks=True)),
        ("$22=2", LockSign(name="$22", locks=False)),
        ("[OPT:V,15,128]", LockSign(name="OPT", locks=True)),
        ("[OPT:VL,15,128]", LockSign(name="OPT", locks=False)),
        ("[VER:1.1h.20190830:L]", LockSign(name="VER", locks=True)),
        ("[VER:3.9 FluidNC v3.9.1 (esp32-wifi) :]", LockSign(name="VER", locks=False)),
        ("<Tool|MPos:0.000|Bf:100,1023>", Status(state=State.TOOL, position=(0.0,))),
        ("<Alarm:11|MPos:0.000|H:0,0>", Status(state=State.ALARM, part=11, position=(0.0,), homed=False)),
        ("<Idle|MPos:0.000|H:1>", Status(state=State.IDLE, position=(0.0,), homed=True)),
        ("<Idle|MPos:0.000,-1.500,3.000|FS:0,0>", Status(state=State.IDLE, position=(0.0, -1.5, 3.0))),
        ("<Door:1|MPos:0.000,0.000|Pn:DX>", Status(state=State.DOOR, part=1, position=(0.0, 0.0), door=True)),
        ("<Run|WPos:0.000,0.000>", Status(state=State.RUN)),
        ("<Idle|MPos:0.000,nan|FS:0,0>", None),
        ("<Idle|MPos:0.0000000,1.0>", None),
        ("<Sleepy|MPos:0.000>", None),
        ("<Idle|MPos:0.000,0.000", None),
        ("error:0", None),
        ("[MSG:'$H'|'$X' to unlock]", None),
        ("okay", None),
        ("", None),
    ],
)
def test_lines(text: str, line: object) -> None:
    assert parsed(text) == line


def test_lines_come_in_pieces_and_never_grow_without_end() -> None:
    reader = LineReader(parsed)
    assert [each for byte in b"ok\r\nerror:9\r\nok" for each in reader.feed(bytes([byte]))] == [
        Answer(),
        Answer(error=9),
    ]
    reader.feed(b"x" * 10_000)
    assert reader.feed(b"\nok\n") == [Answer()]


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"axes": ()}, "a letter for each axis"),
        ({"axes": ("X", "X")}, "each once"),
        ({"zeros_mm": (1.0,)}, "zeros_mm has 1 numbers for 3 axes"),
        ({"speed_percent": 101}, "speed_percent is 101; allowed: 1 to 100"),
        ({"poll_s": 0.01}, "poll_s is 0.01"),
        ({"serial": ""}, "needs either serial"),
    ],
)
def test_settings_that_cannot_be(keys: dict[str, object], said: str) -> None:
    with pytest.raises(DriverError, match=said):
        Settings(**{"serial": "/dev/ttyUSB0", **keys})  # type: ignore[arg-type]
