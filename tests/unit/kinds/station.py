"""A station that moves, switches and answers at the same time, for tests of what is told of it all."""

from __future__ import annotations

from arboleda.kinds.declared import Device, DeviceKind, DeviceVerb, Effect, FactType, Slot
from arboleda.model.commands import OnStop
from arboleda.model.plant_model import Cell, Evidence, Link, PlantModel
from arboleda.model.recipe import Recipe

ON = FactType(type=bool, first=False)
WARMTH = FactType(type=float, first=20.0)
STATION = DeviceKind(
    name="station",
    facts={
        "at": FactType(type=str, words=("left", "right"), first="left"),
        "lamp": ON,
        "held": ON,
        "celsius": WARMTH,
    },
    verbs={
        "go": DeviceVerb(
            name="go", effect=Effect.MOTION, sets=(("at", "right"),), takes_s=2.0, at_most_s=10.0
        ),
        "warm": DeviceVerb(
            name="warm",
            effect=Effect.PROCESS,
            parameters=(("celsius", WARMTH),),
            sets=(("celsius", Slot(name="celsius")),),
            needs=(("at", "right"),),
            takes_s=2.0,
            at_most_s=10.0,
            on_stop=OnStop.FINISH,
        ),
        "light": DeviceVerb(
            name="light",
            effect=Effect.SWITCH,
            parameters=(("on", ON),),
            sets=(("lamp", Slot(name="on")),),
            takes_s=1.0,
            at_most_s=5.0,
        ),
        "hold": DeviceVerb(
            name="hold",
            effect=Effect.SWITCH,
            parameters=(("on", ON),),
            sets=(("held", Slot(name="on")),),
            takes_s=1.0,
            at_most_s=5.0,
            holds=True,
        ),
        "weigh": DeviceVerb(
            name="weigh", effect=Effect.QUERY, takes_s=1.0, at_most_s=5.0, answers=("light", "heavy")
        ),
    },
)


def plant(*recipes: Recipe, evidence: Evidence = Evidence.IDS) -> PlantModel:
    """A cell with nothing but one station."""
    station = Device(
        name="station", mqtt="st_1", link=Link.MQTT, evidence=evidence, timeout_s=5.0, kind=STATION
    )
    cell = Cell(name="bench", queue_limit=5, members=(("station", station),), recipes=recipes)
    return PlantModel(name="lab", cells=(cell,))
