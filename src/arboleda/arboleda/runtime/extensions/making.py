"""Parts of packages, made where a plant starts: each with the plant as it may see it."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from importlib.metadata import EntryPoint
from pathlib import Path

from arboleda.host.packages import package_of
from arboleda.host.pieces import naming, piece_of
from arboleda.plant_file.extensions import settings_of
from arboleda.store.package_table import PackageTable
from arboleda.web.part_routes import PartRoute, PartRoutes

from ..parts.local_plant import LocalPlant
from ..parts.orchestrator import Orchestrator
from ..parts.part import Part as Started
from ..registry import OF_RUNNER, Assembly, Factory, NameTaken, Phase
from .alarms import PackageAlarms
from .chapters import Chapters
from .part import Part
from .plant import Plant, Uses
from .questions import Questions
from .table import Table, Writes
from .telling import Telling

FOLDER = "extensions"  # in the state directory


def factory_of(made_by: type[Part], point: EntryPoint) -> Factory:
    """The factory of a part that a package registers as a class."""
    make = partial(_make, made_by, point)
    return Factory(phase=Phase.RECORD, make=make, what=_called(made_by))


def _make(made_by: type[Part], point: EntryPoint, assembly: Assembly) -> Iterator[Started]:
    """The part, then what tells it of the plant, which ends before it."""
    running = assembly.ask(Orchestrator)
    if running is None:  # a process without the plant, as a node of boards
        return
    if point.name in OF_RUNNER:
        raise NameTaken(f"Arboleda itself shows {point.name} on the page: register it under another name")
    telling = Telling(point.name, assembly.pieces, partial(piece_of, point))
    writes, memory = _writes(assembly, running), assembly.holdings.memory
    plant = Plant(
        point.name,
        Uses(
            package=package_of(point),
            side=assembly.need(LocalPlant),
            telling=telling,
            alarms=assembly.need(PackageAlarms),
            questions=assembly.need(Questions),
            chapters=assembly.need(Chapters),
            tell_tasks=running.listeners.append,
            tell_views=running.screens.watchers.append,
            table=lambda name: Table(PackageTable(memory, name), writes),
            folder=partial(_folder, assembly.holdings.state.path, point.name),
        ),
    )
    declared = made_by.settings_type
    part = made_by(plant, declared and settings_of(assembly.model, package_of(point), declared))
    piece = piece_of(point, _called(made_by))
    assembly.offer(made_by, part)
    assembly.links.add(lambda: {point.name: plant.shown} if plant.shown else {})
    _routes(assembly).append(PartRoute(point, piece, part.routes))
    for end in (
        telling.leave,
        partial(assembly.need(PackageAlarms).end_all, point.name),
        partial(assembly.need(Questions).take_back, point.name),
    ):
        assembly.pieces.take_along(piece, end)
    yield part
    yield telling
    yield assembly.need(Questions)  # ends first: a part may wait for an answer


def _called(made_by: type[Part]) -> str:
    return f"the part {made_by.__name__}"


def _writes(assembly: Assembly, running: Orchestrator) -> Writes:
    """The writes of all packages, which the thread of the plant makes."""
    writes = assembly.ask(Writes)
    if writes is None:
        writes = Writes(running.loop.wake, lambda: running.loop.running)
        with naming(None):  # it is of all packages, and the factory of one is at work
            running.observers.append(writes.flush)
        assembly.offer(Writes, writes)
    return writes


def _routes(assembly: Assembly) -> PartRoutes:
    routes = assembly.ask(PartRoutes)
    if routes is None:
        routes = PartRoutes()
        assembly.offer(PartRoutes, routes)
    return routes


def _folder(state: Path, name: str) -> Path:
    folder = state / FOLDER / name
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    return folder
