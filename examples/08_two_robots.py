"""Lesson 8: two arms, each started when its own machine says so, and a place that only one may be in."""

from __future__ import annotations

from importlib import import_module

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence

from arboleda_class.lessons import spoken

lesson = import_module("02_first_tree")

STARTS = ((0.0, "ra1"), (1.0, "ra2"), (1.5, "ra1"))  # simulated s, arm: ra1 is at work when its second comes


class Zone:
    """A place for one arm at a time; first come, first served."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.line: list[str] = []  # who is in it, then who waits

    def ask(self, arm: str) -> bool:
        """Get in line; whether the arm is in the zone."""
        if arm not in self.line:
            self.line.append(arm)
        return self.line[0] == arm

    def leave(self, arm: str) -> None:
        """Get out, or out of the line; nothing happens where the arm is in neither."""
        if arm in self.line:
            self.line.remove(arm)


class Take(Behaviour):
    """RUNNING until the arm has the zone; left early, the arm waits no longer."""

    def __init__(self, arm: str, zone: Zone, clock: lesson.Clock) -> None:
        super().__init__(f"{arm}: take {zone.name}")
        self.arm = arm
        self.zone = zone
        self.clock = clock

    def initialise(self) -> None:
        if not self.zone.ask(self.arm):
            self.clock.say(f"{self.arm}: waits for {self.zone.name}, {self.zone.line[0]} is in it")

    def update(self) -> Status:
        if not self.zone.ask(self.arm):
            return Status.RUNNING
        self.clock.say(f"{self.name}")
        return Status.SUCCESS

    def terminate(self, new_status: Status) -> None:
        if self.status is Status.RUNNING and new_status is Status.INVALID:
            self.zone.leave(self.arm)


class Leave(Behaviour):
    """Give the zone back, once the arm is outside."""

    def __init__(self, arm: str, zone: Zone, clock: lesson.Clock) -> None:
        super().__init__(f"{arm}: leave {zone.name}")
        self.arm = arm
        self.zone = zone
        self.clock = clock

    def update(self) -> Status:
        self.zone.leave(self.arm)
        self.clock.say(self.name)
        return Status.SUCCESS


class Cell:
    """An arm, the starts that wait for it, and the tree that runs."""

    def __init__(self, arm: str, zone: Zone, clock: lesson.Clock) -> None:
        self.arm = arm
        self.clock = clock
        self.waiting = 0
        self.done = 0
        self.tree = self._cycle(zone)

    def start(self) -> None:
        """A start during a cycle is kept for later."""
        self.waiting += 1
        busy = self.tree.status is Status.RUNNING
        self.clock.say(f"{self.arm}: start" + (", kept until this cycle is over" if busy else ""))

    def tick(self) -> None:
        """One tick where there is work: it returns at once, so no arm ever waits for another's tree."""
        if self.tree.status is not Status.RUNNING:
            if not self.waiting:
                return
            self.waiting -= 1
        self.tree.tick_once()
        self.done += self.tree.status is Status.SUCCESS

    @property
    def busy(self) -> bool:
        return self.waiting > 0 or self.tree.status is Status.RUNNING

    def _cycle(self, zone: Zone) -> Behaviour:
        arm, clock = self.arm, self.clock
        children = [
            lesson.Timed(f"{arm}: move to pick-up", clock, 1.0),
            Take(arm, zone, clock),
            lesson.Timed(f"{arm}: place in {zone.name}", clock, 1.5),
            lesson.Timed(f"{arm}: move home", clock, 1.0),
            Leave(arm, zone, clock),
        ]
        return Sequence(arm, memory=True, children=children)


def main() -> None:
    clock, zone, starts = lesson.Clock(), Zone("middle"), list(STARTS)
    cells = {arm: Cell(arm, zone, clock) for arm in ("ra1", "ra2")}
    together = 0.0
    while starts or any(cell.busy for cell in cells.values()):
        while starts and starts[0][0] <= clock.now:
            cells[starts.pop(0)[1]].start()
        for cell in cells.values():
            cell.tick()
        together += lesson.TICK_S * all(cell.tree.status is Status.RUNNING for cell in cells.values())
        clock.now += lesson.TICK_S
    cycles = ", ".join(f"{arm} {cell.done}" for arm, cell in cells.items())
    print(f"\ncycles done: {cycles}; both arms were in a cycle for {together:g} s")


if __name__ == "__main__":
    spoken(main)
