"""One difference between two sets of a plant's files: as data, and in words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from arboleda.plant_file.document import Place, dotted
from arboleda.plant_file.yaml_flow import flow
from arboleda.plant_file.yaml_marks import clipped

LONGEST = 120  # characters of a value
CELLS, DEVICES, KINDS, TARGETS = "cells", "devices", "kinds", "targets"
FACTS, VERBS = "facts", "verbs"
OF_ONE = {CELLS: "cell", KINDS: "kind", "zones": "zone", "shared": "shared device"}
NOTHING = "nothing"  # an empty value


@dataclass(frozen=True, kw_only=True)
class Missing:
    """The value of a key that a file does not have, other than an empty value."""


MISSING = Missing()


@dataclass(frozen=True, kw_only=True)
class Change:
    """One difference: in the plant file's value at `place`, in a tree of `file`, or in a whole file.

    `before` and `after` are plain values, MISSING where there is none. For a tree or a whole file that is
    there, they are None. `verbs` are those of a new device whose kind the plant file declares.
    """

    file: str
    place: Place = ()
    tree: str = ""
    before: Any
    after: Any
    verbs: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """The change as one line."""
        return self._of_whole or f"{self._what}: {self._how}"

    @property
    def is_device(self) -> bool:
        """True for a whole device of a cell."""
        return len(self.place) == 4 and (self.place[0], self.place[2]) == (CELLS, DEVICES)

    @property
    def _of_whole(self) -> str:
        """The line for a cell, a device or a kind that is new or gone; "" for another change."""
        if self.after is MISSING:
            return self._gone
        return self._new(self.after) if self.before is MISSING and isinstance(self.after, dict) else ""

    @property
    def _gone(self) -> str:
        if self.is_device:
            _, cell, _, role = self.place
            return f"device {role} of {cell} is gone"
        section, *name = self.place or ("",)
        if len(name) != 1 or section not in (CELLS, KINDS):
            return ""
        return f"cell {name[0]} is gone" if section == CELLS else f"kind {name[0]} is gone"

    def _new(self, value: dict[Any, Any]) -> str:
        if self.is_device:
            return self._new_device(value)
        section, *name = self.place or ("",)
        if len(name) != 1 or section not in (CELLS, KINDS):
            return ""
        if section == CELLS:
            devices = _names(value, DEVICES)
            return f"new cell {name[0]} with {devices}" if devices else f"new cell {name[0]}"
        facts, verbs = _names(value, FACTS), _names(value, VERBS)
        says = "; ".join([*([f"says {facts}"] if facts else []), *([f"does {verbs}"] if verbs else [])])
        return f"new kind {name[0]}: {says}" if says else f"new kind {name[0]}"

    def _new_device(self, device: dict[Any, Any]) -> str:
        _, cell, _, role = self.place
        kind = str(device.get("kind") or device.get("shared", "?"))
        line = f"new device {role} of {cell}: {kind}"
        if self.verbs:
            line = f"new device {role} of {cell}: {kind} with {', '.join(self.verbs)}"
        driver = device.get("driver")
        name = next(iter(driver), "") if isinstance(driver, dict) else driver
        return f"{line}, reached by {name}" if name else line

    @property
    def _what(self) -> str:
        place = [*map(str, self.place)]
        if not place:
            return f"{self.file}, tree {self.tree}" if self.tree else self.file
        if len(place) == 5 and (place[0], place[2]) == (CELLS, TARGETS):
            return f"cell {place[1]}, target {place[3]} of {place[4]}"
        if len(place) > 4 and (place[0], place[2]) == (CELLS, DEVICES):
            return f"cell {place[1]}, {dotted(self.place[4:])} of {place[3]}"
        one = OF_ONE.get(place[0])
        if one is None or len(place) < 2:
            return dotted(self.place)
        inside = self.place[3:] if one == OF_ONE[KINDS] and len(place) > 3 else self.place[2:]
        return f"{one} {place[1]}, {dotted(inside)}" if inside else f"{one} {place[1]}"

    @property
    def _how(self) -> str:
        if self.before is MISSING:
            return "new" if self.after is None else f"new, {_short(self.after)}"
        if self.after is MISSING:
            return "gone" if self.before is None else f"gone, it was {_short(self.before)}"
        if self.before is None and self.after is None:
            return "changed"
        more, less = _added(self.before, self.after), _added(self.after, self.before)
        if more:
            return f"new, {_short(more)}"
        if less:
            return f"gone, {_short(less)}"
        return f"from {_short(self.before)} to {_short(self.after)}"


def _added(value: Any, longer: Any) -> list[Any]:
    """The entries that a longer list adds to a list whose entries and their order it keeps; else none."""
    if not isinstance(value, list) or not isinstance(longer, list):
        return []
    is_kept = [each for each in longer if each in value] == value
    return [each for each in longer if each not in value] if is_kept else []


def _names(value: dict[Any, Any], key: str) -> str:
    """The names under a key; "" where there is none."""
    names = value.get(key)
    return ", ".join(map(str, names)) if isinstance(names, dict) else ""


def _short(value: Any) -> str:
    text = _as_words(value)
    return text if len(text) <= LONGEST else f"{clipped(text)} ({len(text)} characters)"


def _as_words(value: Any, *, inside: bool = False) -> str:
    """A value without the signs of YAML: `deg (10, -5.5), mm 0`; `supply` for `supply: true`."""
    if isinstance(value, dict):
        words = [
            f"{key}" if _says_no_more(each) else f"{key} {_as_words(each, inside=True)}"
            for key, each in value.items()
        ]
    elif isinstance(value, list):
        words = [_as_words(each, inside=True) for each in value]
    else:
        return value if isinstance(value, str) and value else flow(value)
    text = ", ".join(words) or NOTHING
    return f"({text})" if inside else text


def _says_no_more(value: Any) -> bool:
    """True for a value that adds nothing to its key."""
    return value is True or value is None or value == {}
