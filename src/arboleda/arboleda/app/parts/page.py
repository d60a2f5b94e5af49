"""The plant as the page sees it, and the page on the server's application."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from fastapi import FastAPI

from arboleda.model.plant_model import PlantModel
from arboleda.views import view

from ..urdf import robot_urdf
from .web import Side


@dataclass(frozen=True, kw_only=True)
class Sources:
    """What the page shows besides snapshots; each is asked from the server's thread."""

    model: PlantModel
    links: Callable[[], dict[str, Any]]
    positions: Callable[[], dict[str, Any]]
    past_acts: Callable[[], list[dict[str, Any]]]


class PageSide:
    """`arboleda.dashboard.plant_side.PlantSide`."""

    def __init__(self, side: Side, sources: Sources) -> None:
        self._model = sources.model
        self._layout = view.layout(sources.model)
        self.snapshot = side.snapshot
        self.submit = side.submit
        self.operate = side.operate
        self.history = side.history
        self.oee = side.oee
        self.watch = side.watch
        self.links = sources.links
        self.positions = sources.positions
        self.past_acts = sources.past_acts

    def layout(self) -> dict[str, Any]:
        return self._layout

    def urdf(self, robot: str) -> str:
        return robot_urdf(self._model, robot)


def mounting(sources: Sources) -> Callable[[FastAPI, Side], None]:
    """What puts the page on the server's application."""

    def mount(app: FastAPI, side: Side) -> None:
        from arboleda.dashboard import page  # it takes most of a second: only who shows a page waits for it

        page.mount(app, PageSide(side, sources))

    return mount
