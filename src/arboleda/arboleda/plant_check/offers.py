"""Offers: rules that a plant file could state, as edits, of which a person takes the right one."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from typing import Any

from arboleda.model.plant_model import PlantModel
from arboleda.plant_check.unstated import unstated
from arboleda.plant_file import yaml_edit
from arboleda.plant_file.draft import Unstated
from arboleda.plant_file.yaml_edit import EditRefused

from .mend import Edit, cut_between, edit_of


@dataclass(frozen=True, kw_only=True)
class Offer:
    """A sentence on a rule that the plant file lacks, and edits, each of which alone would state the rule."""

    sentence: str
    edits: tuple[Edit, ...]

    @property
    def plain(self) -> dict[str, Any]:
        """The offer for JSON."""
        return asdict(self)


def offers(file: str, text: str, model: PlantModel) -> tuple[Offer, ...]:
    """The offers for a plant file with this text; rules of kinds in other files are left out."""
    rows = [(each, tuple(_edits(file, text, each))) for each in unstated(model) if each.fits(text.encode())]
    return tuple(Offer(sentence=each.unknown, edits=edits) for each, edits in rows if edits)


def _edits(file: str, text: str, lack: Unstated) -> Iterator[Edit]:
    for value in lack.values:
        with suppress(EditRefused):
            changed = yaml_edit.with_value(text.encode(), lack.place, value).decode()
            yield edit_of({file: text}, cut_between(file, text, changed))
