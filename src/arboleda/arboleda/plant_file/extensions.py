"""`extensions` of a plant file: settings of installed packages, and which of these the plant leaves out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from importlib.metadata import EntryPoint
from typing import Any

from arboleda.host.distributions import APIS
from arboleda.host.packages import entry_points, package_of, registered, why_left_out
from arboleda.host.pieces import THE_PAGE, THE_PARTS, Pieces, piece_of
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import PlantModel

from .document import Document, Place, choice, nearest, shown
from .given_settings import FAULTY, Taker, given, loaded, required
from .not_installed import why_nobody
from .python_uses import PythonUses, error_text
from .settings import shape

SECTION = "extensions"
PARTS, PAGE = "arboleda.parts", "arboleda.page"
OF_A_PLANT = (PARTS, PAGE, "arboleda.routes")  # what a plant can leave out
OFF = ("off", False)
NOBODY = "no installed package is called {name}{nearest}; there are {known}"
FORM = "must be off, or a mapping of its settings, is {value}"
OTHERS = (
    "the plant file gives {name} other settings than {wanted}: one class of settings is for all its parts"
)
NEEDS = "the plant file gives {name} no {keys}; write extensions: {given}"


def named(document: Document) -> Iterator[str]:
    """The packages that the file gives settings."""
    for name in document.keys((SECTION,)):
        if document.value((SECTION, name)) not in OFF:
            yield name


def with_extensions(document: Document, plant: PlantModel | None, used: PythonUses) -> PlantModel | None:
    """The plant with the settings of packages; where there is any problem, the plant as it is."""
    if plant is None or any(document.problems) or not document.has((SECTION,)):
        return plant
    names = document.keys((SECTION,))
    off = frozenset(names).difference(named(document))
    return replace(plant, extensions=settings_given(document, used), extensions_off=off)


def settings_given(document: Document, used: PythonUses) -> dict[str, object]:
    """The settings of each package that has some and that is named; problems are kept."""
    value = document.value((SECTION,))
    if document.has((SECTION,)) and not isinstance(value, dict):
        document.problem((SECTION,), f"must be a mapping (key: value), is {shown(value)}")
    known = sorted({package_of(point) for group in OF_A_PLANT for point in registered(group)})
    for name in document.keys((SECTION,)):
        if name not in known and not why_left_out(PARTS, name):
            _nobody(document, name, known)
    read = {name: _settings(document, name, used) for name in named(document) if name in known}
    return {name: each for name, each in read.items() if each is not None and each is not FAULTY}


def settings_of(plant: PlantModel, name: str, declared: type) -> Any:
    """The settings of a package in a plant, as the package has declared them; ArboledaError, which says what
    to write, where the plant file lacks some that it needs.
    """
    if name in plant.extensions:
        found = plant.extensions[name]
        if not isinstance(found, declared):
            raise ArboledaError(OTHERS.format(name=name, wanted=declared.__name__))
        return found
    fits = shape(f"Extension_{name}", declared)
    if missing := required(fits):
        form = f"{{{name}: {{{missing[0]}: ...}}}}"
        raise ArboledaError(NEEDS.format(name=name, keys=", ".join(missing), given=form))
    return declared(**dict(fits()))


def notes(plant: PlantModel) -> list[str]:
    """A line for each piece of packages that the plant goes on without: a part that lacks settings, what is
    wrong on a page, and what breaks when it is loaded."""
    pieces = Pieces(error_text, tell=lambda _: None, off=plant.extensions_off)
    of_the_door = {_distribution(each) for each in entry_points(APIS)}
    for point in pieces.registered(PARTS):
        with pieces.calling(piece_of(point, THE_PARTS)):
            declared = _distribution(point) in of_the_door and getattr(point.load(), "settings_type", None)
            if declared:
                settings_of(plant, package_of(point), declared)
    for point in pieces.registered(PAGE):
        if _distribution(point) in of_the_door:
            # it takes long to load, and few packages have one
            from arboleda.dashboard.package_page.page import page_part

            with pieces.calling(piece_of(point, THE_PAGE)):
                page_part(point, pieces)
    return pieces.notes


def _distribution(point: EntryPoint) -> str:
    """The name of the distribution of an entry point; each reading of packages has other objects of it."""
    return "" if point.dist is None else point.dist.name


def _nobody(document: Document, name: str, known: list[str]) -> None:
    there = choice(known) if known else "none"
    told = NOBODY.format(name=shown(name), nearest=nearest(name, known), known=there)
    told = why_nobody(document, PARTS, name) or told
    document.problem((SECTION,), told, at=(SECTION, name))


def _settings(document: Document, name: str, used: PythonUses) -> Any:
    """The settings of a package; None where it has none; FAULTY, with the problems kept."""
    place: Place = (SECTION, name)
    if not isinstance(document.value(place), dict):
        document.problem(place, FORM.format(value=shown(document.value(place))))
        return FAULTY
    declared = _declared(document, place, used)
    if declared is FAULTY:
        return FAULTY
    wrong = partial(document.problem, place)
    return given(document, place, Taker(what="extension", name=name, settings=declared, wrong=wrong))


def _declared(document: Document, place: Place, used: PythonUses) -> Any:
    """The dataclass of settings that the parts of a package declare; None, or FAULTY, as in `_settings`."""
    for point in registered(PARTS):
        if package_of(point) == place[-1]:
            found = loaded(document, place, point, used)
            declared = found if found is FAULTY else getattr(found, "settings_type", None)
            if declared is not None:
                return declared
    return None
