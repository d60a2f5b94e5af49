"""The files a person writes: plant file -> PlantModel, users file -> passwords; all problems at once."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from arboleda.drivers.port import DriverSpec
from arboleda.host.packages import entry_points, package_of
from arboleda.model.assistants import Assistants
from arboleda.model.errors import ConfigError
from arboleda.model.packages import FLEET, MISSING
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import (
    Cell,
    ForeignCommands,
    MqttVersion,
    OpcUaView,
    PlantModel,
    Robot,
    Timing,
)
from arboleda.model.recipe import Recipe
from arboleda.model.recording import Limits, Recording
from arboleda.model.sentence import OWN
from arboleda.store.address import has_password
from arboleda.store.schemes import objection

from . import drivers, own_kinds, own_recipes, user_file
from .assistant_limits import assistant_limits
from .deadlines import check_arrivals_show
from .devices import CELLS, Kinds, device_cell, is_of_devices, shared_devices
from .document import Document, Place, shown
from .kinds import kinds
from .names import check_names
from .python_uses import PythonUses, Watch
from .recipe_check import MOST, Trial, combinations
from .recipe_trial import Verdict, brought
from .shapes import FileShape, OpcUaViewShape, RecordShape, TimingShape
from .shared import check_homes
from .shipped import SHIPPED, shipped
from .storage_form import check_sections, storage_cell
from .urdf import own_description
from .yaml_marks import LARGEST
from .zones import with_zones, zones

Offers = Callable[[Sequence[Cell]], Mapping[str, tuple[Recipe, ...]]]
Misses = Mapping[str, Mapping[str, str]]
RECORD: Place = ("record",)
REPORTS: Place = ("reports",)
ON, OFF = "on", "off"


def load(path: Path | None = None, *, recipes: bool = True, apart: bool = True) -> PlantModel:
    """The plant that the file describes, None for the shipped one; ConfigError with every problem.

    Without `recipes` no Python is run: cells of devices offer nothing, and a plant with devices of kinds in
    Python has no cells. Without `apart` it is tried in this process, which is far quicker, and nothing ends
    Python that never comes back.
    """
    return _parsed(*_content(path), recipes=recipes, apart=apart).plant


def load_with_offers(path: Path | None = None) -> tuple[PlantModel, Misses]:
    """The same plant, and by cell and recipe why a cell does not offer what a file brings."""
    parsed = _parsed(*_content(path), recipes=True)
    return parsed.plant, parsed.missed


def load_with_drivers(path: Path | None = None) -> tuple[PlantModel, Mapping[str, DriverSpec]]:
    """The same plant, and by name the drivers that files of its own bring."""
    parsed = _parsed(*_content(path), recipes=True)
    return parsed.plant, parsed.drivers


def load_recorded(path: Path | None = None) -> tuple[PlantModel, Recording | None]:
    """The same plant, and the beginning of its record; None if its file says `record: off`."""
    plant, document, *_ = _parsed(*_content(path), recipes=True)
    if document.value(RECORD) == OFF:
        return plant, None
    reports = document.has(REPORTS) and document.value(REPORTS) == ON
    return plant, Recording(files=_files(document), limits=_limits(document) or Limits(), reports=reports)


def load_with_files(
    path: Path | None = None, *, runs: bool = False, apart: bool = True
) -> tuple[PlantModel, PlantFiles]:
    """The same plant, and all files that were read for it; `apart` as of `load`.

    With `runs` it is for a plant that runs in this process: Python that it has imported is not run again, and
    is a problem where it is another now.
    """
    plant, document, *_ = _parsed(*_content(path), recipes=True, runs=runs, apart=apart)
    return plant, _files(document)


def parse(name: str, content: bytes, folder: Path | None = None, *, recipes: bool = True) -> PlantModel:
    """The same for the content of a file that problems call `name`; `folder` has the files beside it."""
    return _parsed(name, content, folder, recipes=recipes).plant


def _content(path: Path | None) -> tuple[str, bytes, Path | None]:
    """The name of a plant file, its content, and the folder of the files beside it."""
    if path is None:
        return SHIPPED, shipped(), None
    return str(path), user_file.read_bytes(path, LARGEST), path.parent


class _Reading(NamedTuple):
    plant: PlantModel
    document: Document
    missed: Misses
    drivers: Mapping[str, DriverSpec]


def _parsed(
    name: str,
    content: bytes,
    folder: Path | None,
    *,
    recipes: bool,
    runs: bool = False,
    apart: bool = True,
) -> _Reading:
    document = Document(name, content, folder, runs=runs)
    document.files[(folder or Path()) / Path(name).name] = content
    missed: Misses = {}
    brings: Mapping[str, DriverSpec] = {}
    if recipes:
        code = brought(document, content, apart=apart)
        missed, brings = code.missed, code.used.drivers
        plant = drivers.with_drivers(document, _plant(document, code.used, code.offered), code.used)
    elif own_kinds.needs_python(document):
        plant = _named(document)
    else:
        plant = _plant(document, PythonUses(), _nothing)
    document.finish(document.keys(CELLS))
    if plant is None:
        raise ConfigError((f"{document.name}: the file cannot be read as a plant",))
    return _Reading(plant, document, missed, brings)


def _files(document: Document) -> PlantFiles:
    """All files that were read, under paths from the folder that holds them all."""
    paths = {os.path.normpath(path.absolute()): content for path, content in document.files.items()}
    plant, *_ = paths  # it is read first
    folder = os.path.commonpath([os.path.dirname(path) for path in paths])
    names = {path: Path(os.path.relpath(path, folder)).as_posix() for path in paths}
    return PlantFiles(plant=names[plant], contents={names[path]: each for path, each in paths.items()})


def _limits(document: Document) -> Limits | None:
    """The limits of the record that is kept; None, with its problems kept, if they cannot be read."""
    if document.has(RECORD) and document.value(RECORD) == OFF:
        if document.has(REPORTS) and document.value(REPORTS) == ON:
            document.problem(REPORTS, "reports are made of the record, which is off")
        return Limits()
    if not document.has(RECORD):
        return Limits()
    shape = document.read(RecordShape, RECORD)
    return None if shape is None else Limits(**shape.model_dump())


def trial(name: str, content: bytes, folder: Path | None, watch: Watch) -> Verdict:
    """The problems of a plant file and of its recipes, which are built here for each task they could have.

    The plant's Python files run in this process, whatever they do to it; `parse` runs this function in
    another one.
    """
    document, found = Document(name, content, folder), Verdict()

    def tried(cells: Sequence[Cell]) -> dict[str, tuple[Recipe, ...]]:
        tried_here = Trial(document=document, used=used, watch=watch)
        found.offers, found.missed = tried_here.run(cells), tried_here.missed
        found.unused = tried_here.unused
        return {}

    used = own_recipes.imported(document, own_recipes.listed(document), watch)
    _plant(document, used, tried)
    drivers.found(document, used)
    found.here, found.elsewhere = document.kept
    return found


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """The warnings about this plant that a person should read before it moves."""
    return tuple(
        f'{robot.name}: declared "stop: none", so a stop (software) cannot reach it; '
        "only the hard-wired button that removes motor power can"
        for robot in plant.robots.values()
        if not robot.has_stop
    )


def notes(plant: PlantModel) -> tuple[str, ...]:
    """The assumptions made about models that are the plant's own, and about recipes tried only in part."""
    described = {
        description: robot.name
        for robot in reversed(plant.robots.values())
        if (description := own_description(robot)) is not None
    }
    own_models = [f"{name}: {note}" for own, name in described.items() for note in own.notes]
    many = [(cell, each, combinations(cell, each)) for cell in plant.cells for each in cell.recipes]
    sampled = [
        f"{cell.name}: {recipe.name} has {number} combinations of parameters; {MOST} of them were tried"
        for cell, recipe, number in many
        if number > MOST and not recipe.is_shipped
    ]
    return (*own_models, *sampled)


def offers(plant: PlantModel, missed: Misses) -> tuple[str, ...]:
    """Lines that say which cells offer which recipes, and why a cell does not offer another one."""
    lines: dict[str, list[str]] = {}
    for cell in plant.cells:
        known = ", ".join(each.name for each in cell.recipes) or "no recipe"
        others = "".join(f"; not {name}: {why}" for name, why in missed.get(cell.name, {}).items())
        lines.setdefault(f"{known}{others}", []).append(cell.name)
    return tuple(f"{', '.join(names)}: {line}" for line, names in lines.items())


def broker_users(path: Path) -> dict[str, str]:
    """Passwords by user from lines `NAME:PASSWORD`; ConfigError with every problem, never with a password."""
    lines = user_file.read_text(path, LARGEST).splitlines()
    users: dict[str, str] = {}
    problems = []
    for number, line in enumerate(lines, start=1):
        if not line.strip() or line.startswith("#"):
            continue
        name, _, password = line.partition(":")
        if not (name.strip() and password):
            problems.append(f"{path}:{number}:1: must be NAME:PASSWORD, neither of them empty")
        elif name.strip() in users:
            problems.append(f"{path}:{number}:1: the user {shown(name.strip())} is there twice")
        users[name.strip()] = password
    if not users:
        problems.append(f"{path}: names no user; write lines of NAME:PASSWORD")
    if problems:
        raise ConfigError(tuple(problems))
    return users


def _nothing(cells: Sequence[Cell]) -> dict[str, tuple[Recipe, ...]]:
    return {}


def _named(document: Document) -> PlantModel | None:
    shape = document.read(FileShape)
    return None if shape is None else PlantModel(name=shape.name, cells=())


def _plant(document: Document, used: PythonUses, recipes: Offers) -> PlantModel | None:
    shape = document.read(FileShape)
    own_kinds.complete(document, used)
    known = Kinds(declared=kinds(document), names=document.keys(("kinds",)), used=used)
    common = shared_devices(document, known)
    cells = [_cell(document, name, known, common) for name in document.keys(("cells",))]
    timing = _timing(document)
    check_names(document, partial(known.has_twin, document))
    of_form = [(*CELLS, name) for name in document.keys(CELLS)]
    check_sections(document, [place for place in of_form if not is_of_devices(document, place)])
    whole = [cell for cell in cells if cell is not None]
    regions = zones(document, whole)
    _check_ports(document, shape)
    check_homes(document, whole)
    zoned = {cell.name: with_zones(document, cell, regions) for cell in whole}
    offers = recipes(list(zoned.values()))
    if timing is None:
        return None
    _limits(document)
    limits = assistant_limits(document)
    times = Timing(**timing.model_dump())
    check_arrivals_show(document, whole, times)
    if shape is None or len(whole) < len(cells):
        return None
    return PlantModel(
        name=shape.name,
        cells=tuple(
            replace(cell, recipes=(*cell.recipes, *offers.get(cell.name, ()))) for cell in zoned.values()
        ),
        timing=times,
        mqtt_version=MqttVersion(shape.mqtt_version),
        zones=tuple(region.name for region in regions),
        foreign_commands=ForeignCommands(shape.foreign_commands),
        history_days=shape.history_days,
        groot2_port=shape.groot2 or None,
        opcua_view=_opcua_view(document),
        store=_store(document, shape.store),
        assistants=Assistants(shape.assistants),
        assistant_limits=limits,
    )


def _check_ports(document: Document, shape: FileShape | None) -> None:
    """Each cell needs two ports of its own for Groot2."""
    if shape is not None:
        last = 65_536 - 2 * len(shape.cells)
        if shape.groot2 > last:
            rule = f"must be at most {last}, for each of the {len(shape.cells)} cells has two ports"
            document.problem(("groot2",), f"{rule}; is {shape.groot2}")


def _opcua_view(document: Document) -> OpcUaView | None:
    """The server that shows the plant; None if it is off, or cannot be read, with its problems kept."""
    place = ("opcua_view",)
    if not document.has(place):
        return None
    if FLEET not in {package_of(each) for each in entry_points("arboleda.parts")}:
        document.problem(place, str(MISSING(what=OWN(text="opcua_view"), package=FLEET)))
    shape = document.read(OpcUaViewShape, place)
    return None if shape is None else OpcUaView(port=shape.port, isa95=tuple(shape.isa95))


def _store(document: Document, address: str) -> str:
    """The database of the plant's memory; problems do not repeat it, for there may be a password in it."""
    wrong = objection(address) if address else ""
    if wrong:
        document.problem(("store",), wrong)
    elif has_password(address):
        document.problem(("store",), "has a password in it; leave it to PGPASSWORD or ~/.pgpass")
    return address


def _timing(document: Document) -> TimingShape | None:
    if not document.has(("timing",)):
        return TimingShape()
    shape = document.read(TimingShape, ("timing",))
    if shape and shape.piece_debounce_s >= shape.piece_wait_s:
        rule = f"must be less than piece_wait_s, which is {shape.piece_wait_s:g}"
        document.problem(("timing", "piece_debounce_s"), f"{rule}; is {shape.piece_debounce_s:g}")
    if shape and shape.effector_settle_s > shape.effector_timeout_s:
        rule = f"must be at most effector_timeout_s, which is {shape.effector_timeout_s:g}"
        why = "else an effector that reports nothing is given up before it counts as switched"
        document.problem(("timing", "effector_settle_s"), f"{rule}, {why}; is {shape.effector_settle_s:g}")
    return shape


def _cell(document: Document, name: str, kinds: Kinds, common: Mapping[str, Robot]) -> Cell | None:
    place: Place = (*CELLS, name)
    if is_of_devices(document, place):
        return device_cell(document, place, kinds, common)
    return storage_cell(document, place)
