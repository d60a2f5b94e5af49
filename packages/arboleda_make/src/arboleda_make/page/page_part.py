"""Part of a plant's page: Make, Draw, Teach and Changes."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from fastapi import FastAPI

from arboleda.dashboard.page_part import OtherRecord
from arboleda.dashboard.past.side import PastSide
from arboleda.extension import Assets, PageApi, PagePart, Place, Role, Section
from arboleda_make.trying.api import MakeApi

from . import findings_route, make_panel, proof, teach_panel, tree_editor, versions

if TYPE_CHECKING:
    from .tried import TriedPlants


def serve(server: FastAPI, plant: PageApi) -> None:
    """Answer what the scripts ask for."""
    for each in (versions, proof, findings_route):
        each.serve(server, plant)


def tried(plant: PageApi) -> PastSide:
    """The last tryout of the draft; an ArboledaError says that there is none."""
    desk = plant.ask(MakeApi)
    return _tried().last(None if desk is None else desk.tried())


@cache
def _tried() -> TriedPlants:
    from .tried import TriedPlants  # slow to load, and only needed for a record

    return TriedPlants()


PAGE = PagePart(
    assets=Assets(package=__package__, script="part.js", styles=("draw", "teach", "make")),
    sections=(
        Section(place=Place.TAB, name="make", build=make_panel.build, role=Role.OPERATOR),
        Section(place=Place.TAB, name="draw", within="make", build=tree_editor.build),
        Section(place=Place.TAB, name="teach", within="make", build=teach_panel.build, role=Role.OPERATOR),
        Section(place=Place.TREE, build=teach_panel.way_from_tree),
        Section(place=Place.SETTINGS, build=versions.build),
    ),
    face=teach_panel.face,
    serve=serve,
    records={"draft": OtherRecord(side=tried, may="looking at what was tried of a draft")},
)
