"""A rover behind an action, two services and topics: its plant file, and its machine without ROS 2."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

from arboleda.drivers import Device, Report
from arboleda.model.commands import Command
from arboleda.plant_file.loader import load
from arboleda_drivers.ros_action.events import (
    CancelAnswer,
    GoalAnswer,
    GoalList,
    GoalResult,
    ListedGoal,
    Status,
)
from arboleda_drivers.ros_action.presence import End
from arboleda_drivers.ros_mapping.events import (
    ActionSaid,
    EndsFound,
    Event,
    GoalRequest,
    Message,
    MessageHeard,
    Response,
)
from arboleda_drivers.ros_mapping.machine import Machine

RECIPES = """
from arboleda.recipes import recipe

@recipe("work")
def work(cell):
    return cell.device("rover").go(x=2.0)
"""
PLANT = (Path(__file__).parent / "plant.yaml").read_text("utf-8")
GO, GRIP, LOOK = End("action", "/rover/go"), End("service", "/rover/grip"), End("service", "/look")
POSE, HORN = End("topic", "/rover/pose"), End("publish", "/rover/horn")
THERE = {GO: (7,), GRIP: (0,), LOOK: (0,), POSE: (3,), HORN: (0,)}


def rover(folder: Path, old: str = "", new: str = "") -> Device:
    """The device of the plant file, with this change of the text; raises ConfigError where it is wrong."""
    assert old in PLANT
    (folder / "plant.yaml").write_text(PLANT.replace(old, new) if old else PLANT, "utf-8")
    (folder / "recipes.py").write_text(RECIPES, "utf-8")
    device = load(folder / "plant.yaml").robots["rover"]
    assert isinstance(device, Device)
    return device


class Rig:
    """The machine under a clock that the test moves; all that the rover needs is seen 20 times a second."""

    def __init__(self, device: Device) -> None:
        assert device.driver is not None
        self.device, self.now, self.x = device, 100.0, 0.0
        self.machine = Machine([device], device.driver.settings)  # type: ignore[arg-type]
        self.found: dict[End, tuple[int, ...]] = {
            end: ids for end, ids in THERE.items() if end.kind != "publish" or "horn" in device.kind.verbs
        }
        self.said: list[Message] = []
        self.wait(0.6)

    def wait(self, s: float, *, hears: bool = True) -> None:
        end = self.now + s
        while self.now < end:
            self.now += 0.05
            self.tell(EndsFound(found=self.found))
            if hears:
                self.hear(self.x)

    def hear(self, x: Any) -> None:
        self.tell(MessageHeard(told=POSE, message=SimpleNamespace(x=x)))

    def tell(self, event: Event) -> list[Message]:
        news = self.machine.step(self.now, [event])
        self.said += news
        return news

    def told(self, id: str, verb: str, **values: Any) -> Command:
        return self.device.kind.command(id=id, robot="rover", verb=verb, values=values)

    def ask(self, command: Command) -> list[Message]:
        return self.tell(GoalRequest(command=command))

    def begin(self, id: str, x: float = 2.0) -> None:
        """Give it a way, which its server accepts."""
        self.ask(self.told(id, "go", x=x))
        self.accept(id)

    def accept(self, id: str, *, accepted: bool = True) -> None:
        self.tell(ActionSaid(end=GO, said=GoalAnswer(id=id, accepted=accepted)))

    def end(self, id: str, status: Status = Status.SUCCEEDED, code: int = 0) -> None:
        result = GoalResult(id=id, status=status, message=SimpleNamespace(code=code))
        self.tell(ActionSaid(end=GO, said=result))

    def cancelled(self, *, refused: bool = False) -> None:
        self.tell(ActionSaid(end=GO, said=CancelAnswer(refused=refused)))

    def list(self, *uuids: bytes) -> None:
        goals = tuple(ListedGoal(uuid=uuid, stamp=(1, 0), status=None) for uuid in uuids)
        self.tell(ActionSaid(end=GO, said=GoalList(goals=goals)))

    def respond(self, id: str, **fields: Any) -> None:
        self.tell(Response(id=id, message=SimpleNamespace(**fields)))

    @property
    def last(self) -> Report:
        return [each for each in self.said if isinstance(each, Report)][-1]

    def count(self, kind: type) -> int:
        return sum(isinstance(each, kind) for each in self.said)
