"""The plant as the page sees it, and the page on the server's application."""

from __future__ import annotations

from dataclasses import asdict
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fastapi import FastAPI

from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import Phrase
from arboleda.plant_file.urdf import robot_urdf
from arboleda.recorder.errors import NoRecord
from arboleda.views import view
from arboleda.web.desks.demonstration import DemonstrationApi
from arboleda.web.desks.faults import FaultsApi
from arboleda.web.desks.make import MakeApi

from ..registry import Assembly
from .local_plant import LocalPlant
from .orchestrator import Orchestrator

if TYPE_CHECKING:  # slow to load, and only needed for a record
    from arboleda.dashboard.past.past import Past
    from arboleda.dashboard.past.side import Start

    from .records import Records
    from .tried import TriedPlant, TriedPlants

NOT_YET = Phrase("record.not_yet", "There is no record of this start yet; try again in some seconds.")


class PagePlant(LocalPlant):
    """PageApi of the plant in this process: LocalPlant with what only the page shows."""

    def __init__(self, plant: Orchestrator, assembly: Assembly) -> None:
        super().__init__(plant, assembly.holdings.history, assembly)
        self._drawn: tuple[PlantModel | None, dict[str, Any]] = None, {}
        self._layout: dict[str, Any] = {}
        self._past_acts = assembly.holdings.past_acts
        is_recorded = assembly.options.recording is not None
        self._recorded_in = assembly.holdings.state.path if is_recorded else None
        self.links = assembly.links
        self.positions = plant.positions

    def past_acts(self) -> list[dict[str, Any]]:
        return self._past_acts

    def mount(self, app: FastAPI) -> None:
        """Put the page on the server's application."""
        from arboleda.dashboard import page  # it takes most of a second, and not all plants have a page

        page.mount(app, self)

    def layout(self) -> dict[str, Any]:
        model, faults = self.model, self.ask(FaultsApi)
        beside = {
            "recorded": self._recorded_in is not None,
            "demo": self.ask(DemonstrationApi) is not None,
            "draft": self.ask(MakeApi) is not None,
            "faults": [] if faults is None else [asdict(each) for each in faults.offers()],
        }
        drawn, shown = self._drawn
        if drawn is not model or shown != beside:  # parts that are made after the page offer more
            self._drawn, self._layout = (model, beside), view.layout(model) | beside
        return self._layout

    def end_demo(self) -> None:
        demonstration = self.ask(DemonstrationApi)
        if demonstration is not None:
            demonstration.end()

    def past(self, epoch: int | None = None) -> Past:
        return self._recorded.past(epoch)

    def starts(self) -> list[Start]:
        return self._recorded.starts()

    @cached_property
    def _recorded(self) -> Records:
        from .records import Records

        return Records(self._own, self.layout())

    def tried(self) -> TriedPlant:
        make = self.ask(MakeApi)
        return self._tried.last(None if make is None else make.tried())

    @cached_property
    def _tried(self) -> TriedPlants:
        from .tried import TriedPlants

        return TriedPlants()

    def proof(self) -> str | None:
        make = self.ask(MakeApi)
        file = None if make is None else make.proof_page()
        return None if file is None else file.read_text("utf-8")

    def _own(self) -> Path:
        from arboleda.recorder import files

        state, epoch = self._recorded_in, self.snapshot()["epoch"]
        found = files.parts_in(state / files.FOLDER) if state else []
        parts = [part for part in found if part.epoch == epoch]
        if not parts:
            raise NoRecord(NOT_YET())
        return parts[-1].path

    def urdf(self, robot: str) -> str:
        return robot_urdf(self.model, robot)
