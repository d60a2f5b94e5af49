"""The files a person writes: plant file -> PlantModel, users file -> passwords; all problems at once."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Any

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Cell, ForeignCommands, MqttVersion, PlantModel, Retry, Robot, Timing
from arboleda.model.recipe import Recipe
from arboleda.recipes.storage import RECIPES
from arboleda.recipes.storage_cell import ARM, MOBILE, StorageCell
from arboleda.recipes.storage_cell import Path as Route
from arboleda.recorder.preamble import Limits, PlantFiles, Recording
from arboleda.store.address import has_password, is_address

from . import drivers, own_kinds, own_recipes, rack, user_file
from .deadlines import check_arrivals_show
from .devices import CELLS, Kinds, device_cell, is_of_devices, shared_devices
from .document import Document, Place, shown
from .kinds import kinds
from .names import check_names
from .paths import check_nodes_show, paths
from .pickups import default_pickup, pickups
from .poses import PoseReader
from .python_uses import PythonUses, Watch
from .recipe_check import MOST, Trial, combinations
from .recipe_trial import Verdict, brought
from .robot_models import ArmModel
from .robots import arm, arm_model, check_absence, mobile
from .shapes import CellShape, FileShape, PoseShape, PositionShape, RecordShape, RetryShape, TimingShape
from .yaml_marks import LARGEST
from .zones import with_zones, with_zones_of_targets, zones

Offers = Callable[[Sequence[Cell]], Mapping[str, tuple[Recipe, ...]]]
SHARED = ("paths", "stations", "palletizing")
SHIPPED = "plant.yaml"
RECORD: Place = ("record",)
REPORTS: Place = ("reports",)
ON, OFF = "on", "off"


def load(path: Path | None = None, *, recipes: bool = True) -> PlantModel:
    """The plant that the file describes, None for the shipped one; ConfigError with every problem.

    Without `recipes` no Python is run: cells of devices offer nothing, and a plant with devices of kinds in
    Python has no cells.
    """
    return _parsed(*_content(path), recipes=recipes)[0]


def load_recorded(path: Path | None = None) -> tuple[PlantModel, Recording | None]:
    """The same plant, and the beginning of its record; None if its file says `record: off`."""
    plant, document = _parsed(*_content(path), recipes=True)
    if document.value(RECORD) == OFF:
        return plant, None
    reports = document.has(REPORTS) and document.value(REPORTS) == ON
    return plant, Recording(files=_files(document), limits=_limits(document) or Limits(), reports=reports)


def load_with_files(path: Path | None = None) -> tuple[PlantModel, PlantFiles]:
    """The same plant, and all files that were read for it."""
    plant, document = _parsed(*_content(path), recipes=True)
    return plant, _files(document)


def parse(name: str, content: bytes, folder: Path | None = None, *, recipes: bool = True) -> PlantModel:
    """The same for the content of a file that problems call `name`; `folder` has the files beside it."""
    return _parsed(name, content, folder, recipes=recipes)[0]


def _content(path: Path | None) -> tuple[str, bytes, Path | None]:
    """The name of a plant file, its content, and the folder of the files beside it."""
    if path is None:
        return SHIPPED, files("arboleda").joinpath("plants", SHIPPED).read_bytes(), None
    return str(path), user_file.read_bytes(path, LARGEST), path.parent


def _parsed(name: str, content: bytes, folder: Path | None, *, recipes: bool) -> tuple[PlantModel, Document]:
    document = Document(name, content, folder)
    document.files[(folder or Path()) / Path(name).name] = content
    if recipes:
        code = brought(document, content)
        plant = drivers.with_drivers(document, _plant(document, code.used, code.offered), code.used)
    elif own_kinds.needs_python(document):
        plant = _named(document)
    else:
        plant = _plant(document, PythonUses(), _nothing)
    document.finish()
    if plant is None:
        raise ConfigError((f"{document.name}: the file cannot be read as a plant",))
    return plant, document


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
        found.offers = Trial(document=document, used=used, watch=watch).run(cells)
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
        robot.description: robot.name
        for robot in reversed(plant.robots.values())
        if robot.has_joints and robot.description
    }
    own_models = [f"{name}: {note}" for own, name in described.items() for note in own.notes]
    many = [(cell, each, combinations(cell, each)) for cell in plant.cells for each in cell.recipes]
    sampled = [
        f"{cell.name}: {recipe.name} has {number} combinations of parameters; {MOST} of them were tried"
        for cell, recipe, number in many
        if number > MOST and recipe not in RECIPES
    ]
    return (*own_models, *sampled)


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
    _check_sections(document)
    whole = [cell for cell in cells if cell is not None]
    regions = zones(document, whole)
    _check_ports(document, shape)
    zoned: dict[str, Cell] = {
        cell.name: with_zones(document, cell, regions)
        if cell.is_storage
        else with_zones_of_targets(document, cell, regions)
        for cell in whole
    }
    offers = recipes(list(zoned.values()))
    if timing is None:
        return None
    _limits(document)
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
        store=_store(document, shape.store),
    )


def _check_ports(document: Document, shape: FileShape | None) -> None:
    """Each cell needs two ports of its own for Groot2."""
    if shape is not None:
        last = 65_536 - 2 * len(shape.cells)
        if shape.groot2 > last:
            rule = f"must be at most {last}, for each of the {len(shape.cells)} cells has two ports"
            document.problem(("groot2",), f"{rule}; is {shape.groot2}")


def _store(document: Document, address: str) -> str:
    """The database of the plant's memory; problems do not repeat it, for there may be a password in it."""
    if address and not is_address(address):
        document.problem(("store",), "must be postgresql://USER@HOST:PORT/DATABASE")
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
    place: Place = ("cells", name)
    if is_of_devices(document, place):
        return device_cell(document, place, kinds, common)
    shape = document.read(CellShape, place)
    kind = arm_model(document, (*place, ARM))
    the_arm = arm(document, (*place, ARM), kind)
    the_mobile = mobile(document, (*place, MOBILE))
    routes = paths(document, _section(document, place, "paths"))
    poses = _poses(document, place, kind, routes)
    retry = document.read(RetryShape, (*place, "retry")) if document.has((*place, "retry")) else RetryShape()
    if the_mobile and routes:
        check_nodes_show(document, (*place, MOBILE), routes, the_mobile)
    if not (shape and retry and the_arm and the_mobile and routes and poses):
        return None
    check_absence(document, place, shape.on_absence, (the_arm, the_mobile))
    return StorageCell(
        name=name,
        recipes=RECIPES,
        arm=the_arm,
        mobile=the_mobile,
        paths=routes,
        queue_limit=shape.queue_limit,
        goes_on=shape.on_restart == "go_on",
        goes_on_after_absence=shape.on_absence == "go_on",
        drive_to_start=shape.drive_to_start,
        retry=Retry(**retry.model_dump()),
        piece_check=shape.piece_check,
        zone_wait_s=shape.zone_wait_s,
        **poses,
    )


def _poses(
    document: Document, place: Place, kind: ArmModel | None, routes: tuple[Route, ...]
) -> dict[str, Any]:
    """The poses of an arm's places; empty, with the problems kept, if one is wrong."""
    if kind is None:
        document.read(PositionShape, (*place, "home"))
        document.read(PoseShape, (*place, "pickup"))
        for exit in document.keys((*place, "pickups")):
            document.read(PoseShape, (*place, "pickups", exit))
        return {}
    reader = PoseReader(document=document, cell=str(place[1]), model=kind.name, joints=kind.joints)
    home = reader.home((*place, "home"))
    by_exit = pickups(reader, place, routes)
    pickup = default_pickup(reader, place)
    if pickup is None and by_exit and not document.has((*place, "pickup")):
        pickup = by_exit[0][1]
    stations = rack.stations(reader, _section(document, place, "stations"), home)
    section = _section(document, place, "palletizing", needed=False)
    palletizing = rack.palletizing(reader, section, pickup, by_exit or (), stations)
    whole = home and pickup and by_exit is not None and stations and palletizing
    poses = {"home": home, "pickup": pickup, "stations": stations, "palletizing": palletizing}
    return {**poses, "pickups": by_exit} if whole else {}


def _section(document: Document, place: Place, key: str, *, needed: bool = True) -> Place:
    """The place of this section for a cell: its own, else the one at the top that cells share."""
    if document.has((*place, key)):
        return (*place, key)
    if needed and not document.has((key,)) and document.has(place):
        document.problem(place, f'the key "{key}" is missing, here and at the top of the file')
    return (key,)


def _check_sections(document: Document) -> None:
    cells = [(*CELLS, name) for name in document.keys(CELLS)]
    names = [place[-1] for place in cells if not is_of_devices(document, place)]
    for key in SHARED:
        unused = all(document.has(("cells", name, key)) for name in names)
        if cells and unused and document.has((key,)):
            why = "every cell has its own" if names else "no cell has an arm and a mobile robot"
            document.problem((key,), f"{why}, so this section has no effect; delete it")
