"""The draft as a plant in a process of its own: what it answers, and what it does with a wrong draft."""

from __future__ import annotations

import subprocess
import threading
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from types import SimpleNamespace
from typing import Any, TypeAlias

import pytest

from arboleda.model.errors import ArboledaError
from arboleda.model.plant_files import PlantFiles
from arboleda_make.drafts.api import DraftRefused
from arboleda_make.trying.bench import MakeBench
from arboleda_make.trying.workshop import ENDING, Workshop

Processes: TypeAlias = "SimpleQueue[subprocess.Popen[bytes]]"
OWN_TREE = Path(__file__).parents[5] / "examples/own_tree/plant.yaml"
BASE = PlantFiles(
    plant="plant.yaml",
    contents={"plant.yaml": OWN_TREE.read_bytes(), "tend.xml": OWN_TREE.with_name("tend.xml").read_bytes()},
)


@pytest.fixture(scope="module")
def workshop() -> Iterator[Workshop]:
    """One for all: its process takes longer to begin than to answer."""
    made = Workshop(lambda: OWN_TREE)
    yield made
    made.stop()


def changed(name: str, before: bytes, after: bytes) -> PlantFiles:
    text = BASE.contents[name]
    assert before in text
    return PlantFiles(plant=BASE.plant, contents={**BASE.contents, name: text.replace(before, after)})


def test_a_new_target_is_one_of_the_draft_at_once(workshop: Workshop) -> None:
    draft = changed(
        "plant.yaml", b"      vise:", b"      rack: {loader: {deg: [10, 20], mm: 5}}\n      vise:"
    )
    [cell] = workshop.cells(BASE, draft)["cells"]
    assert "rack" in [each["name"] for each in cell["targets"]] and cell["carriers"] == ["loader"]
    assert [(each["name"], each["sort"], each["file"]) for each in cell["recipes"]] == [
        ("tend", "drawn", "tend.xml")
    ]
    text = workshop.carrying(
        BASE, draft, "cell", "to_rack", {"robot": "loader", "start": "vise", "end": "rack"}
    )
    assert workshop.drawn(BASE, draft, "cell", text, None)["marks"] == []
    wrong = workshop.drawn(BASE, draft, "cell", text.replace("rack", "moon"), None)["marks"]
    assert "moon" in wrong[0]["sentence"]


def test_a_draft_that_cannot_be_read_is_shown_as_it_was_with_its_problems(workshop: Workshop) -> None:
    broken = changed("plant.yaml", b"kind: person", b"kind: persn")
    found = workshop.cells(BASE, broken)
    assert [each["name"] for each in found["cells"]] == ["cell"]
    assert any(each.startswith("plant.yaml:") and "persn" in each for each in found["problems"])
    assert workshop.cells(BASE, BASE)["problems"] == []


def test_what_check_finds_in_a_device_is_said_at_its_place_and_nothing_of_others(tmp_path: Path) -> None:
    desk: Any = SimpleNamespace(files=(BASE, changed("plant.yaml", b"kind: person", b"kind: persn")))
    folder: Any = SimpleNamespace(file=OWN_TREE)
    bench = MakeBench(folder, tmp_path, desk, ())
    verb = {"effect": "switch", "sets": {"down": True}}
    kind = {"facts": {"up": "bool"}, "verbs": {"raise": verb}}
    lift = {"cell": "cell", "role": "Lift", "kind": "lift", "declared": kind}
    try:
        rows = bench.objections({**lift, "driver": "", "settings": {}, "keys": {}})
    finally:
        bench.stop()
    found = {row["place"]: row["sentence"] for row in rows}
    device, raises = "cells.cell.devices.Lift", "kinds.lift.verbs.raise"
    assert found.keys() == {device, raises, f"{raises}.sets"}
    assert found[raises] == f'{raises}: the name "raise" is a word of Python; give a verb another one'


@pytest.fixture
def begun(monkeypatch: pytest.MonkeyPatch) -> Processes:
    """The processes of workshops, in the order in which they begin."""
    found: Processes = SimpleQueue()
    popen = subprocess.Popen

    def begin(*args: Any, **options: Any) -> Any:
        found.put(run := popen(*args, **options))
        return run

    monkeypatch.setattr(subprocess, "Popen", begin)
    return found


def test_a_process_that_ended_begins_again(begun: Processes) -> None:
    workshop = Workshop(lambda: OWN_TREE)
    assert "BehaviorTree" in workshop.shown(BASE, BASE, "cell", "tend")
    begun.get().kill()
    with suppress(ArboledaError):  # the first request may meet it before it has ended
        workshop.shown(BASE, BASE, "cell", "tend")
    assert "BehaviorTree" in workshop.shown(BASE, BASE, "cell", "tend")
    workshop.stop()


def test_at_its_end_whoever_waits_is_refused_and_no_process_begins(begun: Processes) -> None:
    workshop = Workshop(lambda: OWN_TREE)
    refused: SimpleQueue[str] = SimpleQueue()

    def ask() -> None:
        with pytest.raises(ArboledaError) as error:
            workshop.shown(BASE, BASE, "cell", "tend")
        refused.put(str(error.value))

    waiting = [threading.Thread(target=ask) for _ in range(3)]
    for each in waiting:
        each.start()
    run = begun.get()
    workshop.stop()
    for each in waiting:
        each.join()
    assert run.poll() is not None and begun.empty()
    assert [refused.get() for _ in waiting] == [ENDING] * len(waiting)


def test_drivers_of_the_plants_own_files_are_offered_with_those_of_arboleda() -> None:
    folder = OWN_TREE.parents[1] / "own_driver"
    names = ("plant.yaml", "recipes.py", "drivers/line_tcp.py")
    files = PlantFiles(plant="plant.yaml", contents={each: (folder / each).read_bytes() for each in names})
    workshop = Workshop(lambda: folder / "plant.yaml")
    try:
        known = {each["name"]: each for each in workshop.drivers(files, files, "es")}
        assert {"line_tcp", "modbus", "mqtt"} <= known.keys() and "dobot" not in known
        assert known["modbus"]["about"].startswith("Un PLC")
        assert ("host", True) in [(each["name"], each["required"]) for each in known["line_tcp"]["keys"]]
        told = workshop.driver(files, files, "line_tcp", {"host": "10.0.0.7", "port": "4712"})
        assert told == {"line_tcp": {"host": "10.0.0.7", "port": 4712}}
        with pytest.raises(DraftRefused, match="port must be a whole number"):
            workshop.driver(files, files, "line_tcp", {"host": "10.0.0.7", "port": "far"})
    finally:
        workshop.stop()
