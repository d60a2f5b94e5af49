"""A plant file with all files that it names -> PlantModel, or all problems at once."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from arboleda.drivers.port import DriverSpec
from arboleda.model.assistants import Assistants
from arboleda.model.common_places import with_common_outputs
from arboleda.model.errors import ConfigError
from arboleda.model.orders import MOST, combinations
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import Cell, ForeignCommands, MqttVersion, PlantModel, Robot
from arboleda.model.recipe import Recipe
from arboleda.model.recording import Recording

from . import drivers, extensions, own_kinds, sections, user_file
from .brought import by_packages
from .deadlines import check_arrivals_show
from .declared_kinds import kinds
from .devices import CELLS, Kinds, device_cell, is_of_devices, shared_devices
from .document import Document, Place
from .name_check import check_names
from .python_uses import PythonUses
from .recipe_trial import brought
from .shapes import FileShape
from .shared import check_homes
from .shipped import SHIPPED, shipped
from .storage_form import check_sections, storage_cell
from .urdf import own_description
from .yaml_marks import LARGEST
from .zones import with_zones, zones

Offers = Callable[[Sequence[Cell]], Mapping[str, tuple[Recipe, ...]]]
Misses = Mapping[str, Mapping[str, str]]


def load(path: Path | None = None, *, recipes: bool = True, apart: bool = True) -> PlantModel:
    """The plant that the file describes, None for the shipped one; ConfigError with every problem.

    Without `recipes` no Python is run: cells of devices offer nothing, and a plant with devices of kinds in
    Python has no cells. Without `apart` the plant's Python is tried in this process. That is far quicker, but
    nothing ends Python that never comes back.
    """
    return _parsed(*_content(path), recipes=recipes, apart=apart).plant


def load_with_offers(path: Path | None = None) -> tuple[PlantModel, Misses]:
    """The plant of the file, and by cell and recipe why the cell does not offer that recipe of a file."""
    parsed = _parsed(*_content(path), recipes=True)
    return parsed.plant, parsed.missed


def load_with_drivers(path: Path | None = None) -> tuple[PlantModel, Mapping[str, DriverSpec]]:
    """The plant of the file, and by name the drivers that files beside it bring."""
    parsed = _parsed(*_content(path), recipes=True)
    return parsed.plant, parsed.drivers


def load_recorded(path: Path | None = None) -> tuple[PlantModel, Recording | None]:
    """The plant of the file, and the beginning of its record; None where the file says `record: off`."""
    plant, document, *_ = _parsed(*_content(path), recipes=True)
    return plant, sections.recording(document, _files(document))


def load_with_files(
    path: Path | None = None, *, runs: bool = False, apart: bool = True
) -> tuple[PlantModel, PlantFiles]:
    """The plant of the file, and all files that were read for it; `apart` as in `load`.

    With `runs` the plant runs in this process. Python that the plant has imported is not run again; a file of
    Python that was changed since is a problem.
    """
    plant, document, *_ = _parsed(*_content(path), recipes=True, runs=runs, apart=apart)
    return plant, _files(document)


def parse(name: str, content: bytes, folder: Path | None = None, *, recipes: bool = True) -> PlantModel:
    """The plant of a plant file's content. Problems call it `name`; `folder` has the files beside it."""
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
        plant = drivers.with_drivers(document, plant_of(document, code.used, code.offered), code.used)
        plant = extensions.with_extensions(document, plant, code.used)
    elif own_kinds.needs_python(document):
        plant = _named(document)
    else:
        plant = plant_of(document, PythonUses(), _nothing)
    document.finish(document.keys(CELLS))
    if plant is None:
        raise ConfigError((f"{document.name}: the file cannot be read as a plant",))
    plant = replace(plant, brought=by_packages(document))
    return _Reading(plant, document, missed, brings)


def _files(document: Document) -> PlantFiles:
    """All files that were read, under paths from the folder that holds them all."""
    paths = {os.path.normpath(path.absolute()): content for path, content in document.files.items()}
    plant, *_ = paths  # the plant file is read before all others
    folder = os.path.commonpath([os.path.dirname(path) for path in paths])
    names = {path: Path(os.path.relpath(path, folder)).as_posix() for path in paths}
    return PlantFiles(plant=names[plant], contents={names[path]: each for path, each in paths.items()})


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
        offered = ", ".join(each.name for each in cell.recipes) or "no recipe"
        others = "".join(f"; not {name}: {why}" for name, why in missed.get(cell.name, {}).items())
        lines.setdefault(f"{offered}{others}", []).append(cell.name)
    return tuple(f"{', '.join(names)}: {line}" for line, names in lines.items())


def _nothing(cells: Sequence[Cell]) -> dict[str, tuple[Recipe, ...]]:
    return {}


def _named(document: Document) -> PlantModel | None:
    shape = document.read(FileShape)
    return None if shape is None else PlantModel(name=shape.name, cells=())


def plant_of(document: Document, used: PythonUses, recipes: Offers) -> PlantModel | None:
    """The plant of a document, with the recipes that its cells offer; None where it is none."""
    shape = document.read(FileShape)
    own_kinds.complete(document, used)
    device_kinds = Kinds(declared=kinds(document), names=document.keys(("kinds",)), used=used)
    common = shared_devices(document, device_kinds)
    cells = [_cell(document, name, device_kinds, common) for name in document.keys(("cells",))]
    timing = sections.timing(document)
    check_names(document, partial(device_kinds.has_twin, document))
    of_form = [(*CELLS, name) for name in document.keys(CELLS)]
    check_sections(document, [place for place in of_form if not is_of_devices(document, place)])
    whole = [cell for cell in cells if cell is not None]
    regions = zones(document, whole)
    sections.check_ports(document, shape)
    check_homes(document, whole)
    in_zones = [with_zones(document, cell, regions) for cell in whole]
    zoned = {cell.name: cell for cell in with_common_outputs(in_zones)}
    offers = recipes(list(zoned.values()))
    if timing is None:
        return None
    sections.record_limits(document)
    limits = sections.assistant_limits(document)
    check_arrivals_show(document, whole, timing)
    if shape is None or len(whole) < len(cells):
        return None
    return PlantModel(
        name=shape.name,
        cells=tuple(
            replace(cell, recipes=(*cell.recipes, *offers.get(cell.name, ()))) for cell in zoned.values()
        ),
        timing=timing,
        mqtt_version=MqttVersion(shape.mqtt_version),
        zones=tuple(region.name for region in regions),
        foreign_commands=ForeignCommands(shape.foreign_commands),
        history_days=shape.history_days,
        groot2_port=shape.groot2 or None,
        opcua_view=sections.opcua_view(document),
        store=sections.store_address(document, shape.store),
        assistants=Assistants(shape.assistants),
        assistant_limits=limits,
    )


def _cell(document: Document, name: str, kinds: Kinds, common: Mapping[str, Robot]) -> Cell | None:
    place: Place = (*CELLS, name)
    if is_of_devices(document, place):
        return device_cell(document, place, kinds, common)
    return storage_cell(document, place)
