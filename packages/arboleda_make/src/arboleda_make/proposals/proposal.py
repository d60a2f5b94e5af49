"""Proposal of an assistant: named, immutable content of a plant's files with one hash over all of it.

No file is read or written here. The words of the assistant stand beside the content, and are no part of it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from typing import Any

from arboleda.extension import ConfigError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.document import Place
from arboleda.plant_file.versions import Version
from arboleda.plant_file.yaml_edit import EditRefused
from arboleda.plant_file.yaml_marks import parse

from ..drafts.draft import Draft

FORMAT = 1
CELLS, KINDS, TARGETS, DEVICES = "cells", "kinds", "targets", "devices"
MAY = "an assistant proposes trees, targets, new devices of a cell and new kinds; {place} is for people"
THERE = "{place} is there already; what it is, people change"
NO_PROPOSAL = "it is no proposal that could be read: {error}"


@dataclass(frozen=True, kw_only=True)
class ProposedChanges:
    """Changes that an assistant proposes: texts of `trees` by file, None for one that goes; values of the
    plant file by place; places that go."""

    trees: Mapping[str, str | None]
    values: Sequence[tuple[Place, Any]]
    removed: Sequence[Place]


@dataclass(frozen=True, kw_only=True)
class Proposal:
    """Proposal: the files as they would become, for the version with the digest `base` and for no other.

    `recipes` are those of which the assistant asks to give tasks. `others` has a digest of each file that
    cannot be proposed, such as Python. `changes` and `warnings` are what the plant said of it.
    """

    name: str
    by: str
    words: str
    at: str
    base: str
    files: PlantFiles
    others: Mapping[str, str]
    recipes: tuple[str, ...]
    changes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def hash(self) -> str:
        """The hash over all that would be approved: plant file, trees, the other files, recipes, version."""
        contents = {name: sha256(each).hexdigest() for name, each in self.files.contents.items()}
        whole = [FORMAT, self.base, self.files.plant, contents, dict(self.others), sorted(self.recipes)]
        return sha256(json.dumps(whole, sort_keys=True).encode()).hexdigest()

    @property
    def content(self) -> str:
        """The digest of the version that it would become."""
        return Version(number=0, at="", files=self.files, others=self.others).digest

    def data(self) -> dict[str, Any]:
        """The proposal as plain data, of which `from_data` makes it again."""
        texts = {name: each.decode("utf-8", "surrogateescape") for name, each in self.files.contents.items()}
        return {
            "format": FORMAT,
            "hash": self.hash,
            **{name: getattr(self, name) for name in ("name", "by", "words", "at", "base")},
            "plant": self.files.plant,
            "files": texts,
            "others": dict(self.others),
            **{name: list(getattr(self, name)) for name in ("recipes", "changes", "warnings")},
        }


def from_data(data: Mapping[str, Any]) -> Proposal:
    """The proposal of plain data; ConfigError where it is none, or is not what its hash was made of."""
    try:
        files = {
            str(name): str(text).encode("utf-8", "surrogateescape") for name, text in data["files"].items()
        }
        found = Proposal(
            name=str(data["name"]),
            by=str(data["by"]),
            words=str(data["words"]),
            at=str(data["at"]),
            base=str(data["base"]),
            files=PlantFiles(plant=str(data["plant"]), contents=files),
            others={str(name): str(each) for name, each in data["others"].items()},
            recipes=tuple(map(str, data["recipes"])),
            changes=tuple(map(str, data["changes"])),
            warnings=tuple(map(str, data["warnings"])),
        )
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise ConfigError((NO_PROPOSAL.format(error=f"{type(error).__name__}: {error}"),)) from error
    if found.hash != data.get("hash"):
        raise ConfigError((NO_PROPOSAL.format(error="its hash is that of other content"),))
    return found


def proposed(draft: Draft, changes: ProposedChanges) -> Draft:
    """The draft with the changes of an assistant; EditRefused for what is not for assistants to change."""
    known = parse(draft.base.contents[draft.base.plant])[0].value
    for place, _ in changes.values:
        _check_place(place, known, sets=True)
    for place in changes.removed:
        _check_place(place, known, sets=False)
    for file, text in changes.trees.items():
        draft = draft.without_recipe(file) if text is None else draft.with_recipe(file, text.encode())
    draft = draft.with_values(changes.values) if changes.values else draft
    for place in changes.removed:
        draft = draft.without(place)
    return draft


def readable(files: PlantFiles) -> dict[str, Any]:
    """Targets, kinds of devices and texts of trees: what assistants read of a plant's files. Settings of
    drivers stay with people, as there may be a password in them."""
    root = parse(files.contents[files.plant])[0].value
    root = root if isinstance(root, dict) else {}
    cells = root.get(CELLS)
    trees = {
        name: each.decode("utf-8", "replace") for name, each in files.contents.items() if name != files.plant
    }
    rows = {name: _cell(each) for name, each in (cells if isinstance(cells, dict) else {}).items()}
    return {"cells": rows, "kinds": root.get(KINDS) or {}, "trees": trees}


def _cell(cell: Any) -> dict[str, Any]:
    found = cell if isinstance(cell, dict) else {}
    devices = found.get(DEVICES)
    kinds = {
        role: each.get("kind") if isinstance(each, dict) else each
        for role, each in (devices if isinstance(devices, dict) else {}).items()
    }
    return {TARGETS: found.get(TARGETS) or {}, DEVICES: kinds}


def _check_place(place: Place, known: Any, *, sets: bool) -> None:
    """Raise EditRefused for a place that people alone write."""
    is_of_cell = len(place) >= 4 and place[0] == CELLS
    if is_of_cell and place[2] == TARGETS:
        return
    new = place[:4] if is_of_cell and place[2] == DEVICES else place[:2] if place[0] == KINDS else ()
    written = ".".join(map(str, place))
    if not sets or len(new) < 2:
        raise EditRefused(MAY.format(place=written))
    if _is_there(new, known):
        raise EditRefused(THERE.format(place=".".join(map(str, new))))


def _is_there(place: Place, known: Any) -> bool:
    for key in place:
        if not isinstance(known, dict) or key not in known:
            return False
        known = known[key]
    return True
