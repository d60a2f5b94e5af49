"""Check of a draft: files of a plant that are not in their folder yet, by all checks of `arboleda check`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from arboleda.model.errors import ConfigError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file import loader
from arboleda.plant_file.draft import DraftCheck, Shade, shaded

from . import checks
from .unstated import unstated


def check(
    files: PlantFiles, plant_file: Path, named: Callable[[Shade, str], str] = Shade.renamed
) -> DraftCheck:
    """The result of checking `files` as if they were in the folder of `plant_file`, beside its other files.

    Problems name each file by the path that it would have, or as `named` has it. Nothing is written into that
    folder. Recipes in Python run in a process of their own, as in `arboleda check`.
    """
    with shaded(files, plant_file) as shade:
        try:
            plant, read = loader.load_with_files(shade.plant_file)
            warnings, lacks = checks.warnings(plant), unstated(plant)
        except ConfigError as error:
            return DraftCheck(problems=tuple(named(shade, each) for each in error.problems))
        return DraftCheck(
            plant=plant,
            read=read if read.plant == files.plant else None,  # absolute paths have other names here
            warnings=tuple(named(shade, each) for each in warnings),
            unstated=tuple(each for each in lacks if each.fits(files.contents[files.plant])),
        )
