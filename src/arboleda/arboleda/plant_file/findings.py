"""Findings of a plant: what is wrong with it by `check`, and by runs in which nothing goes wrong."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from enum import Enum
from pathlib import Path
from typing import Any

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader, plant_check

PLACE = re.compile(r"(?P<file>[^:\n]+):(?P<line>\d+):(?P<column>\d+): (?:warning: )?(?P<rest>.*)", re.DOTALL)


class Source(str, Enum):
    """Source of a finding; those above hide those below."""

    PROBLEM = "problem"  # the plant cannot be used
    WARNING = "warning"
    RUN = "run without faults"


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Finding: the sentence says what is wrong and what is allowed; file and line, if known, where."""

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
    """Checked plant: its model, None where it has problems, and what is found."""

    model: PlantModel | None
    findings: tuple[Finding, ...]


def checked(file: Path, *, apart: bool = True) -> Checked:
    """The findings of `arboleda check`; `apart`: its Python is tried in another process."""
    folder = f"{file.parent}/"
    try:
        model = loader.load(file, apart=apart)
    except ConfigError as error:
        return Checked(model=None, findings=tuple(_placed(error.problems, Source.PROBLEM, folder)))
    return Checked(model=model, findings=tuple(_placed(plant_check.warnings(model), Source.WARNING, folder)))


def _placed(sentences: tuple[str, ...], source: Source, folder: str) -> Iterator[Finding]:
    for each in sentences:
        each = each.replace(folder, "")
        found = PLACE.fullmatch(each)
        if found is None:
            yield Finding(source=source, sentence=each)
        else:
            yield Finding(
                source=source,
                sentence=found["rest"],
                file=found["file"],
                line=int(found["line"]),
                column=int(found["column"]),
            )
