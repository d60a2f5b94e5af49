"""Nodes without children: those that BehaviorTree.CPP brings along, and a step of the plant."""

from __future__ import annotations

from typing import ClassVar

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from .node import FAILURE, RUNNING, SUCCESS, Node, Result
from .ports import NodePorts
from .scripts import Script


class Leaf(Node):
    """A node without children of the tree."""

    frame = False


class ConstantLeaf(Leaf):
    """It always ends so."""

    def __init__(self, name: str, result: Result) -> None:
        super().__init__(name)
        self.result = result

    def work(self) -> Result:
        return self.result


class RunScript(Leaf):
    """A script that is done."""

    def __init__(self, name: str, text: str) -> None:
        super().__init__(name)
        self.script = Script.of(text)

    def work(self) -> Result:
        self.script.run(self.scope)
        return SUCCESS


class ScriptCondition(RunScript):
    """A script that holds or does not."""

    def work(self) -> Result:
        return SUCCESS if self.script.holds(self.scope) else FAILURE


class SetBlackboard(Leaf):
    """A variable gets a value."""

    def __init__(self, name: str, given: NodePorts) -> None:
        super().__init__(name)
        self.given = given

    def work(self) -> Result:
        self.scope.set(self.given.variable("output_key"), self.given.text("value", self.scope))
        return SUCCESS


class UnsetBlackboard(Leaf):
    """A variable loses its value."""

    def __init__(self, name: str, given: NodePorts) -> None:
        super().__init__(name)
        self.given = given

    def work(self) -> Result:
        self.scope.unset(self.given.variable("key"))
        return SUCCESS


class Sleep(Leaf):
    """So many milliseconds, of the time that stands still while the cell is held."""

    def __init__(self, name: str, given: NodePorts) -> None:
        super().__init__(name)
        self.given = given
        self.until = 0.0

    def begin_anew(self) -> None:
        self.until = self.context.now + self.given.number("msec", self.scope) / 1000
        self.context.wake_at(self.until)

    def work(self) -> Result:
        if self.status is Status.FAILURE:
            return FAILURE  # by a condition that stands at it; it stays so until it is reset
        if self.begin():
            self.begin_anew()
        return SUCCESS if self.context.now >= self.until else RUNNING


class Step(Leaf):
    """A step of the plant: a command, a question, a check. `turn` counts how often it has begun."""

    counts: ClassVar[tuple[str, ...]] = ("turn",)
    RESULTS: ClassVar = {Status.SUCCESS: SUCCESS, Status.FAILURE: FAILURE, Status.RUNNING: RUNNING}

    def __init__(self, name: str, step: Behaviour) -> None:
        super().__init__(name)
        self.step = step
        self.turn = 0
        self.children.append(step)
        step.parent = self

    @property
    def below(self) -> list[Node]:
        return []

    def prepare(self) -> None:
        """Before its step begins."""

    def work(self) -> Result:
        was_running = self.status is Status.RUNNING
        self.begin()
        if not was_running:  # what has ended may be ticked again without having been reset
            self.turn += 1
            self.prepare()
        self.step.tick_once()
        return self.RESULTS[self.step.status]

    def halt(self) -> None:
        self.halt_step()
        super().halt()

    def halt_step(self) -> None:
        """End what the plant does for it, if it does something."""
        if self.step.status is Status.RUNNING:
            self.step.stop(Status.INVALID)
