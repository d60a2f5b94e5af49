"""MakeApi of the plant in this process: its draft in the workshop, and what is tried and proved of it."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from arboleda.drivers import Robot, plain
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.recipe_forms import XML
from arboleda.plant_file.robot_models import pose_at_home
from arboleda.plant_file.yaml_edit import EditRefused
from arboleda.web.languages import spoken, texts
from arboleda_make.drafts.api import DraftRefused
from arboleda_make.drafts.draft import draft_of
from arboleda_make.editing.operations import Operation
from arboleda_make.trying.address import address
from arboleda_make.trying.api import MakeApi, Row

from ..drafts.desk import DraftDesk
from ..drafts.devices import with_device, without_cell, without_device
from ..drafts.plant_folder import NOT_OURS, PlantFolder
from .errands import ErrandRun, Work
from .problem_places import is_at, placed
from .workshop import Workshop

LOG = logging.getLogger("arboleda.operators")
FOLDER, RESULT, KEPT = "make", "result.json", "prove"
WORK = {
    "try": Work(module="tryout", command="simulate"),
    "prove": Work(module="proving", command="prove"),
    "notice": Work(module="noticing", command="prove"),
    "reach": Work(module="reaching", command="check"),
}


class MakeBench(MakeApi):
    """MakeBench: for threads of a server; `start` and `stop` as a part of a plant.

    `driven` are the robots that drivers of the running plant reach.
    """

    def __init__(self, folder: PlantFolder, state: Path, desk: DraftDesk, driven: Iterable[Robot]) -> None:
        self._folder = folder
        self._at_work = [*map(_at_work, driven)]
        self._kept = state / KEPT
        self._desk = desk
        self._workshop = Workshop(self._plant_file)
        self._runs = {name: ErrandRun(work, state / FOLDER / name) for name, work in WORK.items()}

    def start(self) -> None:
        """Nothing: processes begin when somebody asks for them."""

    def stop(self) -> None:
        """End all processes, and begin no other. Idempotent."""
        self._workshop.stop()
        for run in self._runs.values():
            run.end()

    def _plant_file(self) -> Path:
        """The plant file that there is; DraftRefused before the plant that comes with Arboleda is copied."""
        if self._folder.file is None:
            raise DraftRefused(NOT_OURS)
        return self._folder.file

    def cells(self) -> Row:
        return self._workshop.cells(*self._desk.files)

    def palette(self, cell: str, language: str) -> list[Row]:
        return self._workshop.palette(*self._desk.files, cell, texts(spoken([language]), "nodes"))

    def drawn(self, cell: str, text: str, operation: Operation | None = None) -> Row:
        return self._workshop.drawn(*self._desk.files, cell, text, operation)

    def shown(self, cell: str, recipe: str) -> str:
        return self._workshop.shown(*self._desk.files, cell, recipe)

    def carry(self, editor: str, recipe: str, way: Mapping[str, str]) -> Row:
        text = self._workshop.carrying(*self._desk.files, way["cell"], recipe, way)
        return self._desk.add_trees(editor, f"{recipe}{XML}", text)

    def copy(self, editor: str, cell: str, recipe: str, name: str) -> Row:
        text = self._workshop.copied(*self._desk.files, cell, recipe, name)
        return self._desk.add_trees(editor, f"{name}{XML}", text)

    def translate(self, language: str, lines: list[str]) -> list[str]:
        return self._workshop.translate(spoken([language]), lines)

    def drivers(self, language: str) -> list[Row]:
        return self._workshop.drivers(*self._desk.files, spoken([language]))

    def add_device(self, editor: str, device: Mapping[str, Any]) -> Row:
        return self._desk.rewrite(editor, self._adding(device))

    def objections(self, device: Mapping[str, Any]) -> list[Row]:
        cell = f"cells.{device['cell']}"
        own = (f"{cell}.devices.{device['role']}", f"kinds.{device['kind']}")
        found = [*map(placed, self._workshop.problems(self._with(device)))]
        named = [each for each in found if each[0] == cell]
        before = self._workshop.problems(self._desk.files[1]) if named else []  # also of a cell that is there
        of_cell = set(named) - {*map(placed, before)}
        return [
            {"place": place, "sentence": said}
            for place, said in found
            if (place, said) in of_cell or any(is_at(place, each) for each in own)
        ]

    def remove(self, editor: str, cell: str, role: str) -> Row:
        def change(values: Any) -> Any:
            return without_device(values, cell, role) if role else without_cell(values, cell)

        return self._desk.rewrite(editor, change)

    def reach(self, device: Mapping[str, Any]) -> Row:
        files = self._with(device)
        wanted = {"cell": device["cell"], "role": device["role"], "at_work": self._at_work}
        self._runs["reach"].begin(files, self._plant_file(), wanted)
        LOG.info("a new device is listened to: %s, by %s", plain(device["role"]), plain(device["driver"]))
        return self.run("reach")

    def _with(self, device: Mapping[str, Any]) -> PlantFiles:
        """The files of the draft with a device."""
        try:
            return draft_of(self._desk.files[1]).rewritten(self._adding(device)).files
        except EditRefused as error:
            raise DraftRefused(error.sentence) from error

    def _adding(self, device: Mapping[str, Any]) -> Callable[[Any], Any]:
        """The edit that adds a device, with the settings of its driver, to the values of a plant file."""
        driver: Any = None
        if device["driver"]:
            driver = self._workshop.driver(*self._desk.files, device["driver"], device["settings"])
        made = {**device, "driver": driver}
        home = pose_at_home(device["kind"], device["keys"].get("model"))
        return lambda values: with_device(values, made, home)

    def begin(self, what: str, wanted: Mapping[str, Any]) -> Row:
        kept = {"kept": str(self._kept.absolute())} if what == "prove" else {}
        self._runs[what].begin(self._desk.files[1], self._plant_file(), {**wanted, **kept})
        return self.run(what)

    def run(self, what: str) -> Row:
        return self._runs[what].state()

    def end(self, what: str) -> Row:
        self._runs[what].stop()
        return self.run(what)

    def result(self, what: str) -> Path | None:
        return self._file(what, RESULT)

    def proof_page(self) -> Path | None:
        """The file of the last proof as a page."""
        return self._file("prove", "proof.html")

    def tried(self) -> tuple[Path, Path] | None:
        """The record of the last tryout, and the file of what a page on it shows."""
        record, layout = self._file("try", "tried.mcap"), self._file("try", "layout.json")
        return (record, layout) if record and layout else None

    def _file(self, what: str, name: str) -> Path | None:
        """A file that came of one of the runs; None if it is not there."""
        run = self._runs[what]
        file = run.folder / name
        return file if run.state()["state"] != "running" and file.exists() else None


def _at_work(robot: Robot) -> Row:
    """A device with a driver that runs, as plain data."""
    assert robot.driver is not None
    settings = address(robot.driver.settings)
    return {"device": robot.name, "driver": robot.driver.name, "address": settings}
