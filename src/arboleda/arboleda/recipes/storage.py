"""Recipes of a cell whose arm stores the parts that a mobile robot brings."""

from __future__ import annotations

from typing import Annotated

from arboleda.model.plant_model import STATIONS
from arboleda.model.sentence import Phrase

from .authoring import Kit, recipe, work
from .handles import Pick, Place, Step
from .parameters import Path, Slot

ARM, MOBILE = "arm", "mobile"  # roles
HOME = "home"
PALLETIZING_TARGETS = "palletizing"  # the group of the two targets of the arm's own cycle
NAME = Phrase("step.storage", "storage")
NAME_OF_CYCLE = Phrase("step.palletizing", "palletizing")
NAME_OF_ARM = Phrase("text.arm", "arm")
PATH = Phrase("text.path", "path")
STATION = Phrase("text.station", "station")


@recipe("storage", title=NAME, about="", is_default=True, ends_with={"station": 1})
def storage(
    cell: Kit,
    path: Annotated[str, Path(called=PATH)],
    station: Annotated[str, Slot(STATIONS, called=STATION)],
) -> Step:
    """Drive the mobile robot, take its part, put that into its station, go home."""
    arm, mobile = cell.devices(ARM, MOBILE)
    pickup = cell.handover(path)
    arm.brings_back_to(pickup)
    return work(mobile.follow(path), arm.tour(Pick(pickup), Place(station), HOME))


@recipe(
    "palletizing",
    title=NAME_OF_CYCLE,
    about="",
    alone=ARM,
    alone_called=NAME_OF_ARM,
    part_from=PALLETIZING_TARGETS,
)
def palletizing(cell: Kit) -> Step:
    """Take a part, put it down: the arm alone."""
    arm = cell.device(ARM)
    pick, place = cell.group(PALLETIZING_TARGETS)
    arm.brings_back_to(cell.handover())
    return work(arm.tour(HOME, Pick(pick), Place(place)))


RECIPES = (storage, palletizing)
