"""Draft of a plant: files that are not in their folder yet, a folder that has them, and a check's result."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel

from .document import Place, dotted
from .yaml_flow import flow
from .yaml_marks import parse


@dataclass(frozen=True, kw_only=True)
class Unstated:
    """Rule that a plant file lacks.

    `unknown` says what nobody knows without the rule. One of `values` could stand at `place` in the file.
    """

    unknown: str
    place: Place
    values: tuple[Mapping[str, Any], ...]

    @property
    def offer(self) -> str:
        """The sentence with what could be written."""
        return f"{self.unknown}; {dotted(self.place)}: {' or '.join(map(flow, self.values))} would state it"

    @property
    def plain(self) -> dict[str, Any]:
        """The rule for JSON: each value with its text in the file."""
        choices = [{"text": f"{dotted(self.place)}: {flow(each)}", "value": each} for each in self.values]
        return {"sentence": self.unknown, "place": list(self.place), "choices": choices}

    def fits(self, content: bytes) -> bool:
        """True where a plant file of this content can state the rule; a kind may be of another file."""
        node, _ = parse(content)
        for key in self.place[:-1]:
            if key not in node.children:
                return False
            node = node.children[key]
        return True


@dataclass(frozen=True, kw_only=True)
class DraftCheck:
    """Result of checking a draft: the plant, None where there are `problems`.

    Problems and warnings are lines with file, line and column. `read` are all files that the plant was made
    of, by paths like those of the draft. `unstated` are rules that the plant file could state, and does not.
    """

    plant: PlantModel | None = None
    read: PlantFiles | None = None
    problems: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    unstated: tuple[Unstated, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Shade:
    """A folder like that of a plant file, in which some files are others; `plant_file` is the file to read.

    `named` has by each folder of the shade, which problems name, the real folder. `root` is the folder of the
    shade from which the draft's paths count.
    """

    plant_file: Path
    named: Mapping[str, str]
    root: Path

    def renamed(self, line: str) -> str:
        """The line with the paths of the real files."""
        for made, real in self.named.items():
            line = line.replace(f"{made}{os.sep}", "" if real == os.curdir else f"{real}{os.sep}")
        return line

    def shortened(self, line: str) -> str:
        """The line with paths as the draft has them: `plant.yaml:12:3`."""
        return line.replace(f"{self.root}{os.sep}", "")


@contextmanager
def shaded(files: PlantFiles, plant_file: Path) -> Iterator[Shade]:
    """A shade of the folder of `plant_file` with these files, as long as it is open."""
    root = root_of(files, plant_file)
    with TemporaryDirectory(prefix="arboleda-") as made:
        shadow = Path(made) / "plant"
        _shade(shadow, root.absolute(), files.contents)
        there = shadow / files.plant
        named = {str(there.parent): str(plant_file.parent), str(shadow): str(root)}
        yield Shade(plant_file=there, named=named, root=shadow)


def root_of(files: PlantFiles, plant_file: Path) -> Path:
    """The folder from which the paths of a plant's files count."""
    depth = len(Path(files.plant).parts) - 1
    return Path(os.path.normpath(plant_file.parent.joinpath(*[os.pardir] * depth)))


def _shade(shadow: Path, folder: Path, contents: Mapping[str, bytes]) -> None:
    """Make a folder like `folder`, in which the files at these paths have these contents."""
    shadow.mkdir()
    heads = {Path(name).parts[0] for name in contents}
    for each in os.listdir(folder) if folder.is_dir() else ():
        if each not in heads:
            (shadow / each).symlink_to(folder / each)
    for head in heads:
        if head in contents:
            (shadow / head).write_bytes(contents[head])
            continue
        inside = [name for name in contents if name.startswith(f"{head}/")]
        inner = {name.partition("/")[2]: contents[name] for name in inside}
        _shade(shadow / head, folder / head, inner)
