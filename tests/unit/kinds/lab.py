"""A laboratory bench without a robot arm, with its bridge and its virtual boards."""

from __future__ import annotations

from typing import Any

from arboleda.kinds import Verb, motion, process, query, switch
from arboleda.kinds.declared import DeviceKind
from arboleda.model.commands import Command
from arboleda.model.messages import TaskChanged
from arboleda.model.plant_model import Cell, Evidence, PlantModel
from arboleda.recipes import Choice, Kit, recipe, work
from arboleda.rig.rig import Rig

from ...plants import device_of, kind_of

FACTS = {"lid": ["open", "closed"], "clamped": bool, "dose": [5, 10, 20]}
VERBS = {
    "open": motion(sets={"lid": "open"}, takes_s=1.0, at_most_s=3.0),
    "close": motion(sets={"lid": "closed"}, takes_s=1.0, at_most_s=3.0),
    "clamp": switch(parameters={"on": bool}, sets={"clamped": "$on"}, at_most_s=2.0, holds_part=True),
    "bake": process(
        parameters={"dose": [5, 10, 20]},
        sets={"dose": "$dose"},
        needs={"lid": "closed", "clamped": True},
        takes_s=20.0,
        at_most_s=30.0,
        finishes=True,
    ),
}
OVEN = kind_of("oven", FACTS, **VERBS)
EYE = kind_of("eye", {}, look=query(answers=["good", "bad"], takes_s=0.5, at_most_s=2.0))


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


def oven_of(**verbs: Verb) -> DeviceKind:
    """An oven with other verbs, or more of them."""
    return kind_of("oven", FACTS, **{**VERBS, **verbs})


def model(
    *recipes: object, evidence: Evidence = Evidence.IDS, oven: DeviceKind = OVEN, eye: DeviceKind = EYE
) -> PlantModel:
    """A bench whose oven proves its work at this level; who looks names the question that it answers."""
    oven_, eye_ = device_of(oven, evidence=evidence, timeout_s=30.0), device_of(eye, timeout_s=2.0)
    offered: Any = recipes or (bake, careless)
    bench = Cell(name="bench", queue_limit=5, members=(("oven", oven_), ("eye", eye_)), recipes=offered)
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
