"""Examples of devices taken in by their topics: what is sent, what is heard, and that tasks are done."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from arboleda.drivers import MotionState, Stop, StopMode
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.model.plant_model import Link
from arboleda.plant_file.loader import load, load_with_offers
from arboleda_driver_faults.rig import Result, World
from arboleda_proofs.simulator.run import Simulation

from .topics_rig import FILES, FOLDER, Pairs, TopicsRig

ROWS: dict[str, dict[str, Any]] = yaml.safe_load(
    Path(__file__).with_name("own_topics.yaml").read_text("utf-8")
)
SENDS = [(file, *row) for file, rows in ROWS.items() for row in rows["sends"]]
MEANS = [(file, *row) for file, rows in ROWS.items() for row in rows["means"]]
TASKS = [(file, task) for file, rows in ROWS.items() for task in rows["tasks"]]
LEVELS = {"facts": "joints"}  # as the model calls it


def ended(file: str, task: str, fault: str = "") -> tuple[TopicsRig, TaskChanged]:
    """The end of a task, with a fault from its beginning on, if any."""
    rig = TopicsRig(file, task)
    world = World(rig, Result(seed=0, faults=()), tasks=1)
    world.advance(3.0)
    if fault:
        rig.faults.switch(fault, on=True)
    world.submit(task)
    world.advance(9000.0, until=lambda: bool(world.result.ended))
    (change,) = world.result.ended
    return rig, change


def test_each_example_has_its_rows() -> None:
    assert sorted(ROWS) == FILES


@pytest.mark.parametrize("file", FILES)
def test_an_example_is_good_and_says_how_much_is_believed(file: str) -> None:
    plant, missed = load_with_offers(FOLDER / f"{file}.yaml")
    assert not missed
    levels = {name: LEVELS.get(level, level) for name, level in ROWS[file]["evidence"].items()}
    assert {name: robot.evidence.value for name, robot in plant.robots.items()} == levels


@pytest.mark.parametrize("file", FILES)
def test_its_page_names_where_the_topics_are_from_and_is_short(file: str) -> None:
    lines = (FOLDER / f"{file}.yaml").read_text("utf-8").splitlines()
    assert "https://" in "".join(line for line in lines[:4] if line.startswith("#"))
    assert len(lines) < 60


@pytest.mark.parametrize(("file", "device", "verb", "values", "topic", "payload"), SENDS)
def test_a_verb_is_sent_as_the_firmware_hears_it(
    file: str, device: str, verb: str, values: dict[str, Any], topic: str, payload: str
) -> None:
    rig = TopicsRig(file)
    pairs = Pairs(rig)
    if verb == "stop":
        assert pairs.ask(Stop(id="s1", robot=device, mode=StopMode.HALT)) is None
    else:
        kind = rig.devices[device][0].kind
        assert pairs.ask(kind.command(id="c1", robot=device, verb=verb, values=values)) is None
    assert (pairs.sent[-1].topic, pairs.sent[-1].payload.decode()) == (topic, payload)


@pytest.mark.parametrize(("file", "device", "topic", "payload", "means"), MEANS)
def test_a_message_means_what_its_documentation_says(
    file: str, device: str, topic: str, payload: str, means: dict[str, Any]
) -> None:
    rig = TopicsRig(file)
    pairs = Pairs(rig)
    if "after" in means:
        rig.faults.switch("stick", on=True)
        verb, values = means["after"]
        command = rig.devices[device][0].kind.command(id="c1", robot=device, verb=verb, values=values)
        assert pairs.ask(command) is None
    pairs.tell(device, topic, payload)
    report = pairs.reports[device]
    assert dict(report.facts or ()).items() >= means.get("facts", {}).items()
    assert means.get("unknown", "") in (*report.unknown, "")
    assert means.get("lost", "") in str(report.lost or "")
    if "state" in means:
        assert report.state is MotionState[means["state"].upper()]
    if "done" in means:
        assert (report.done == "c1") is means["done"]
    assert report.failure == means.get("failed")
    assert report.answer == means.get("answer")


@pytest.mark.parametrize(("file", "task"), TASKS)
def test_a_task_is_done_by_the_virtual_ones_of_the_mapping(file: str, task: str) -> None:
    rig, change = ended(file, task)
    assert change.state is TaskState.DONE, change.sentence
    assert rig.done


@pytest.mark.parametrize(("file", "task"), TASKS)
def test_what_did_not_happen_is_not_believed_but_where_nothing_is_heard(file: str, task: str) -> None:
    rig, change = ended(file, task, "deaf")
    assert not rig.done
    assert (change.state is TaskState.DONE) is ROWS[file].get("unchecked", False)


@pytest.mark.sampled(11)
@pytest.mark.parametrize("file", FILES)
def test_its_recipes_hold_in_simulation(file: str) -> None:
    plant = load(FOLDER / f"{file}.yaml").on_boards(Link.DRIVER)
    result = Simulation(plant, 1, lambda minute: []).run(cycles=2)
    assert result.broken is None and not result.findings
