"""Routes that look at the plant, a module each: a path, what it takes and gives, what it asks for."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from fastapi import APIRouter

from ..plant_api import PlantApi


def routers(side: PlantApi) -> list[APIRouter]:
    """The routers that the modules of this folder register."""
    names = sorted(each.name for each in iter_modules(__path__))
    return [import_module(f"{__name__}.{name}").routes(side) for name in names]
