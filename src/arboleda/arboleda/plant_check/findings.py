"""Findings of a plant: problems and warnings of `check`, and what goes wrong in runs without faults."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from enum import Enum
from pathlib import Path
from typing import Any

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_check import checks
from arboleda.plant_file import loader

PLACE = re.compile(r"(?P<file>[^:\n]+):(?P<line>\d+):(?P<column>\d+): (?:warning: )?(?P<rest>.*)", re.DOTALL)


class Source(str, Enum):
    """Source of a finding; findings of a source hide those of the sources below it."""

    PROBLEM = "problem"  # the plant cannot be used
    WARNING = "warning"
    RUN = "run without faults"


@dataclass(frozen=True, kw_only=True)
class PlantFinding:
    """A sentence that says what is wrong and what is allowed; file, line and column where there are any."""

    source: Source
    sentence: str
    file: str = ""
    line: int = 0
    column: int = 0
    task: str = ""  # of a run

    @property
    def plain(self) -> dict[str, Any]:
        """The finding for JSON."""
        return {**asdict(self), "source": self.source.value}


@dataclass(frozen=True, kw_only=True)
class Checked:
    """Checked plant: its findings, and its model, None where there are problems."""

    model: PlantModel | None
    findings: tuple[PlantFinding, ...]


def checked(file: Path, *, apart: bool = True) -> Checked:
    """The plant of a file with the findings of `arboleda check`; `apart`: its Python is tried apart."""
    folder = f"{file.parent}/"
    try:
        model = loader.load(file, apart=apart)
    except ConfigError as error:
        return Checked(model=None, findings=tuple(_placed(error.problems, Source.PROBLEM, folder)))
    return Checked(model=model, findings=tuple(_placed(checks.warnings(model), Source.WARNING, folder)))


def _placed(sentences: tuple[str, ...], source: Source, folder: str) -> Iterator[PlantFinding]:
    for each in sentences:
        each = each.replace(folder, "")
        match = PLACE.fullmatch(each)
        if match is None:
            yield PlantFinding(source=source, sentence=each)
        else:
            yield PlantFinding(
                source=source,
                sentence=match["rest"],
                file=match["file"],
                line=int(match["line"]),
                column=int(match["column"]),
            )
