"""Homing of a machine with GRBL, where a boot or a new line has it count from anywhere."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.model.messages import MotionState

from .gcode_rig import GrblRig, gantry

STILL, UNHOMED = MotionState.STOPPED, MotionState.NOT_HOMED
LIMP = {"homing": False, "locks": False}  # no switches: it does not lock itself
HAL = "GrblHAL 1.1f ['$' or '$HELP' for help]"
FLUID = "Grbl 3.9 [FluidNC v3.9.1 (esp32-wifi) '$' for help]"


def at_minus_47(**changes: bool) -> GrblRig:
    """A machine that was homed, and went 47 mm from there."""
    rig = GrblRig(**changes)  # type: ignore[arg-type]
    if not rig.report.homed:
        rig.until(done=rig.home(), homed=True)
    rig.until(done=rig.move(-47, 0, 0))
    return rig


@pytest.mark.parametrize("homing", [True, False])
def test_a_machine_that_does_not_lock_itself_is_not_homed_after_a_boot(homing: bool) -> None:
    rig = at_minus_47(homing=homing)
    rig.grbl.step(rig.line.now, b"$22=0\n")
    boot = rig.report.boot_id
    after = rig.again("boot")
    assert (after.state, after.homed, after.q) == (UNHOMED, False, (0.0, 0.0, 0.0))
    assert after.boot_id != boot and rig.grbl.place == (-47.0, 0.0, 0.0)
    rig.move(-60, 0, 0)
    assert rig.told("refusal") == "not_homed"


def test_a_person_says_that_it_is_homed_and_it_moves_again() -> None:
    rig = at_minus_47(**LIMP)
    rig.again("boot")
    rig.until(done=rig.home(), state=STILL, homed=True)
    rig.until(done=rig.move(-10, 0, 0))


@pytest.mark.parametrize("fault", ["unplugged", "boot"])
def test_a_machine_that_does_not_lock_itself_is_not_homed_on_a_new_line(fault: str) -> None:
    """It may have booted meanwhile, unheard."""
    rig = at_minus_47(**LIMP)
    rig.faults.switch("unplugged", on=True)
    rig.until(state=MotionState.NO_LINK)
    rig.again(fault)
    rig.faults.switch("unplugged", on=False)
    rig.until(state=UNHOMED, homed=False)


def test_one_that_locks_itself_is_homed_on_a_new_line_until_it_boots() -> None:
    rig = at_minus_47()
    assert rig.again("unplugged").state is STILL and rig.report.homed
    rig.faults.switch("unplugged", on=True)
    rig.until(state=MotionState.NO_LINK)
    rig.again("boot")
    rig.faults.switch("unplugged", on=False)
    rig.until(state=UNHOMED, homed=False)


@pytest.mark.parametrize("answer", ["[OPT:VL,15,128]", "[VER:3.9 FluidNC v3.9.1 (esp32-wifi) :]"])
def test_one_that_may_not_lock_itself_is_not_homed_on_a_new_line(
    answer: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    build = {"VER": "[VER:1.1h.20190830:]", "OPT": "[OPT:V,15,128]"} | {answer[1:4]: answer}
    monkeypatch.setattr("arboleda_drivers.gcode.virtual.grbl.BUILD", (*build.values(), "ok"))
    assert GrblRig().report.state is UNHOMED


def test_one_that_does_not_answer_is_not_homed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arboleda_drivers.gcode.virtual.grbl.BUILD", ())
    rig = GrblRig()
    rig.until(state=UNHOMED, homed=False)
    rig.until(done=rig.home(), homed=True)
    rig.until(done=rig.move(-10, 0, 0))


def test_a_place_that_it_cannot_have_reached_is_said() -> None:
    rig = GrblRig()
    rig.grbl.place = (-47.0, 0.0, 0.0)
    rig.until(state=UNHOMED, homed=False)
    assert ("health", "place_jumped") in (rig.report.facts or ())
    rig.until(done=rig.home(), state=STILL)
    assert ("health", "ok") in (rig.report.facts or ())


def test_a_leap_under_way_ends_the_move() -> None:
    rig = GrblRig()
    rig.until(done=rig.move(-250, 0, 0))
    rig.move(-100, 0, 0)
    rig.wait(0.5)
    rig.grbl._zero = (-235.0, 0.0, 0.0)
    assert rig.told("failure") == "place_jumped"
    rig.until(state=UNHOMED)


def test_somebody_else_may_home_it() -> None:
    rig = GrblRig(homed=False)
    assert rig.report.homed is False
    rig.grbl.step(rig.line.now, b"$H\n")
    rig.until(homed=True, state=STILL)


@pytest.mark.parametrize("banner", [HAL, FLUID])
def test_a_reset_and_a_boot_are_told_apart_by_whatever_greeting(banner: str) -> None:
    rig = GrblRig(banner=banner)
    boot = rig.report.boot_id
    rig.until(accepted=rig.stop(), state=STILL, boot_id=boot)
    assert rig.written.count(b"\x18") == 1
    assert rig.again("boot").boot_id != boot and rig.report.state is UNHOMED


@pytest.mark.parametrize(("banner", "alarm"), [(HAL, "ALARM:11"), (FLUID, "ALARM:14")])
def test_an_alarm_that_asks_for_homing_is_no_fault(banner: str, alarm: str) -> None:
    rig = GrblRig(banner=banner)
    rig.again("boot")
    rig.says(alarm)
    rig.wait(0.5)
    assert rig.report.state is UNHOMED and ("health", "locked") in (rig.report.facts or ())


def test_a_tool_change_keeps_it_from_moving() -> None:
    rig = GrblRig()
    rig.says("<Tool|MPos:0.000,0.000,0.000|Bf:100,1023|FS:0,0>")
    assert rig.report.state is MotionState.FAULT
    assert rig.report.facts == (("health", "tool_change"), ("door", "closed"), ("mode", "tool"))


def test_what_grblhal_says_of_its_reference_counts() -> None:
    rig = GrblRig(locks=False)
    assert rig.report.homed is False
    rig = GrblRig()
    rig.says("<Idle|MPos:0.000,0.000,0.000|H:0>")
    assert (rig.report.state, rig.report.homed) == (UNHOMED, False)


@pytest.mark.parametrize("file", ["bench.yaml", "marlin.yaml"])
def test_no_plant_can_say_by_itself_where_a_machine_without_switches_stands(file: str) -> None:
    robot, settings = gantry(file)
    limp = replace(settings, homing=False)
    (problem,) = limp.problems(replace(robot, home_at_start=True))
    assert problem[0] == ("homing",) and "home_at_start" in problem[1]


def test_nobody_hears_that_it_is_not_homed_before_it_was_asked() -> None:
    """A cell that is held while a line is lost goes on without homing, if the machine locks itself."""
    rig = GrblRig()
    rig.move(-200, 0, 0)
    rig.wait(1.0)
    rig.faults.switch("unplugged", on=True)
    rig.until(state=MotionState.NO_LINK)
    rig.faults.switch("unplugged", on=False)
    before = len(rig.reports)
    rig.until(state=STILL, homed=True)
    assert not [each for each in rig.reports[before:] if each.homed is False]


def test_a_move_that_stood_still_for_a_while_goes_on_from_there_and_is_no_leap() -> None:
    rig = GrblRig()
    rig.faults.switch("stall", on=True)
    id = rig.move(-250, 0, 0)
    rig.wait(8.0)
    assert abs(rig.grbl.place[0] + 125) < 5, "it stands half way"
    rig.faults.switch("stall", on=False)
    rig.until(done=id)
