"""What the plant hears of devices behind drivers, whatever the drivers do; time is moved by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from arboleda.drivers import Device, lost
from arboleda.drivers.supervisor import (
    FIRST_RETRY_S,
    PLANT_GONE_S,
    Begin,
    CommandRequest,
    DeviceHalt,
    DriverCrash,
    DriverOutput,
    End,
    Event,
    Give,
    Leaving,
    Life,
    Message,
    OutputRefused,
    PlantBeat,
    SendResult,
    Supervisor,
)
from arboleda.model.commands import Command, OnStop, Stop, StopMode
from arboleda.model.messages import MotionState, Report, Undelivered
from arboleda.model.plant_model import Evidence, Link
from arboleda.model.sentence import OWN
from arboleda.sim.board import SILENCE, SILENCE_US
from arboleda.testing.plants import shipped
from arboleda.testing.storage_layout import StorageLayout

from ..kinds.station import STATION, plant

STALE_S, EPOCH = 1.5, 9
GO = STATION.command(id="9-1", robot="station", verb="go", values={})
LIGHT = STATION.command(id="9-2", robot="station", verb="light", values={"on": True})
WARM = STATION.command(id="9-5", robot="station", verb="warm", values={"celsius": 60.0})
LATCH, CLEAR = (
    Stop(id=f"9-{n}", robot="station", mode=mode) for n, mode in ((3, StopMode.LATCH), (4, StopMode.CLEAR))
)


class Driven:
    """A supervisor with one driver of one station, and all that came out of it."""

    def __init__(self, evidence: Evidence = Evidence.IDS) -> None:
        (station,) = plant(evidence=evidence).robots.values()
        self.machine = Supervisor([("plc", [station])], epoch=EPOCH, stale_after_s=STALE_S)
        self.life = Life(driver=0, number=1)
        self.now = 10.0

    def step(self, *events: Event, after: float = 0.0) -> list[Message]:
        self.now += after
        return self.machine.step(self.now, events)

    def says(self, *, after: float = 0.0, late: float = 0.0, **said: object) -> list[Message]:
        """The station reports something, stopped where nothing else is said."""
        at = self.now + after
        report = Report(at=at - late, robot="station", **{"state": MotionState.STOPPED, **said})  # type: ignore[arg-type]
        return self.step(DriverOutput(at=at, life=self.life, report=report), after=after)

    def beats(self, *, after: float = 0.0) -> list[Message]:
        """The plant is there."""
        return self.step(PlantBeat(at=self.now + after), after=after)

    def asks(self, command: Command) -> list[Message]:
        return self.step(CommandRequest(at=self.now, command=command))

    def given(self, command: Command) -> Give:
        """What the driver gets of a command of now, where it waits behind no other."""
        until = math.inf if isinstance(command, Stop) else self.now + STALE_S
        return Give(life=self.life, command=command, until=until)

    def gives(self, command: Command) -> None:
        """The plant commands it, and the driver sends that."""
        assert self.asks(command) == [self.given(command)]
        assert self.step(SendResult(at=self.now, life=self.life, command=command)) == []


@pytest.fixture
def driven() -> Driven:
    """A driver that was started, and whose station is heard."""
    made = Driven()
    made.step()
    made.says()
    return made


def reports(messages: list[Message]) -> list[Report]:
    return [each for each in messages if isinstance(each, Report)]


def test_a_driver_begins_at_once_and_its_devices_are_unheard_until_they_speak() -> None:
    driven = Driven()
    unheard, begin = driven.step()
    assert begin == Begin(life=driven.life)
    assert isinstance(unheard, Report) and unheard.state is MotionState.NO_LINK
    assert str(unheard.lost) == "its driver plc was started and has said nothing yet"
    (refused,) = driven.asks(GO)
    assert isinstance(refused, Report)
    assert (refused.rejected, refused.refusal, refused.lost) == ("9-1", "no_link", unheard.lost)


def test_a_report_is_that_of_this_start_of_the_plant(driven: Driven) -> None:
    (heard,) = driven.says(epoch=3, plant=3, foreign_obeyed=7)
    assert isinstance(heard, Report)
    assert (heard.epoch, heard.plant, heard.foreign_obeyed) == (EPOCH, EPOCH, None)


def test_a_command_leaves_once(driven: Driven) -> None:
    driven.gives(GO)
    assert driven.asks(GO) == []


def test_ids_that_it_was_not_given_are_not_told(driven: Driven) -> None:
    driven.gives(GO)
    (heard,) = driven.says(accepted="9-1", done="8-77", failed="8-78", failure="atasco")
    assert isinstance(heard, Report)
    assert (heard.accepted, heard.done, heard.failed, heard.failure) == ("9-1", None, None, None)


def test_silence_loses_the_link_and_what_comes_after_brings_it_back(driven: Driven) -> None:
    assert driven.machine.next_deadline == pytest.approx(driven.now + STALE_S)
    (gone,) = driven.step(after=STALE_S)
    assert isinstance(gone, Report) and gone.state is MotionState.NO_LINK
    assert str(gone.lost) == "its driver plc has said nothing for 1.5 s"
    assert driven.machine.next_deadline is None
    (back,) = driven.says(after=5.0)
    assert isinstance(back, Report) and back.state is MotionState.STOPPED
    assert driven.asks(GO) == [driven.given(GO)]


def test_silence_means_nothing_at_state() -> None:
    driven = Driven(Evidence.STATE)
    driven.step()
    driven.says()
    assert driven.machine.next_deadline is None


def test_a_driver_that_knows_says_why_there_is_no_link(driven: Driven) -> None:
    report = lost("station", at=driven.now, why="the cable is out")
    (gone,) = driven.step(DriverOutput(at=driven.now, life=driven.life, report=report))
    assert isinstance(gone, Report)
    assert (gone.state, str(gone.lost)) == (MotionState.NO_LINK, "the cable is out")
    assert driven.step(DriverOutput(at=driven.now, life=driven.life, report=report)) == []  # that is no news


def test_another_reason_for_a_link_that_is_still_lost_is_told_once(driven: Driven) -> None:
    told: list[str] = []
    for why in ("nobody is there", "nobody is there", "it refuses us", "it refuses us"):
        said = DriverOutput(at=driven.now, life=driven.life, report=lost("station", at=driven.now, why=why))
        told += [str(report.lost) for report in reports(driven.step(said))]
    assert told == ["nobody is there", "it refuses us"]


def test_what_could_not_leave_is_told_and_the_link_stays(driven: Driven) -> None:
    driven.asks(GO)
    (undelivered,) = driven.step(
        SendResult(at=driven.now, life=driven.life, command=GO, error=OWN(text="cut"))
    )
    assert isinstance(undelivered, Undelivered) and (undelivered.id, undelivered.robot) == ("9-1", "station")
    assert str(undelivered.sentence) == "its driver plc could not send a command (cut)"
    assert driven.asks(LIGHT) == [driven.given(LIGHT)]


def test_after_a_defect_in_send_the_link_is_lost_and_nobody_says_that_nothing_left(driven: Driven) -> None:
    driven.asks(GO)
    broken = SendResult(
        at=driven.now, life=driven.life, command=GO, error=OWN(text="KeyError: 'go'"), broken=True
    )
    (gone,) = driven.step(broken)
    assert isinstance(gone, Report) and gone.state is MotionState.NO_LINK
    why = "its driver plc broke down while it sent a command, which may have left (KeyError: 'go')"
    assert str(gone.lost) == why
    driven.says()
    assert driven.asks(LIGHT) == [driven.given(LIGHT)]


def test_a_driver_that_does_not_come_back_from_send_has_lost_its_devices(driven: Driven) -> None:
    driven.asks(GO)
    driven.says(after=1.0)
    gone, halt = driven.step(after=0.5)
    assert isinstance(gone, Report) and isinstance(halt, Give)
    assert str(gone.lost) == "its driver plc has not come back from send for 1.5 s"
    assert driven.says() == []  # its own thread still reads, but commands would not leave
    for command in (GO, halt.command):
        driven.step(SendResult(at=driven.now, life=driven.life, command=command))
    assert len(reports(driven.says())) == 1


def test_an_order_that_has_not_left_as_the_link_is_lost_is_called_back_by_a_stop(driven: Driven) -> None:
    driven.asks(GO)
    told, halt = driven.step(
        DriverOutput(at=driven.now, life=driven.life, report=lost("station", at=driven.now, why="no answer"))
    )
    assert isinstance(told, Report) and str(told.lost) == "no answer"
    assert halt == driven.given(Stop(id="", robot="station", mode=StopMode.HALT))
    driven.step(SendResult(at=driven.now, life=driven.life, command=GO))
    driven.says()
    (told_again,) = driven.says(state=MotionState.NO_LINK)
    assert isinstance(told_again, Report)  # nothing is on its way any more


def test_a_driver_that_broke_down_is_ended_and_started_again_later_and_later(driven: Driven) -> None:
    waits = []
    for _ in range(3):
        gone, end = driven.step(DriverCrash(at=driven.now, life=driven.life, error="ValueError: no"))
        assert isinstance(gone, Report) and end == End(life=driven.life)
        assert str(gone.lost) == "its driver plc broke down (ValueError: no), and is started again"
        due = driven.machine.next_deadline
        assert due is not None
        waits.append(due - driven.now)
        (begin,) = driven.step(after=waits[-1])
        assert isinstance(begin, Begin)
        driven.life = begin.life
    assert waits == pytest.approx([FIRST_RETRY_S, 2 * FIRST_RETRY_S, 4 * FIRST_RETRY_S])


def test_an_earlier_life_of_a_driver_counts_no_more(driven: Driven) -> None:
    driven.step(DriverCrash(at=driven.now, life=driven.life, error="ValueError: no", started=False))
    assert driven.says() == []
    (begin,) = driven.step(after=FIRST_RETRY_S)
    assert driven.says() == []
    assert isinstance(begin, Begin)
    driven.life = begin.life
    assert len(reports(driven.says())) == 1


def test_a_latch_is_told_again_to_who_comes_back_or_boots(driven: Driven) -> None:
    driven.says(boot_id=1)
    driven.gives(LATCH)
    assert len(driven.says(boot_id=1)) == 1
    again = Stop(id="", robot="station", mode=StopMode.LATCH)
    _, give = driven.says(boot_id=2)
    assert give == driven.given(again)
    driven.step(SendResult(at=driven.now, life=driven.life, command=again))
    (refused,) = driven.asks(GO)
    assert isinstance(refused, Report) and refused.refusal == "paro"
    driven.gives(CLEAR)
    driven.step(after=STALE_S)
    assert len(driven.says()) == 1


def test_a_clear_reaches_a_driver_whose_device_is_not_heard_and_is_refused_all_the_same() -> None:
    driven = Driven()
    driven.step()
    refused, give = driven.asks(CLEAR)
    assert isinstance(refused, Report) and refused.refusal == "no_link"
    told = replace(CLEAR, id="")
    assert give == driven.given(told), "its driver may wait for the word of a person"
    unsent = SendResult(at=driven.now, life=driven.life, command=told, error=OWN(text="not connected"))
    assert driven.step(unsent) == []


class DrivenArm:
    """A supervisor with one driver of an arm, which says in what state it is."""

    def __init__(self) -> None:
        self.machine = Supervisor([("ur", [ARM])], epoch=EPOCH, stale_after_s=STALE_S)
        self.now, self.life = 10.0, Life(driver=0, number=1)
        self.machine.step(self.now, [])

    def says(self, state: MotionState | None, **said: object) -> list[Command]:
        """The arm says this; returns what the driver is given for it."""
        report = Report(at=self.now, robot=ARM.name, state=state, **said)  # type: ignore[arg-type]
        out = self.machine.step(self.now, [DriverOutput(at=self.now, life=self.life, report=report)])
        return [each.command for each in out if isinstance(each, Give)]

    def breaks_down(self) -> None:
        self.machine.step(self.now, [DriverCrash(at=self.now, life=self.life, error="ValueError: no")])
        self.now += FIRST_RETRY_S
        (begin,) = self.machine.step(self.now, [])
        assert isinstance(begin, Begin)
        self.life = begin.life


ARM = replace(StorageLayout(shipped("sis_c").cells[0]).arm, link=Link.DRIVER, evidence=Evidence.IDS)
ARM_HALT = Stop(id="", robot=ARM.name, mode=StopMode.HALT)


def test_an_arm_that_moves_as_it_is_heard_first_is_halted_once() -> None:
    arm = DrivenArm()
    assert arm.says(None) == [], "nobody knows yet"
    assert arm.says(MotionState.MOVING) == [ARM_HALT]
    assert arm.says(MotionState.MOVING) == []


def test_an_arm_that_somebody_else_moves_later_is_left_alone() -> None:
    arm = DrivenArm()
    assert arm.says(MotionState.STOPPED) == arm.says(MotionState.MOVING) == []


def test_an_arm_that_moves_as_its_link_comes_back_is_halted() -> None:
    arm = DrivenArm()
    arm.says(MotionState.STOPPED)
    arm.says(MotionState.NO_LINK, lost=OWN(text="the cable is out"))
    assert arm.says(MotionState.MOVING) == [ARM_HALT]


def test_an_arm_that_moves_as_its_driver_was_made_anew_is_halted() -> None:
    arm = DrivenArm()
    arm.says(MotionState.STOPPED)
    arm.breaks_down()
    assert arm.says(MotionState.MOVING) == [ARM_HALT]


def test_a_device_may_be_at_work_that_ends_by_itself() -> None:
    driven = Driven()
    driven.step()
    assert len(driven.says(state=MotionState.MOVING)) == 1


def test_a_device_of_which_no_work_ends_by_itself_is_halted_when_it_is_found_at_work() -> None:
    verbs = {name: verb for name, verb in STATION.verbs.items() if verb.on_stop is OnStop.HALT}
    (station,) = plant().robots.values()
    driven = Driven()
    assert isinstance(station, Device)
    held = replace(station, kind=replace(STATION, verbs=verbs))
    driven.machine = Supervisor([("plc", [held])], epoch=EPOCH, stale_after_s=STALE_S)
    driven.step()
    heard, halt = driven.says(state=MotionState.MOVING)
    assert isinstance(heard, Report)
    assert halt == driven.given(Stop(id="", robot="station", mode=StopMode.HALT))


def test_an_answer_to_the_plants_own_repetition_is_passed_over(driven: Driven) -> None:
    driven.gives(LATCH)
    driven.says(boot_id=1)
    (heard,) = driven.says(boot_id=1, accepted="", rejected="", refusal="paro")
    assert isinstance(heard, Report)
    assert (heard.accepted, heard.rejected, heard.refusal) == (None, None, None)


def test_a_stop_that_reached_nobody_is_told_to_who_comes_back(driven: Driven) -> None:
    driven.step(after=STALE_S)
    (refused,) = driven.asks(LATCH)
    assert isinstance(refused, Report) and refused.refusal == "no_link"
    _, give = driven.says()
    assert isinstance(give, Give) and isinstance(give.command, Stop)


def test_reports_that_were_overtaken_or_lay_somewhere_prove_nothing(driven: Driven) -> None:
    driven.says(after=1.0)
    assert driven.says(late=0.5) == []
    (gone,) = driven.says(after=3.0, late=STALE_S + 0.1)
    assert isinstance(gone, Report) and gone.state is MotionState.NO_LINK


def test_a_driver_that_reads_slowly_is_named_and_its_device_does_not_come_and_go(driven: Driven) -> None:
    driven.step(after=STALE_S)  # it says nothing for so long
    (slow,) = driven.says(late=0.8)
    assert isinstance(slow, Report) and slow.state is MotionState.NO_LINK
    assert "a reading takes its driver plc 0.8 s, and must take less than half of" in str(slow.lost)
    assert driven.says(after=0.8, late=0.8) == []  # it was said
    (back,) = driven.says(after=0.7, late=0.7)
    assert isinstance(back, Report) and back.state is MotionState.STOPPED


def test_nobody_has_heard_of_what_is_to_come(driven: Driven) -> None:
    (heard,) = driven.says(late=-60.0)
    assert isinstance(heard, Report) and heard.at == driven.now


@pytest.mark.parametrize(
    ("report", "why"),
    [
        ("stopped", "'stopped' is no Report"),
        (Report(at=0.0, robot="mill"), "'mill' is none of its devices (station)"),
        (Report(at=0.0, robot="station", state=1), "state of station is 1; it must be a MotionState"),  # type: ignore[arg-type]
        (Report(at=0.0, robot="station", done=7), "done of station is 7; it must be a word or an id"),  # type: ignore[arg-type]
        (Report(at=float("nan"), robot="station"), "at of station is nan; it must be what the clock said"),
        (Report(at=10**400, robot="station"), "it must be what the clock said"),
        (Report(at=0.0, robot="station", rejected="9-1"), "rejected and refusal of station go together"),
        (Report(at=0.0, robot="station", facts={"at": "left"}), "it must be a tuple of pairs"),  # type: ignore[arg-type]
        (
            Report(at=0.0, robot="station", facts=(("lamp", "lit"),)),
            "lamp is 'lit'; station knows true or false",
        ),
        (Report(at=0.0, robot="station", q=(0.0,)), "q was said; station is a station and has none"),
    ],
)
def test_nonsense_is_told_in_the_log_and_changes_nothing(driven: Driven, report: object, why: str) -> None:
    if isinstance(report, Report) and report.at == 0.0:
        report = replace(report, at=driven.now)
    (refused,) = driven.step(DriverOutput(at=driven.now, life=driven.life, report=report))
    assert isinstance(refused, OutputRefused)
    assert str(refused.sentence).startswith("the driver plc reported nonsense: ") and why in str(
        refused.sentence
    )


def test_whoever_still_works_is_halted_before_the_driver_ends(driven: Driven) -> None:
    driven.gives(GO)
    halt, end = driven.step(Leaving(at=driven.now))
    assert isinstance(halt, Give) and halt.command == Stop(id="", robot="station", mode=StopMode.HALT)
    assert end == End(life=driven.life)
    assert driven.machine.next_deadline is None and driven.says() == []


def test_robots_that_another_process_leads_are_not_halted(driven: Driven) -> None:
    driven.gives(GO)
    assert driven.step(Leaving(at=driven.now, halts=False)) == [End(life=driven.life)]


def test_whose_work_has_ended_is_not_halted(driven: Driven) -> None:
    driven.gives(GO)
    driven.says(accepted="9-1", done="9-1")
    assert driven.step(Leaving(at=driven.now)) == [End(life=driven.life)]


HALT = Stop(id="", robot="station", mode=StopMode.HALT)


def test_whoever_works_is_halted_once_when_the_plant_is_not_heard_for_as_long_as_a_board_waits(
    driven: Driven,
) -> None:
    driven.beats()
    driven.gives(GO)
    driven.says(after=0.9, state=MotionState.MOVING, accepted="9-1")
    assert driven.machine.next_deadline == pytest.approx(driven.now + 0.1)
    give, failed, told = driven.step(after=0.1)
    assert give == driven.given(HALT)
    assert isinstance(failed, Report) and (failed.failed, failed.failure) == ("9-1", SILENCE)
    assert isinstance(told, DeviceHalt)
    said = "the plant was not heard for 1 s; station is halted, whose driver is plc"
    assert str(told.sentence) == said
    driven.step(SendResult(at=driven.now, life=driven.life, command=HALT))
    assert not any(isinstance(each, Give) for each in driven.says(after=1.0))
    assert PLANT_GONE_S == SILENCE_US / 1e6


def test_beats_and_commands_keep_work_going(driven: Driven) -> None:
    driven.beats()
    driven.gives(GO)
    driven.beats(after=0.8)
    driven.says(after=0.7, state=MotionState.MOVING)
    driven.gives(LIGHT)
    assert len(driven.says(after=0.9, state=MotionState.MOVING)) == 1


def test_a_plant_that_was_gone_for_long_gives_work_anew_and_is_watched_again(driven: Driven) -> None:
    driven.beats()
    driven.says(after=5.0)
    driven.gives(GO)
    driven.says(after=0.5, state=MotionState.MOVING)
    assert driven.step(after=0.5)[0] == driven.given(HALT)


def test_what_finishes_goes_on_when_the_plant_is_not_heard(driven: Driven) -> None:
    driven.beats()
    driven.gives(WARM)
    assert len(driven.says(after=1.2, state=MotionState.MOVING)) == 1


def test_who_rests_is_not_halted_when_the_plant_is_not_heard(driven: Driven) -> None:
    driven.beats()
    driven.gives(GO)
    driven.says(done="9-1")
    assert len(driven.says(after=1.2)) == 1


def test_a_plant_that_never_beat_is_not_watched_for(driven: Driven) -> None:
    driven.gives(GO)
    assert len(driven.says(after=1.2, state=MotionState.MOVING)) == 1
