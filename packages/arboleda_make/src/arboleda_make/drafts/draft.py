"""Draft of a plant's files: changes that nothing runs yet, with undo and redo. No file is read or written."""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from typing import Any

from arboleda.drivers import quoted
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.document import Place
from arboleda.plant_file.recipe_forms import XML
from arboleda.plant_file.yaml_edit import EditRefused, with_value, without
from arboleda.plant_file.yaml_marks import parse
from arboleda_make.versions.change import MISSING, Change
from arboleda_make.versions.changes import changes
from arboleda_trees.bt_xml.markup import LARGEST as LARGEST_TREES

MOST_STEPS = 1000  # that can be undone
MOST_BYTES = 64 * 1024 * 1024  # of all that they keep
MOST_FILES = 50  # of trees
USES = "uses"
KEPT = ".arboleda"  # the folder of versions
Contents = Mapping[str, bytes]


@dataclass(frozen=True, kw_only=True)
class Draft:
    """Draft: the files as they are at work in `base`, as they are meant to become in `files`.

    Each method answers another draft; EditRefused, and nothing is changed, where that cannot be. Plant file
    and trees can be edited, Python never.
    """

    base: PlantFiles
    files: PlantFiles
    past: tuple[Contents, ...] = ()
    future: tuple[Contents, ...] = ()

    def with_value(self, place: Place, value: Any) -> Draft:
        """The draft with a plain value at a place of the plant file, such as `cells.lab.targets.nest`."""
        return self.with_values([(place, value)])

    def with_values(self, values: Iterable[tuple[Place, Any]]) -> Draft:
        """The draft with several values, in one step."""
        text = self._plant_text
        for place, value in values:
            text = with_value(text, place, value)
        return self._with_plant(text)

    def rewritten(self, change: Callable[[Any], Any]) -> Draft:
        """The draft whose plant file has the values that `change` makes of its values; only these are cut."""
        text = self._plant_text
        before = parse(text)[0].value
        for place, value in _differences(before, change(before)):
            text = without(text, place) if value is MISSING else with_value(text, place, value)
        return self._with_plant(text)

    def without(self, place: Place) -> Draft:
        """The draft without a key of the plant file."""
        return self._with_plant(without(self._plant_text, place))

    def with_trees(self, name: str, content: bytes) -> Draft:
        """The draft with another content of a file of trees, or with a new one."""
        check_name(name)
        if len(content) > LARGEST_TREES:
            raise EditRefused(f"{name} would be larger than {LARGEST_TREES // 1024} KiB")
        count = sum(each.endswith(XML) for each in {*self.files.contents, name})
        if count > MOST_FILES:
            raise EditRefused(f"a plant has at most {MOST_FILES} files of trees")
        return self._with(name, content)

    def with_recipe(self, name: str, content: bytes) -> Draft:
        """The same in one step with `uses`, which names the file if the plant does not use it yet."""
        drawn = self.with_trees(name, content)
        known, word = _uses(self._plant_text), self._used_as(name)
        if word in known:
            return drawn
        place, value = ((USES, len(known)), word) if known else ((USES,), [word])
        return self._step(
            {**drawn.files.contents, self.files.plant: with_value(self._plant_text, place, value)}
        )

    def without_recipe(self, name: str) -> Draft:
        """The draft without a file of trees, in one step with `uses`."""
        contents = self.without_trees(name).files.contents
        known, word = _uses(self._plant_text), self._used_as(name)
        if word not in known:
            return self._step(contents)
        place: Place = (USES, known.index(word)) if len(known) > 1 else (USES,)
        return self._step({**contents, self.files.plant: without(self._plant_text, place)})

    def without_trees(self, name: str) -> Draft:
        """The draft without a file of trees; one that is at work stays in its folder, unused."""
        check_name(name)
        if name not in self.files.contents:
            raise EditRefused(f"{quoted(name)} is no file of this plant")
        return self._step({key: each for key, each in self.files.contents.items() if key != name})

    def undo(self) -> Draft:
        """The draft before its last step."""
        if not self.past:
            raise EditRefused("there is nothing to undo")
        *past, before = self.past
        return self._as(before, tuple(past), (self.files.contents, *self.future))

    def redo(self) -> Draft:
        """The draft with the step that was undone last."""
        if not self.future:
            raise EditRefused("there is nothing to redo")
        after, *future = self.future
        return self._as(after, (*self.past, self.files.contents), tuple(future))

    @property
    def changes(self) -> tuple[Change, ...]:
        """The differences from what is at work."""
        return changes(self.base, self.files)

    def _used_as(self, name: str) -> str:
        """The word for a file in `uses`, which counts from the folder of the plant file."""
        return posixpath.relpath(name, PurePosixPath(self.files.plant).parent)

    @property
    def _plant_text(self) -> bytes:
        return self.files.contents[self.files.plant]

    def _with_plant(self, text: bytes) -> Draft:
        """The draft with another plant file; it may use more trees than now at work, no more Python."""
        for word in _uses(text):
            if word not in _uses(self.base.contents[self.base.plant]):
                check_name(word)
        return self._with(self.files.plant, text)

    def _with(self, name: str, content: bytes) -> Draft:
        return self._step({**self.files.contents, name: content})

    def _step(self, contents: Contents) -> Draft:
        """The draft after a step; one that changes nothing is none."""
        if contents == self.files.contents:
            return self
        return self._as(contents, _bounded((*self.past, self.files.contents)), ())

    def _as(self, contents: Contents, past: tuple[Contents, ...], future: tuple[Contents, ...]) -> Draft:
        return replace(self, files=replace(self.files, contents=contents), past=past, future=future)


def draft_of(files: PlantFiles) -> Draft:
    """An empty draft of what is at work."""
    return Draft(base=files, files=files)


def _bounded(past: tuple[Contents, ...]) -> tuple[Contents, ...]:
    """The last of these steps, as many as are kept; what two of them share counts once."""
    newer: Contents = {}
    size = 0
    for count, contents in enumerate(reversed(past)):
        size += sum(len(each) for name, each in contents.items() if newer.get(name) is not each)
        if count == MOST_STEPS or size > MOST_BYTES:
            return past[len(past) - count :]
        newer = contents
    return past


def _differences(before: Any, after: Any, place: Place = ()) -> Iterator[tuple[Place, Any]]:
    """The values that lead from one mapping to another, by their places; MISSING for a key that goes away.

    What comes stands before what goes, so that no mapping is empty in between.
    """
    if not isinstance(before, dict) or not isinstance(after, dict):
        if before != after:
            yield place, after
        return
    for key, each in after.items():
        if key in before:
            yield from _differences(before[key], each, (*place, key))
        else:
            yield (*place, key), each
    yield from (((*place, key), MISSING) for key in before if key not in after)


def _uses(text: bytes) -> list[str]:
    """The files that a plant file uses; none where its text is no list, which `check` refuses."""
    value = parse(text)[0].value
    found = value.get(USES) if isinstance(value, dict) else None
    return [each for each in found if isinstance(each, str)] if isinstance(found, list) else []


def check_name(name: str) -> None:
    """Raise EditRefused for what is no file of trees in the plant's folder."""
    path = PurePosixPath(name)
    is_inside = not path.is_absolute() and ".." not in path.parts and name.isprintable() and "\\" not in name
    is_hidden = path.name.startswith((".", "-")) or KEPT in path.parts  # or taken for an option of a command
    if not is_inside or is_hidden or path.suffix != XML or not path.stem or len(name) > 200:
        raise EditRefused(f"{quoted(name)} is no file of trees, *{XML}, in the plant's folder")
