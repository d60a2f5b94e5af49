"""Devices that make parts: a printer, whose bed is full from when it is told to print."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.drivers.supervisor import CommandRequest, DriverOutput, Life, SendResult, Supervisor
from arboleda.model.commands import Command
from arboleda.model.errors import ConfigError
from arboleda.model.messages import MotionState, Report, TaskState, Undelivered
from arboleda.model.plant_model import Robot
from arboleda.model.sentence import as_sentence
from arboleda.model.verbs import Verb
from arboleda.plant_check import advance_check, place_check

from ...plants import read
from .test_places import PLANT as LAB
from .test_places import Lab, advice, recipe_of

PLANT = LAB.replace(
    "  oven:\n    facts",
    "  printer: {verbs: {print: {effect: process, makes: part, takes_s: 3}}}\n  oven:\n    facts",
).replace("      oven: {kind: oven}\n", "      oven: {kind: printer}\n")
PRINT = 'oven.print(), take("inside"), put("bin"), mover.home()'


def test_a_hand_takes_what_a_device_has_made(tmp_path: Path) -> None:
    lab = Lab(tmp_path, PRINT, PLANT)
    assert [lab.run(), lab.run()] == [None, None]
    assert lab.places.counts["inside"] == 0 and lab.places.counts["bin"] == 1


def test_nothing_is_made_where_a_part_is(tmp_path: Path) -> None:
    lab = Lab(tmp_path, "oven.print(), oven.print()", PLANT)
    assert "oven: inside has 1 already" in str(lab.run())


@pytest.mark.parametrize("restarts", [False, True])
def test_whether_a_part_is_on_the_bed_is_asked_after_a_failure(tmp_path: Path, restarts: bool) -> None:
    lab = Lab(tmp_path, PRINT, PLANT)
    lab.bench.submit("lab try")
    assert lab.bench.wait(30.0, lambda: "oven print" in lab.bench.told)
    lab.bench.power_off("oven")
    assert lab.bench.outcome(60.0).state is TaskState.FAILED
    lab.bench.power_on("oven")
    if restarts:
        lab.bench.crash()
    lab.bench.wait(5.0)
    assert lab.bench.plant.cells["lab"].context.places.asked.targets == ("inside",)
    assert "see that lab inside is empty and say so (unload lab inside)" in advice(lab)
    assert lab.bench.operate(Verb.UNLOAD, "lab", place="inside") is None
    assert lab.bench.plant.cells["lab"].not_ready is None


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("oven.print(), oven.print()", "has oven print a part at inside, which is full already"),
        ("oven.print()", "ends with 1 more at inside of oven than it began with"),
    ],
)
def test_check_knows_what_is_made(tmp_path: Path, body: str, sentence: str) -> None:
    warnings = advance_check.warnings(read(tmp_path, PLANT, recipe_of(body)))
    assert any(sentence in each for each in warnings), warnings


def test_check_finds_nothing_wrong_with_a_part_that_is_made_and_taken(tmp_path: Path) -> None:
    assert advance_check.warnings(read(tmp_path, PLANT, recipe_of(PRINT))) == ()


def test_check_misses_the_place_of_what_is_made(tmp_path: Path) -> None:
    plant = PLANT.replace("inside: {of: oven}", "inside: {}")
    (warning,) = place_check.warnings(read(tmp_path, plant, recipe_of(PRINT)))
    assert warning.startswith("lab: oven makes a part (print), and no place is of it; say where: ")


def test_only_a_process_makes_a_part(tmp_path: Path) -> None:
    plant = PLANT.replace("effect: process, makes: part", "effect: motion, makes: part")
    with pytest.raises(ConfigError, match="only a process makes a part, and this is a motion"):
        read(tmp_path, plant, recipe_of(PRINT))


def test_nothing_is_made_of_an_order_that_the_device_refuses(tmp_path: Path) -> None:
    lab = Lab(tmp_path, PRINT, PLANT)
    lab.bench.machines["oven"].refuses = lambda goal: "ocupado"
    lab.bench.submit("lab try")
    assert lab.bench.outcome(60.0).state is TaskState.FAILED
    assert lab.places.counts["inside"] == 0 and lab.bench.plant.cells["lab"].not_ready is None


def test_nothing_is_made_of_an_order_that_never_left(tmp_path: Path) -> None:
    lab = Lab(tmp_path, PRINT, PLANT)
    lab.bench.submit("lab try")
    assert lab.bench.wait(30.0, lambda: lab.places.counts["inside"] == 1)
    (entry,) = lab.bench.plant.dispatcher.ledger.of_robot("oven")
    lab.bench.plant.dispatcher.booking.undelivered(entry.command.id, "oven", as_sentence("it is off"), 0.0)
    assert lab.places.counts["inside"] == 0


def test_a_part_may_be_made_of_an_order_in_which_the_driver_broke_down(tmp_path: Path) -> None:
    lab = Lab(tmp_path, PRINT, PLANT)
    lab.bench.submit("lab try")
    assert lab.bench.wait(30.0, lambda: lab.places.counts["inside"] == 1)
    (entry,) = lab.bench.plant.dispatcher.ledger.of_robot("oven")
    for event in broken_send(lab.bench.plant.model.robots["oven"], entry.command):
        lab.bench.plant.step(lab.bench.now, [event])
    assert lab.bench.outcome(60.0).state is TaskState.FAILED
    assert lab.places.counts["inside"] == 1 and lab.places.asked.targets == ("inside",)


def broken_send(device: Robot, command: Command) -> list[Report | Undelivered]:
    """What the plant hears where the driver of a device breaks down in `send`."""
    life = Life(driver=0, number=1)
    supervisor = Supervisor([("plc", [device])], epoch=1, stale_after_s=1.5)
    heard = DriverOutput(
        at=0.0, life=life, report=Report(at=0.0, robot=device.name, state=MotionState.STOPPED)
    )
    asked = CommandRequest(at=0.0, command=command)
    supervisor.step(0.0, [])
    supervisor.step(0.0, [heard, asked])
    broke = SendResult(at=0.0, life=life, command=command, error=as_sentence("KeyError"), broken=True)
    return [each for each in supervisor.step(0.0, [broke]) if isinstance(each, Report | Undelivered)]
