"""Nodes without children: leaves of BehaviorTree.CPP, and a step of the plant."""

from __future__ import annotations

from typing import ClassVar

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.recipes.of_files import FAILS

from .node import FAILURE, RUNNING, SUCCESS, Node, Result
from .ports import NodePorts
from .scripts import Script


class Leaf(Node):
    """Node without children."""

    frame = False
    is_leaf = True


class ConstantLeaf(Leaf):
    """Leaf that always ends in the same way."""

    def __init__(self, name: str, result: Result) -> None:
        super().__init__(name)
        self.result = result

    def work(self) -> Result:
        return self.result


class AlwaysFailure(ConstantLeaf):
    """Leaf that always fails."""

    def __init__(self, name: str) -> None:
        super().__init__(name, FAILURE)
        self.title = FAILS(leaf=name)


class RunScript(Leaf):
    """Leaf that runs a script and succeeds."""

    def __init__(self, name: str, text: str) -> None:
        super().__init__(name)
        self.script = Script.of(text)

    def work(self) -> Result:
        self.script.run(self.scope)
        return SUCCESS


class ScriptCondition(RunScript):
    """Leaf that succeeds if a script is true, and fails otherwise."""

    def work(self) -> Result:
        return SUCCESS if self.script.holds(self.scope) else FAILURE


class SetBlackboard(Leaf):
    """Leaf that sets a variable."""

    def __init__(self, name: str, ports: NodePorts) -> None:
        super().__init__(name)
        self.ports = ports

    def work(self) -> Result:
        self.scope.set(self.ports.variable("output_key"), self.ports.text("value", self.scope))
        return SUCCESS


class UnsetBlackboard(Leaf):
    """Leaf that removes a variable."""

    def __init__(self, name: str, ports: NodePorts) -> None:
        super().__init__(name)
        self.ports = ports

    def work(self) -> Result:
        self.scope.unset(self.ports.variable("key"))
        return SUCCESS


class Sleep(Leaf):
    """Leaf that waits so many milliseconds, of a time that stands still while the cell is held."""

    def __init__(self, name: str, ports: NodePorts) -> None:
        super().__init__(name)
        self.ports = ports
        self.until = 0.0

    def begin_anew(self) -> None:
        self.until = self.time.now + self.ports.number("msec", self.scope) / 1000
        self.time.wake_at(self.until)

    def work(self) -> Result:
        if self.status is Status.FAILURE:
            return FAILURE  # its condition made it fail, until the node is reset
        if self.begin():
            self.begin_anew()
        return SUCCESS if self.time.now >= self.until else RUNNING


class Step(Leaf):
    """Leaf around a step of the plant: a command, a question, a check. `turn` counts its begins."""

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
        """Called before the step begins."""

    def work(self) -> Result:
        was_running = self.status is Status.RUNNING
        self.begin()
        if not was_running:  # a parent may tick a node that has ended without a reset
            self.turn += 1
            self.prepare()
        self.step.tick_once()
        return self.RESULTS[self.step.status]

    def halt(self) -> None:
        self.halt_step()
        super().halt()

    def halt_step(self) -> None:
        """Halt the step, if it runs."""
        if self.step.status is Status.RUNNING:
            self.step.stop(Status.INVALID)
