"""Devices of kinds in Python, which files that the plant file uses have, or installed packages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib.metadata import EntryPoint
from typing import Any

from pydantic.errors import PydanticSchemaGenerationError

from arboleda.host.packages import entry_points
from arboleda.kinds import KindError, WrittenKind
from arboleda.kinds.declared import DeviceKind
from arboleda.model.errors import ArboledaError
from arboleda.model.outside import plain, quoted
from arboleda.model.plant_model import Robot
from arboleda.wire import mqtt_limits

from .declared_kinds import OF_FACTS, OF_STEPS, name_objection
from .document import Document, Place, shown
from .moving_kinds import as_read
from .python_uses import LONGEST, KindInPython, PythonUses, SourceSpot, error_text, refused
from .robot_kind import RobotKind
from .settings import TYPES, settings_of_kind, shape_of_kind
from .shapes import DeviceShape
from .shared import SECTION
from .shipped_kinds import COME_WITH_IT, IN_PYTHON, RESERVED

GROUP = "arboleda.kinds"
CLASH = "{} is a key of every device; give the field another name"


def registered() -> dict[str, list[EntryPoint]]:
    """The kinds that installed packages register, by name."""
    entries: dict[str, list[EntryPoint]] = {}
    for each in entry_points(group=GROUP):
        entries.setdefault(each.name, []).append(each)
    return entries


def needs_python(document: Document) -> bool:
    """True if a device may be of a kind of a file that is used, or of an installed package."""
    names = {name for name, _ in named(document)}
    uses = document.has(("uses",)) and not names <= COME_WITH_IT.keys()
    return uses or (bool(names) and not names.isdisjoint(registered()))


def complete(document: Document, used: PythonUses) -> None:
    """Add the kinds that devices name and that Arboleda or an installed package has."""
    entries = registered() if any(name not in used.kinds for name, _ in named(document)) else {}
    for name, place in named(document):
        rows = entries.get(name, [])
        if name in used.kinds or not (rows or name in COME_WITH_IT):
            continue
        if name in COME_WITH_IT and not rows:
            used.kinds[name] = COME_WITH_IT[name]
        elif used.may_import and (kind := _installed(document, place, rows, used)):
            used.kinds[name] = kind
        else:
            used.broken.add(name)
    used.installed = tuple(entries)


def robot(document: Document, place: Place, kind: RobotKind, used: PythonUses) -> Robot | None:
    """The device that its kind reads; None, with the problems kept, if something is wrong with it."""
    if kind is COME_WITH_IT.get(kind.name):
        return kind.read(document, place)
    used.watch(used.spot(kind), f"making {kind.name} for {place[-1]}")
    try:
        device = kind.read(document, place)
    except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        _tell(document, place, kind, error, used)
        return None
    if device is None or isinstance(device, Robot):
        return device
    what = f"{kind.name} reads {quoted(device)}; a kind that reads by itself makes a Robot"
    _keep(document, place, used.spot(kind), what, used)
    return None


def device(
    document: Document, place: Place, kind: WrittenKind, used: PythonUses
) -> tuple[DeviceShape, DeviceKind] | None:
    """The keys of a device, and its kind made with its settings; None, with the problems kept, if wrong."""
    spot = used.spot(kind)
    used.watch(spot, f"making {kind.name} for {place[-1]}")
    try:
        shape = document.read(shape_of_kind(kind, DeviceShape, CLASH), place)
    except PydanticSchemaGenerationError:
        what = f"the settings of {kind.name} have a type that no plant file can give"
        used.keep(document, spot.problem(f"{what}; it can {TYPES}"))
        return None
    except Exception as error:  # noqa: BLE001 - annotations are user code, and may be of anything
        used.keep(document, spot.problem(f"the settings of {kind.name} cannot be read: {error_text(error)}"))
        return None
    settings = None if shape is None else _settings(document, place, kind, shape, used)
    if shape is None or (settings is None and kind.settings is not None):
        return None
    try:
        made = kind.of(settings)
    except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        _tell(document, place, kind, error, used)
        return None
    wrong = next(_unusable(made), None)
    if wrong is not None:
        _keep(document, place, spot, f"{kind.name}: {wrong}", used)
    return None if wrong is not None else (shape, made)


def named(document: Document) -> Iterator[tuple[str, Place]]:
    """The kinds that devices name and that the plant file does not declare, with their places."""
    declared = document.keys(("kinds",))
    sections: list[Place] = [("cells", cell, "devices") for cell in document.keys(("cells",))]
    for section in [*sections, (SECTION,)]:
        for role in document.keys(section):
            place = (*section, role, "kind")
            name = document.value(place)
            if isinstance(name, str) and (name not in declared or name in RESERVED):
                yield name, place


def _installed(
    document: Document, place: Place, rows: list[EntryPoint], used: PythonUses
) -> KindInPython | None:
    name, packages = rows[0].name, [_package(each) for each in rows]
    if name in COME_WITH_IT:
        owner = f"comes with Arboleda, and {' and '.join(packages)} registers another one"
        document.problem(place, f"the kind {shown(name)} {owner}; uninstall that, or rename its kind")
        return None
    if len(rows) > 1:
        document.problem(place, f"{' and '.join(packages)} both register a kind {shown(name)}; uninstall one")
        return None
    used.watch(SourceSpot(file=rows[0].module), f"importing the kind {name}")
    try:
        kind = rows[0].load()
    except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        what = f"the kind {shown(name)} of {packages[0]} cannot be imported: {error_text(error)}"
        document.problem(place, plain(what, LONGEST))
        return None
    if not isinstance(kind, IN_PYTHON) or kind.name != name:
        what = f"{packages[0]} registers {rows[0].value} as a kind {shown(name)}"
        rule = f'and that is none; one is a function with @kind("{name}") before it'
        document.problem(place, plain(f"{what}, {rule}", LONGEST))
        return None
    read = as_read(kind)
    file = used.spot(read).file
    used.files[file] = file
    return read


def _package(entry: EntryPoint) -> str:
    """The package of an entry point, as a sentence names it."""
    return f"{entry.dist.name} {entry.dist.version}" if entry.dist else entry.module


def _settings(
    document: Document, place: Place, kind: WrittenKind, shape: DeviceShape, used: PythonUses
) -> Any:
    """The settings of a device; None, with the problem kept, if the kind's own rules refuse them."""
    try:
        return settings_of_kind(kind, shape)
    except (ValueError, ArboledaError) as error:
        document.problem(place, plain(refused(error), LONGEST))
    except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        _tell(document, place, kind, error, used)
    return None


def _tell(
    document: Document, place: Place, kind: KindInPython, error: BaseException, used: PythonUses
) -> None:
    """Keep the error that a kind raised, at its line; at the device where no file of a user has that line."""
    spot = used.where(error.__cause__ or error, used.where(error, used.spot(kind)))
    what = f"{kind.name}: {error}" if isinstance(error, KindError) else f"{kind.name}: {error_text(error)}"
    _keep(document, place, spot, what, used)


def _keep(document: Document, place: Place, spot: SourceSpot, what: str, used: PythonUses) -> None:
    if spot.file in used.files.values():
        used.keep(document, spot.problem(what))
    else:
        document.problem(place, plain(what, LONGEST))


def _unusable(kind: DeviceKind) -> Iterator[str]:
    """The objections to a kind: names that no recipe can use, and messages that MQTT cannot carry."""
    yield from _misnamed(kind)
    yield from (each.sentence for each in mqtt_limits.objections(kind))


def _misnamed(kind: DeviceKind) -> Iterator[str]:
    rows: list[tuple[str, str, Sequence[str]]] = [(name, "a fact", OF_FACTS) for name in kind.facts]
    rows += [(name, "a verb", OF_STEPS) for name in kind.verbs]
    rows += [(name, "a parameter", ("self",)) for verb in kind.verbs.values() for name, _ in verb.parameters]
    for name, what, taken in rows:
        objection = name_objection(name, what, taken)
        if objection is not None:
            yield objection
