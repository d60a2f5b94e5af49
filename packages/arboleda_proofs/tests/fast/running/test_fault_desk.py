"""Faults by hand: what is offered, what is refused, and what the plant is told."""

from __future__ import annotations

import itertools
from typing import Any

import pytest

from arboleda.model.messages import ClockSet, FaultByHand, Journal
from arboleda.sim.devices import Devices
from arboleda.testing import Rig, shipped
from arboleda.views.chronicle import Chronicle
from arboleda.views.view import snapshot
from arboleda_proofs.running.api import FaultRefused
from arboleda_proofs.running.fault_desk import FaultDesk
from arboleda_proofs.simulator.fault_bench import FaultBench
from arboleda_proofs.simulator.mishaps import MISHAPS

MODEL = shipped("sis_a", "sis_b")


class Virtual:
    """Virtual devices that do at once what they are told."""

    def __init__(self, elsewhere: tuple[str, ...] = ()) -> None:
        ids = itertools.count(1)
        devices = Devices(MODEL, now=0.0, boot_ids=lambda: next(ids), elsewhere=elsewhere)
        self.now, self.bench, self.noted = 0.0, FaultBench(MODEL, devices, now=0.0), print
        self.boards = tuple(devices.boards)

    def befall(self, *events: Any) -> None:
        for each in self.bench.step(self.now, events):
            if hasattr(each, "number"):
                self.noted(each)

    def read(self, look: Any) -> tuple[float, Any]:
        return self.now, look(self.bench)


class Desk:
    """Desk: a fault desk over virtual devices, and what the plant was told."""

    def __init__(self, *elsewhere: str) -> None:
        self.devices, self.told = Virtual(elsewhere), []
        self.desk = FaultDesk(MODEL, self.devices, self.told.append)
        self.devices.noted = self.desk.noted

    @property
    def sentences(self) -> list[str]:
        return [str(each.sentence) for each in self.told]


def test_only_what_needs_boards_alone_is_offered() -> None:
    offers = Desk().desk.offers()
    kinds = {each.kind for each in offers}
    assert {"reboot", "cut_link", "freeze", "lost_part"} < kinds
    assert not kinds & {"only_says_done", "broker_restart", "bridge_restart", "plant_crash"}
    assert [each.robot for each in offers if each.kind == "reboot"] == ["ra1", "rm_sis_a", "ra2", "rm_sis_b"]
    assert {each.robot for each in offers if each.kind == "no_grip"} == {"ra1", "ra2"}


def test_a_fault_begins_is_listed_and_ends_by_itself() -> None:
    made = Desk()
    begun = made.desk.begin("cut_link", "ra1", 3.0)
    assert (begun.robot, begun.kind, begun.left_s) == ("ra1", "cut_link", 3.0)
    made.devices.now = 1.0
    (known,) = made.desk.begun()
    assert (known.number, known.left_s) == (begun.number, 2.0)
    made.devices.now = 3.0
    made.devices.befall()
    assert made.desk.begun() == []
    assert made.sentences == [
        "fault by hand: Cut its link, for 3 s",
        "fault by hand is over: Cut its link",
    ]
    assert [each.is_over for each in made.told] == [False, True]


def test_a_reboot_that_lasts_is_a_board_without_power() -> None:
    made = Desk()
    assert made.desk.begin("reboot", "ra1", None).left_s == 0.0
    assert made.desk.begin("reboot", "ra1", 2.0).kind == "no_power"
    assert made.desk.begin("no_grip", "ra2", None).left_s == 5.0


def test_faults_are_ended_of_a_robot_by_number_or_all() -> None:
    made = Desk()
    first = made.desk.begin("cut_link", "ra1", 60.0)
    made.desk.begin("no_grip", "ra1", 60.0)
    made.desk.begin("no_grip", "ra2", 60.0)
    assert made.desk.end(number=first.number) == [first]
    assert [each.kind for each in made.desk.end("ra1")] == ["no_grip"]
    assert [each.robot for each in made.desk.end()] == ["ra2"]
    assert made.desk.end() == []
    assert made.desk.begun() == []


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (("cut_link", "ra9", None), "there is no device ra9; virtual ones are ra1, rm_sis_a, rm_sis_b"),
        (("cut_link", "ra2", None), "ra2 is no virtual device in this start; virtual ones are ra1, "),
        (("no_grip", "rm_sis_a", None), "no_grip cannot be provoked at rm_sis_a; what can is reboot, "),
        (("plant_crash", "ra1", None), "plant_crash cannot be provoked at ra1"),
        (("lost_part", "ra1", 5.0), "lost_part is over at once: leave out for how long"),
        (("cut_link", "ra1", 0.0), "a fault lasts from 0.1 s to 3600 s, not 0 s"),
        (("cut_link", "ra1", float("nan")), "a fault lasts from 0.1 s to 3600 s, not nan s"),
    ],
)
def test_what_cannot_be_is_refused_with_what_can(asked: tuple[Any, ...], said: str) -> None:
    made = Desk("ra2")
    with pytest.raises(FaultRefused) as refused:
        made.desk.begin(*asked)
    assert said in str(refused.value)
    assert not made.told
    assert made.desk.begun() == []


def test_a_fault_that_is_over_by_itself_just_when_it_is_ended_is_over() -> None:
    made = Desk()
    begun = made.desk.begin("cut_link", "ra1", 3.0)
    seen = made.devices.read(lambda bench: list(bench.begun.values()))
    made.devices.now = 3.0
    made.devices.befall()
    made.devices.read = lambda _look: seen  # as it was just before
    assert [each.number for each in made.desk.end("ra1")] == [begun.number]
    assert [each.is_over for each in made.told] == [False, True]


def test_an_unknown_number_is_refused() -> None:
    with pytest.raises(FaultRefused, match="no fault 7 goes on now"):
        Desk().desk.end(number=7)


def test_a_start_without_virtual_devices_offers_and_does_nothing() -> None:
    for desk in (FaultDesk(MODEL, None, print), Desk(*MODEL.robots).desk):
        assert list(desk.offers()) == []
        with pytest.raises(FaultRefused, match="only at virtual devices"):
            desk.begin("reboot", "ra1", None)
        with pytest.raises(FaultRefused, match="only at virtual devices"):
            desk.end("ra1")
    with pytest.raises(FaultRefused, match="only at virtual devices"):
        FaultDesk(MODEL, None, print).end()


def test_the_plant_keeps_it_in_its_journal_and_the_time_line_shows_it_once() -> None:
    rig = Rig(shipped("sis_a"))
    what = MISHAPS["reboot"].sentence
    sent = rig.plant.step(rig.now, [FaultByHand(at=rig.now, robot="ra1", sentence=what)])
    (entry,) = [each for each in sent if isinstance(each, Journal)]
    assert (entry.scope, entry.cell, entry.sentence) == ("ra1", "sis_a", what)
    line = Chronicle()
    line.see(snapshot(rig.plant), 100.0)
    line.see(snapshot(rig.plant), 101.0)
    shown = [each for each in line.events if each["kind"] == "fault"]
    assert [(each["cell"], each["subject"], each["sentence"]) for each in shown] == [("sis_a", "ra1", what)]


def test_that_the_clock_was_set_is_in_the_journal_and_on_the_time_line() -> None:
    rig = Rig(shipped("sis_a"))
    sent = rig.plant.step(rig.now, [ClockSet(at=rig.now, seconds=-3600.0)])
    (entry,) = [each for each in sent if isinstance(each, Journal)]
    assert str(entry.sentence) == "the clock of the plant's machine was set back by 3600 s"
    line = Chronicle()
    line.see(snapshot(rig.plant), 100.0)
    (shown,) = [each for each in line.events if each["sentence"] == entry.sentence]
    assert (shown["cell"], shown["subject"]) == (None, "plant")
