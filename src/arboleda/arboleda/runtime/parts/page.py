"""The plant as the page sees it, and the page on the server's application."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI

from arboleda.dashboard.late_page import LatePage
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.urdf import robot_urdf
from arboleda.views import view

from ..registry import Assembly
from . import garbage
from .local_plant import LocalPlant
from .orchestrator import Orchestrator


class PagePlant(LocalPlant):
    """PageApi of the plant in this process: LocalPlant with what only the page shows."""

    def __init__(self, plant: Orchestrator, assembly: Assembly) -> None:
        super().__init__(plant, assembly.holdings.history, assembly)
        self._drawn: PlantModel | None = None
        self._layout: dict[str, Any] = {}
        self._pieces = assembly.pieces
        self._past_acts = assembly.holdings.past_acts
        self._is_recorded = assembly.options.recording is not None
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
            self._layout = view.layout(self._drawn) | {"recorded": self._is_recorded}
        return self._layout

    def urdf(self, robot: str) -> str:
        return robot_urdf(self.model, robot)
