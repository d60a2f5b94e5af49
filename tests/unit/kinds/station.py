"""A station that moves, switches and answers at the same time, for tests of what is told of it all."""

from __future__ import annotations

from arboleda.kinds import Number, motion, process, query, switch
from arboleda.model.plant_model import Cell, Evidence, PlantModel
from arboleda.model.recipe import Recipe

from ...plants import device_of, kind_of

WARMTH = Number(20.0, 90.0)
STATION = kind_of(
    "station",
    {"at": ["left", "right"], "lamp": bool, "held": bool, "celsius": WARMTH},
    go=motion(sets={"at": "right"}, takes_s=2.0, at_most_s=10.0),
    warm=process(
        parameters={"celsius": WARMTH},
        sets={"celsius": "$celsius"},
        needs={"at": "right"},
        takes_s=2.0,
        at_most_s=10.0,
        finishes=True,
    ),
    light=switch(parameters={"on": bool}, sets={"lamp": "$on"}, takes_s=1.0, at_most_s=5.0),
    hold=switch(parameters={"on": bool}, sets={"held": "$on"}, takes_s=1.0, at_most_s=5.0, holds_part=True),
    weigh=query(answers=["light", "heavy"], takes_s=1.0, at_most_s=5.0),
)


def plant(*recipes: Recipe, evidence: Evidence = Evidence.IDS) -> PlantModel:
    """A cell with nothing but one station."""
    station = device_of(STATION, mqtt="st_1", evidence=evidence)
    cell = Cell(name="bench", queue_limit=5, members=(("station", station),), recipes=recipes)
    return PlantModel(name="lab", cells=(cell,))
