"""Way out for a machine that needs homing: its motion is asked as one, a person's word as a word."""

from __future__ import annotations

import pytest

from arboleda.model.advice import Advice
from arboleda.model.messages import OperatorRequest, Verb
from arboleda_driver_faults.rig import Result, World
from arboleda_driver_faults.rigs import rig_of


class Left(World):
    """A world with a robot that was ready; from then on nobody does what is advised."""

    def __init__(self, name: str) -> None:
        self._is_left = False
        super().__init__(rig_of(name), Result(seed=0, faults=()), tasks=1)
        assert self.advance(30.0, until=lambda: not self.plant.advice(self._cell.name))
        self._is_left = True

    def _attend(self) -> None:
        if not self._is_left:
            super()._attend()

    def fails(self, fault: str) -> None:
        """Have a task fail by a fault that is over after it."""
        self.submit(self.rig.task(0))
        self.advance(1.0)
        self.rig.faults.switch(fault, on=True)
        self.advance(20.0)
        self.rig.faults.switch(fault, on=False)
        self.advance(5.0)

    @property
    def next_act(self) -> Advice:
        return self.plant.advice(self._cell.name)[0]

    def home(self, *, by_hand: bool) -> str:
        """Home the robot; returns why not, or ""."""
        robot = self.rig.robots[0].name
        request = OperatorRequest(at=self.now, verb=Verb.HOME, scope=robot, by_hand=by_hand)
        return str(self.plant.refusal(request) or "")


def test_a_machine_that_homes_out_of_its_fault_moves_and_is_asked_so() -> None:
    world = Left("gcode-grbl")
    world.fails("hard_limit")
    assert (world.next_act.do, world.next_act.moves) == (Verb.HOME, ("gantry",))


@pytest.mark.parametrize("name", ["gcode-limp", "gcode-marlin-limp"])
def test_of_a_machine_without_switches_a_person_says_that_it_stands_at_its_zero(name: str) -> None:
    world = Left(name)
    world.fails("boot")
    assert (world.next_act.do, world.next_act.by_hand, world.next_act.moves) == (Verb.HOME, True, ())
    assert world.home(by_hand=True) == ""
    told = "gantry finds no reference by itself; put it at its zero and say: home gantry --by-hand"
    assert world.home(by_hand=False) == told
