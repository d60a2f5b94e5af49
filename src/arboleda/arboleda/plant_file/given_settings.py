"""Settings in a plant file, as a package or a file of Python declares them by a dataclass."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import EntryPoint
from typing import Any

from pydantic.errors import PydanticSchemaGenerationError

from arboleda.model.outside import plain

from . import settings
from .document import Document, Place
from .python_uses import LONGEST, PythonUses, SourceSpot, error_text, refused
from .robot_models import Shape

FAULTY = object()
"""Stands for settings with problems, which are kept."""


@dataclass(frozen=True, kw_only=True)
class Taker:
    """Taker of settings: `what` it is, as `driver`, its name, and the dataclass, None for one without.

    `form` is what to write where there are none, by a key that is missing. `wrong` keeps a problem of the
    dataclass.
    """

    what: str
    name: str
    settings: type | None
    form: Callable[[str], str] = str
    wrong: Callable[[str], None]


def given(document: Document, place: Place, taker: Taker) -> Any:
    """The settings at `place`, all defaults where no mapping is there; FAULTY, with the problems kept."""
    whom = f"the {taker.what} {taker.name}"
    has = document.has(place) and not isinstance(document.value(place), str)
    if taker.settings is None:
        if has and document.value(place):
            document.problem(place, f"{whom} has no settings")
            return FAULTY
        return None
    fits = _shape(taker, taker.settings)
    if fits is None:
        return FAULTY
    if not has and (missing := required(fits)):
        keys = ", ".join(missing)
        document.problem(place, f"{whom} needs {keys}; write {taker.form(missing[0])}")
        return FAULTY
    try:
        if not has:
            return taker.settings(**dict(fits()))
        read = settings.read(document, place, fits, taker.settings)
    except settings.SettingsRefused as unfit:
        document.problem(unfit.place, plain(refused(unfit.error), LONGEST))
        return FAULTY
    except Exception as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        document.problem(place, plain(refused(error), LONGEST))
        return FAULTY
    return FAULTY if read is None else read


def required(fits: type[Shape]) -> list[str]:
    """The keys of a shape that have no default."""
    return [name for name, field in fits.model_fields.items() if field.is_required()]


def loaded(document: Document, place: Place, point: EntryPoint, used: PythonUses) -> Any:
    """The object of an entry point; FAULTY, with the problem kept at `place`, where it cannot be imported."""
    used.watch(SourceSpot(file=point.value), "importing this")
    try:
        return point.load()
    except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        document.problem(place, plain(f"{point.value} cannot be imported: {error_text(error)}", LONGEST))
        return FAULTY


def _shape(taker: Taker, declared: type) -> type[Shape] | None:
    """The shape of the mapping; None, with the problem kept, where no plant file can give it."""
    try:
        return settings.shape(f"{taker.what.capitalize()}_{taker.name}", declared)
    except PydanticSchemaGenerationError:
        what = f"the settings of {taker.name} have a type that no plant file can give"
        taker.wrong(f"{what}; it can {settings.TYPES}")
    except Exception as error:  # noqa: BLE001 - annotations are user code, and may be of anything
        taker.wrong(f"the settings of {taker.name}: {error_text(error)}")
    return None
