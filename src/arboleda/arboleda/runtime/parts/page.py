"""The plant as the page sees it, and the page on the server's application."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fastapi import FastAPI

from arboleda.dashboard.late_page import LatePage
from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import Phrase
from arboleda.plant_file.urdf import robot_urdf
from arboleda.recorder.errors import NoRecord
from arboleda.views import view

from ..registry import Assembly
from . import garbage
from .local_plant import LocalPlant
from .orchestrator import Orchestrator

if TYPE_CHECKING:  # slow to load, and only needed for a record
    from arboleda.dashboard.past.past import Past
    from arboleda.dashboard.past.side import Start

    from .records import Records

NOT_YET = Phrase("record.not_yet", "There is no record of this start yet; try again in some seconds.")


class PagePlant(LocalPlant):
    """PageApi of the plant in this process: LocalPlant with what only the page shows."""

    def __init__(self, plant: Orchestrator, assembly: Assembly) -> None:
        super().__init__(plant, assembly.holdings.history, assembly)
        self._drawn: PlantModel | None = None
        self._layout: dict[str, Any] = {}
        self._pieces = assembly.pieces
        self._past_acts = assembly.holdings.past_acts
        is_recorded = assembly.options.recording is not None
        self._recorded_in = assembly.holdings.state.path if is_recorded else None
        self.links = assembly.links
        self.positions = plant.screens.positions

    def past_acts(self) -> list[dict[str, Any]]:
        return self._past_acts

    def mount(self, app: FastAPI) -> None:
        """Put the page on the server's application."""
        LatePage(self, self._pieces, garbage.leave_out_more).mount(app)

    def layout(self) -> dict[str, Any]:
        if self._drawn is not self.model:
            self._drawn = self.model
            self._layout = view.layout(self._drawn) | {"recorded": self._recorded_in is not None}
        return self._layout

    def past(self, epoch: int | None = None) -> Past:
        return self._recorded.past(epoch)

    def starts(self) -> list[Start]:
        return self._recorded.starts()

    @cached_property
    def _recorded(self) -> Records:
        from .records import Records

        state = self._recorded_in
        return Records(lambda: _own_record(state, self.snapshot()["epoch"]), self.layout())

    def urdf(self, robot: str) -> str:
        return robot_urdf(self.model, robot)


def _own_record(state: Path | None, epoch: int) -> Path:
    """The last file of the record of this start; NoRecord where there is none yet."""
    from arboleda.recorder import files

    all_parts = files.parts_in(state / files.FOLDER) if state else []
    parts = [part for part in all_parts if part.epoch == epoch]
    if not parts:
        raise NoRecord(NOT_YET())
    return parts[-1].path
