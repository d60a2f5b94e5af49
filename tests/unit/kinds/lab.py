"""A laboratory bench without a robot arm, with its bridge and its virtual boards."""

from __future__ import annotations

from arboleda.kinds.declared import Device, DeviceKind, DeviceVerb, Effect, FactType, Slot
from arboleda.model.commands import Command, OnStop
from arboleda.model.messages import TaskChanged
from arboleda.model.plant_model import Cell, Evidence, Link, PlantModel
from arboleda.recipes import Choice, Kit, recipe, work
from arboleda.rig.rig import Rig

LID = FactType(type=str, words=("open", "closed"), first="open")
DOSE = FactType(type=int, words=(5, 10, 20), first=5)
ON = FactType(type=bool, first=False)
OVEN = DeviceKind(
    name="oven",
    facts={"lid": LID, "clamped": ON, "dose": DOSE},
    verbs={
        "open": DeviceVerb(
            name="open", effect=Effect.MOTION, sets=(("lid", "open"),), takes_s=1.0, at_most_s=3.0
        ),
        "close": DeviceVerb(
            name="close", effect=Effect.MOTION, sets=(("lid", "closed"),), takes_s=1.0, at_most_s=3.0
        ),
        "clamp": DeviceVerb(
            name="clamp",
            effect=Effect.SWITCH,
            parameters=(("on", ON),),
            sets=(("clamped", Slot(name="on")),),
            at_most_s=2.0,
            holds=True,
        ),
        "bake": DeviceVerb(
            name="bake",
            effect=Effect.PROCESS,
            parameters=(("dose", DOSE),),
            sets=(("dose", Slot(name="dose")),),
            needs=(("lid", "closed"), ("clamped", True)),
            takes_s=20.0,
            at_most_s=30.0,
            on_stop=OnStop.FINISH,
        ),
    },
)
EYE = DeviceKind(
    name="eye",
    facts={},
    verbs={
        "look": DeviceVerb(
            name="look", effect=Effect.QUERY, takes_s=0.5, at_most_s=2.0, answers=("good", "bad")
        )
    },
)


@recipe("bake")
def bake(cell: Kit, dose: Choice[5, 10]):  # type: ignore[no-untyped-def,valid-type]
    """Look at the sample; bake a good one."""
    oven, eye = cell.devices("oven", "eye")
    seen = eye.look()
    good = [oven.clamp(on=True), oven.close(), oven.bake(dose=dose), oven.open(), oven.clamp(on=False)]
    return work(seen, cell.choose(seen, {"good": good, "bad": cell.fail("the sample is bad")}))


@recipe("careless")
def careless(cell: Kit):  # type: ignore[no-untyped-def]
    """Bake with the lid open."""
    oven = cell.device("oven")
    return work(oven.clamp(on=True), oven.bake(dose=5))


def model(*recipes: object, evidence: Evidence = Evidence.IDS) -> PlantModel:
    """A bench whose oven proves its work at this level; who looks names the question that it answers."""
    oven = Device(name="oven", mqtt="oven", link=Link.MQTT, evidence=evidence, timeout_s=30.0, kind=OVEN)
    eye = Device(name="eye", mqtt="eye", link=Link.MQTT, evidence=Evidence.IDS, timeout_s=2.0, kind=EYE)
    bench = Cell(
        name="bench",
        queue_limit=5,
        members=(("oven", oven), ("eye", eye)),
        recipes=recipes or (bake, careless),  # type: ignore[arg-type]
    )
    return PlantModel(name="lab", cells=(bench,))


class Bench(Rig):
    """The plant, the bridge and its virtual boards; messages take no time."""

    def __init__(self, plant: PlantModel) -> None:
        super().__init__(plant, now=0.0)
        self.machines = {name: board.body for name, board in self.boards.items()}

    @property
    def told(self) -> list[str]:
        """What devices were told, in order: `oven clamp`, `oven stop`."""
        commands = (each for each in self.sent if isinstance(each, Command))
        return [f"{each.robot} {getattr(each, 'verb', 'stop')}" for each in commands]

    def outcome(self, seconds: float = 120.0) -> TaskChanged:
        """The end of the task that was asked for last."""
        ended = ("done", "failed", "cancelled", "refused")
        assert self.wait(seconds, lambda: self.changes[-1].state.value in ended)
        return self.changes[-1]
