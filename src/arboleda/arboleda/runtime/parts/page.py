"""The plant as the page sees it, and the page on the server's application."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fastapi import FastAPI

from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import Phrase
from arboleda.plant_file.urdf import robot_urdf
from arboleda.recorder.errors import NoRecord
from arboleda.store.task_rows import History
from arboleda.views import view
from arboleda.web.desks.draft import DraftApi
from arboleda.web.desks.faults import FaultsApi
from arboleda.web.desks.proposals import ProposalsApi
from arboleda.web.desks.versions import VersionsApi

from ..make.bench import MakeBench
from .local_plant import LocalPlant
from .orchestrator import Orchestrator

if TYPE_CHECKING:  # slow to load, and only needed for a record
    from arboleda.dashboard.past.past import Past
    from arboleda.dashboard.past.side import Start

    from .records import Records
    from .tried import TriedPlant, TriedPlants

NOT_YET = Phrase("record.not_yet", "There is no record of this start yet; try again in some seconds.")


@dataclass(frozen=True, kw_only=True)
class Sources:
    """The page's sources besides snapshots; each is called from the server's thread."""

    links: Callable[[], dict[str, Any]]
    positions: Callable[[], dict[str, Any]]
    past_acts: Callable[[], list[dict[str, Any]]]
    recorded: Path | None  # the state directory of a plant that writes a record
    report: Callable[[str], str | None]
    draft: DraftApi | None = None
    versions: VersionsApi | None = None
    make: MakeBench | None = None
    faults: FaultsApi | None = None
    proposals: ProposalsApi | None = None
    end_demo: Callable[[], None] | None = None  # None: this start is no demonstration


class PagePlant(LocalPlant):
    """PageApi of the plant in this process: LocalPlant with what only the page shows."""

    def __init__(self, plant: Orchestrator, history: History, sources: Sources) -> None:
        super().__init__(
            plant,
            history,
            sources.draft,
            sources.versions,
            sources.make,
            sources.report,
            sources.proposals,
            sources.faults,
        )
        self._drawn: tuple[PlantModel | None, dict[str, Any]] = None, {}
        self._sources = sources
        self.links = sources.links
        self.positions = sources.positions
        self.past_acts = sources.past_acts

    def mount(self, app: FastAPI) -> None:
        """Put the page on the server's application."""
        from arboleda.dashboard import page  # it takes most of a second, and not all plants have a page

        page.mount(app, self)

    def layout(self) -> dict[str, Any]:
        model = self.model
        if self._drawn[0] is not model:
            beside = {
                "recorded": self._sources.recorded is not None,
                "demo": self._sources.end_demo is not None,
                "draft": self._sources.make is not None,
                "faults": [asdict(each) for each in self.faults.offers()] if self.faults else [],
            }
            self._drawn = model, view.layout(model) | beside
        return self._drawn[1]

    def end_demo(self) -> None:
        if self._sources.end_demo is not None:
            self._sources.end_demo()

    def past(self, epoch: int | None = None) -> Past:
        return self._recorded.past(epoch)

    def starts(self) -> list[Start]:
        return self._recorded.starts()

    @cached_property
    def _recorded(self) -> Records:
        from .records import Records

        return Records(self._own, self.layout())

    def tried(self) -> TriedPlant:
        make = self._sources.make
        return self._tried.last(None if make is None else make.tried())

    @cached_property
    def _tried(self) -> TriedPlants:
        from .tried import TriedPlants

        return TriedPlants()

    def proof(self) -> str | None:
        file = None if self._sources.make is None else self._sources.make.proof_page()
        return None if file is None else file.read_text("utf-8")

    def _own(self) -> Path:
        from arboleda.recorder import files

        state, epoch = self._sources.recorded, self.snapshot()["epoch"]
        found = files.parts_in(state / files.FOLDER) if state else []
        parts = [part for part in found if part.epoch == epoch]
        if not parts:
            raise NoRecord(NOT_YET())
        return parts[-1].path

    def urdf(self, robot: str) -> str:
        return robot_urdf(self.model, robot)
