"""A laboratory bench without a robot arm, and its plant in one loop with its virtual devices."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.core.commands import Command, OnStop
from arboleda.core.messages import Event, OperatorAnswer, OperatorRequest, TaskChanged, TaskRequest, Verb
from arboleda.core.model import Cell, Evidence, Link, PlantModel
from arboleda.core.plant import Plant
from arboleda.kinds.declared import Device, DeviceKind, DeviceVerb, Effect, FactType, Slot
from arboleda.recipes import Choice, Kit, recipe, work
from arboleda.sim.machine import Machine

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


class Bench:
    """The plant and its virtual devices; messages take no time, `wait` goes from deadline to deadline."""

    def __init__(self, plant: PlantModel) -> None:
        self.now = 0.0
        self.plant = Plant(plant, epoch=1000, now=0.0)
        devices = [robot for robot in plant.robots.values() if isinstance(robot, Device)]
        self.machines = {each.name: Machine(each, now=0.0, boot_id=7) for each in devices}
        self.changes: list[TaskChanged] = []
        self.answers: list[OperatorAnswer] = []
        self.told: list[str] = []
        self.lost: Callable[[Command], bool] = lambda command: False
        self._pass()

    def submit(self, text: str) -> None:
        self._pass(TaskRequest(at=self.now, text=text))

    def operate(self, verb: Verb, scope: str = "") -> str | None:
        self._pass(OperatorRequest(at=self.now, verb=verb, scope=scope))
        refusal = self.answers[-1].refusal
        return None if refusal is None else str(refusal)

    def wait(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        end = self.now + seconds
        while self.now < end and not until():
            due = [machine.next_deadline for machine in self.machines.values()]
            self.now = min(end, max(self.now, min(self.plant.next_deadline, *due)))
            self._pass()
        return until()

    def outcome(self, seconds: float = 120.0) -> TaskChanged:
        """The end of the task that was asked for last."""
        ended = ("done", "failed", "cancelled", "refused")
        assert self.wait(seconds, lambda: self.changes[-1].state.value in ended)
        return self.changes[-1]

    def _pass(self, *events: Event) -> None:
        """One step of the plant, and what comes of it at once."""
        heard: list[Event] = [*events]
        for machine in self.machines.values():
            heard += machine.step(self.now, ()) if machine.next_deadline <= self.now else ()
        while True:
            out = self.plant.step(self.now, heard)
            self.changes += [each for each in out if isinstance(each, TaskChanged)]
            self.answers += [each for each in out if isinstance(each, OperatorAnswer)]
            commands = [each for each in out if isinstance(each, Command) and not self.lost(each)]
            if not commands:
                return
            self.told += [f"{each.robot} {getattr(each, 'verb', 'stop')}" for each in commands]
            heard = []
            for name, machine in self.machines.items():
                mine = [each for each in commands if each.robot == name]
                heard += machine.step(self.now, mine) if mine else ()
