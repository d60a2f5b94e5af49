"""Draft as a plant: its cells, what a tree can be made of there, edits of trees, and new recipes."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path, PurePath
from typing import Any

from arboleda.dashboard.findings import findings
from arboleda.drivers import Robot, quoted
from arboleda.drivers.port import DriverSpec
from arboleda.engine import Plant
from arboleda.extension import ArboledaError, ConfigError
from arboleda.model import text
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.plant_file import driver_forms, loader
from arboleda.plant_file.draft import shaded
from arboleda.recipes import Recipe, WrittenRecipe
from arboleda.recipes.of_files import FileRecipe
from arboleda.views import forms, tree_view
from arboleda.web.languages import texts
from arboleda_make.editing import carry, desk
from arboleda_make.editing.operations import Operation
from arboleda_proofs.campaigns.proof.single_faults import possible_kinds
from arboleda_proofs.simulator.faults.titles import title
from arboleda_trees.bt_xml import export

Row = dict[str, Any]
UNREAD = "the draft cannot be read yet; its problems say why"


class WorkshopPlant:
    """WorkshopPlant: the plant of the draft that could be read last. For one thread."""

    def __init__(self) -> None:
        self._model: PlantModel | None = None
        self._drivers: Mapping[str, DriverSpec] = {}  # of its own files
        self._open = ExitStack()  # the folder that the plant was read in

    def load(self, files: PlantFiles, plant_file: Path) -> tuple[str, ...]:
        """Take these files, and return their problems; with some the plant before stays."""
        opened = ExitStack()
        shade = opened.enter_context(shaded(files, plant_file))
        try:
            self._model, self._drivers = loader.load_with_drivers(shade.plant_file)
        except ConfigError as error:
            opened.close()
            return tuple(map(shade.shortened, error.problems))
        self._open.close()
        self._open = opened
        return ()

    def problems(self, files: PlantFiles, plant_file: Path) -> tuple[str, ...]:
        """The problems of these files, which are not taken."""
        with shaded(files, plant_file) as shade:
            try:
                loader.load_with_drivers(shade.plant_file)
            except ConfigError as error:
                return tuple(map(shade.shortened, error.problems))
        return ()

    def translate(self, language: str, lines: list[str]) -> list[str]:
        """Findings, given in English, in a language."""
        return [findings(language)(line) for line in lines]

    def cells(self) -> list[Row]:
        """Each cell: its devices, with facts and verbs, its targets and its recipes."""
        return [_cell(each) for each in self._read.cells]

    def faults(self) -> list[Row]:
        """The kinds of faults that can befall this plant, with what each is."""
        kinds = (each for each in possible_kinds() if each.targets(self._read))
        return [{"name": each.name, "title": title(each.name), "about": each.sentence} for each in kinds]

    def palette(self, cell: str, words: Mapping[str, str]) -> list[Row]:
        """As `PlantApi.palette`."""
        return desk.palette(self._read, cell, words)

    def drawn(self, cell: str, text: str, operation: Operation | None) -> Row:
        """As `PlantApi.drawn`."""
        return desk.drawn(self._read, cell, text, operation)

    def shown(self, cell: str, recipe: str) -> str:
        """The tree of a recipe, whoever wrote it, as XML that viewers show."""
        where = self._cell(cell)
        if recipe not in [each.name for each in where.recipes]:
            raise ArboledaError(f"{quoted(recipe)} is no recipe of {cell}")
        order = text.example(where, where.recipe(recipe))
        run = Plant(self._read, epoch=0, now=0.0).cells[cell]
        tree = run.cell.recipe(recipe).build(order, run.context)
        return export.export(tree_view.rows(tree, 0.0))

    def carrying(self, cell: str, name: str, robot: str, start: str, end: str) -> str:
        """A tree in which a robot takes a part at one target to another, as XML."""
        return carry.tree(self._cell(cell), name, robot=robot, start=start, end=end)

    def copied(self, cell: str, recipe: str, name: str) -> str:
        """As `PlantApi.copied`."""
        return desk.copied(self._read, cell, recipe, name)

    def drivers(self, language: str) -> list[Row]:
        """The drivers that a device of a declared kind can have, with a field for each setting."""
        rows = driver_forms.forms(self._drivers, texts(language, "drivers"))
        return [{**row, "why_not": findings(language)(row["why_not"])} for row in rows]

    def driver(self, name: str, texts: Mapping[str, str]) -> Any:
        """The value of the key `driver` for what was written in its fields."""
        return driver_forms.written(name, texts, self._drivers)

    @property
    def _read(self) -> PlantModel:
        if self._model is None:
            raise ArboledaError(UNREAD)
        return self._model

    def _cell(self, name: str) -> Cell:
        found = next((each for each in self._read.cells if each.name == name), None)
        if found is None:
            raise ArboledaError(f"{quoted(name)} is not a cell of this draft")
        return found


def _cell(cell: Cell) -> Row:
    written = {each.name: each for each in cell.recipes}
    return {
        "name": cell.name,
        "devices": [_device(cell, role, each) for role, each in cell.roles.items()],
        "targets": [_target(cell, each) for each in cell.targets],
        "carriers": list(carry.carriers(cell)),
        "recipes": [{**each, **_written(written[each["name"]])} for each in forms.recipes(cell)],
    }


def _device(cell: Cell, role: str, device: Robot) -> Row:
    return {
        "role": role,
        "name": device.name,
        "kind": device.kind_name,
        "facts": list(device.fact_names),
        "goes": device.name in cell.reach,
        "shared": device.name in cell.shared,
    }


def _target(cell: Cell, name: str) -> Row:
    """The robots that go to a target, and whether it can give a part to a task, or take one."""
    place = next((each for each in cell.places if each.target == name), None)
    gives, takes = (place is None or not place.output), (place is None or not place.supply)
    return {"name": name, "robots": _robots_at(cell, name), "gives": gives, "takes": takes}


def _robots_at(cell: Cell, target: str) -> list[str]:
    """The roles of the robots that go to a target."""
    return [
        role
        for role, robot in cell.roles.items()
        if robot.name in cell.reach and target in cell.reach[robot.name].targets
    ]


def _written(recipe: Recipe) -> Row:
    if isinstance(recipe, FileRecipe):
        return {"sort": "drawn", "file": recipe.file.rpartition("/")[2]}
    if isinstance(recipe, WrittenRecipe) and not recipe.is_shipped:
        return {"sort": "python", "file": PurePath(recipe.function.__code__.co_filename).name}
    return {"sort": "shipped", "file": ""}
