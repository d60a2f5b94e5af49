"""Plants of tests: their plant files in `plants.yaml` and rows of data in `rows.yaml`, beside the tests; and
kinds, devices and recipes in a line."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from inspect import signature
from pathlib import Path
from typing import Any

import pytest
import yaml

from arboleda.kinds import Kind, Verb
from arboleda.kinds.declared import Device, DeviceKind
from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Evidence, Link, PlantModel
from arboleda.model.recipe import Recipe
from arboleda.plant_file import loader
from arboleda.recipes import Kit, recipe


def plant_text(test: str, name: str) -> str:
    """The plant file of that name: what stands in `plants.yaml` after a line `--- # name`."""
    return _documents(Path(test).with_name("plants.yaml"))[name]


def rows(test: str, name: str, file: str = "rows.yaml") -> Any:
    """The rows of that name in `rows.yaml`: a list, or each by what it is about."""
    return _sections(Path(test).with_name(file))[name]


def changed(text: str, *changes: tuple[str, str]) -> str:
    """The text with something else in each of these places, the first of its kind."""
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def written(folder: Path, plant: str, recipes: str = "", beside: Mapping[str, str] = {}) -> Path:
    """A plant file in the folder, with its `recipes.py` and other files beside it."""
    for name, content in {"recipes.py": recipes, **beside, "plant.yaml": plant}.items():
        if content:
            (folder / name).write_text(content, "utf-8")
    return folder / "plant.yaml"


def read(folder: Path, plant: str, recipes: str = "", beside: Mapping[str, str] = {}) -> PlantModel:
    return loader.load(written(folder, plant, recipes, beside))


def problems_of(file: Path) -> list[str]:
    """What is wrong with a plant: the names of files without that of their folder."""
    with pytest.raises(ConfigError) as refusal:
        loader.load(file)
    return [each.removeprefix(f"{file.parent}/") for each in refusal.value.problems]


def refused(folder: Path, plant: str, recipes: str = "", beside: Mapping[str, str] = {}) -> list[str]:
    """The problems of a plant: in its own file from the line on, in others with their names."""
    found = problems_of(written(folder, plant, recipes, beside))
    return [each.removeprefix("plant.yaml:") for each in found]


def made(name: str, build: Callable[..., Any]) -> Recipe:
    """A recipe of one expression: a function of the cell and, by their roles, of devices of it."""
    roles = [*signature(build).parameters][1:]

    @recipe(name)
    def attempt(cell: Kit):  # type: ignore[no-untyped-def]
        return build(cell, *map(cell.device, roles))

    return attempt


def kind_of(name: str, facts: Mapping[str, object], **verbs: Verb) -> DeviceKind:
    return replace(Kind(facts=facts, verbs=verbs).declared, name=name)


def device_of(kind: DeviceKind, name: str = "", **more: Any) -> Device:
    """A device with a board of its name, which is that of its kind if nothing else is said."""
    name = name or kind.name
    said = {"mqtt": name, "link": Link.MQTT, "evidence": Evidence.IDS, "timeout_s": 5.0, **more}
    return Device(name=name, kind=kind, **said)


@cache
def _documents(file: Path) -> dict[str, str]:
    _, *parts = re.split(r"^--- # (\w+)\n", file.read_text("utf-8"), flags=re.MULTILINE)
    return dict(zip(parts[::2], parts[1::2], strict=True))


@cache
def _sections(file: Path) -> dict[str, Any]:
    found: dict[str, Any] = yaml.safe_load(file.read_text("utf-8"))
    return found
