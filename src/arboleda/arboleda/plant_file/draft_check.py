"""Check of a plant's files that are not in their folder yet, by all that `arboleda check` looks at."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from arboleda.model.errors import ConfigError
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel

from . import loader, plant_check
from .unstated import Unstated, unstated


@dataclass(frozen=True, kw_only=True)
class CheckResult:
    """Result of checking files: the plant, None where there are `problems`; lines with file, line and column.

    `read`: all files that the plant was made of, by paths as those that were checked have. `unstated`: what
    this plant file could state, and does not.
    """

    plant: PlantModel | None = None
    read: PlantFiles | None = None
    problems: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    unstated: tuple[Unstated, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Shade:
    """Shade: a folder as that of a plant file, with other files in it; `plant_file` is the one to read there.

    `named` has the folders that lines name, and those that they mean.
    """

    plant_file: Path
    named: Mapping[str, str]

    def renamed(self, line: str) -> str:
        """The line with the paths of the real files."""
        for made, real in self.named.items():
            line = line.replace(f"{made}{os.sep}", "" if real == os.curdir else f"{real}{os.sep}")
        return line


@contextmanager
def shaded(files: PlantFiles, plant_file: Path) -> Iterator[Shade]:
    """A shade of the folder of `plant_file` with these files, as long as it is open."""
    root = root_of(files, plant_file)
    with TemporaryDirectory(prefix="arboleda-") as made:
        shadow = Path(made) / "plant"
        _shade(shadow, root.absolute(), files.contents)
        there = shadow / files.plant
        yield Shade(
            plant_file=there, named={str(there.parent): str(plant_file.parent), str(shadow): str(root)}
        )


def check(files: PlantFiles, plant_file: Path) -> CheckResult:
    """The verdict on `files` as if they were in the folder of `plant_file`, where all others are.

    Lines name the files by where they would be. Nothing is written there; recipes in Python run as in
    `arboleda check`, in a process of its own.
    """
    with shaded(files, plant_file) as shade:
        try:
            plant, read = loader.load_with_files(shade.plant_file)
            warnings, lacks = plant_check.warnings(plant), unstated(plant)
        except ConfigError as error:
            return CheckResult(problems=tuple(map(shade.renamed, error.problems)))
        named = read if read.plant == files.plant else None  # absolute paths have other names here
        return CheckResult(
            plant=plant,
            read=named,
            warnings=tuple(map(shade.renamed, warnings)),
            unstated=tuple(each for each in lacks if each.fits(files.contents[files.plant])),
        )


def root_of(files: PlantFiles, plant_file: Path) -> Path:
    """The folder from which the paths of a plant's files count."""
    depth = len(Path(files.plant).parts) - 1
    return Path(os.path.normpath(plant_file.parent.joinpath(*[os.pardir] * depth)))


def _shade(shadow: Path, folder: Path, contents: Mapping[str, bytes]) -> None:
    """Make a folder that is as `folder`, but for the files with these contents, by paths from it."""
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
