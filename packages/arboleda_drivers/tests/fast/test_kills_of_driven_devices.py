"""A plant that is killed while a device behind a driver works goes by what the device still proves."""

from __future__ import annotations

import pytest

from arboleda.model.messages import TaskState, Verb
from arboleda.views import view
from arboleda_driver_faults.gripper import CarryRig
from arboleda_driver_faults.plc import BeltRig
from arboleda_driver_faults.rig import Result, Rig, World
from arboleda_driver_faults.rigs import rig_of
from arboleda_drivers.ros_action.events import ListedGoal

ORDERS = 5  # of the belt for one part: the gate, in, to the exit, the gate, a look
ELSEWHERE = bytes(range(16))  # the id of a goal that no plant made


class OneTask(World):
    """A world in which nobody does what is advised, but for the test."""

    def __init__(self, rig: Rig) -> None:
        super().__init__(rig, Result(seed=0, faults=()), tasks=1)
        self.advance(1.0)
        self.submit(rig.task(0))

    def killed_after(self, seconds: float) -> OneTask:
        self.advance(seconds)
        self.restart()
        self.advance(12.0)
        return self

    def offers(self) -> set[Verb]:
        return {each.do for each in self.plant.advice(self._cell.name) if isinstance(each.do, Verb)}

    @property
    def task(self) -> TaskState:
        return next(iter(self.disk.tasks.values())).state

    def why_held(self) -> str:
        (cell,) = view.snapshot(self.plant)["cells"]
        return str(cell["held_by"])

    def _attend(self) -> None:
        pass


@pytest.mark.sampled(12)
@pytest.mark.parametrize("protocol", ["modbus", "opcua", "s7"])
@pytest.mark.parametrize("after_s", [0.1, 0.5, 1.5, 2.2])
def test_a_plc_that_numbers_its_orders_is_given_none_of_them_twice(protocol: str, after_s: float) -> None:
    rig = rig_of(protocol)
    assert isinstance(rig, BeltRig)
    world = OneTask(rig).killed_after(after_s)
    assert world.offers() == {Verb.RESUME, Verb.ABANDON}
    world.operate(Verb.RESUME)
    assert world.advance(30.0, until=lambda: world.task is TaskState.DONE)
    assert rig.belt.taken == ORDERS


def test_an_order_that_came_from_elsewhere_leaves_only_the_end_of_the_task() -> None:
    rig = rig_of("modbus")
    assert isinstance(rig, BeltRig)
    world = OneTask(rig)
    world.advance(1.5)
    rig.belt.shown.accepted += 2
    world.killed_after(0.0)
    assert world.offers() == {Verb.ABANDON}
    assert "has taken commands of which this plant knows nothing" in world.why_held()


@pytest.mark.sampled(2)
@pytest.mark.parametrize("after_s", [0.3, 2.0])
def test_a_move_that_went_on_without_its_plant_is_resumed(after_s: float) -> None:
    world = OneTask(rig_of("ros2_control")).killed_after(after_s)
    assert world.offers() == {Verb.RESUME, Verb.ABANDON}
    world.operate(Verb.RESUME)
    assert world.advance(60.0, until=lambda: world.task is TaskState.DONE)


def test_a_goal_of_another_client_leaves_only_the_end_of_the_task() -> None:
    rig = rig_of("ros2_control")
    assert isinstance(rig, CarryRig)
    world = OneTask(rig)
    world.advance(2.0)
    later = (int(world.now) + 1, 0)
    rig.listed["arm"]["theirs"] = ListedGoal(uuid=ELSEWHERE, stamp=later, status=None)
    world.killed_after(0.0)
    assert world.offers() == {Verb.ABANDON}
    assert "arm has taken commands of which this plant knows nothing" in world.why_held()


def test_a_server_that_lists_no_goal_any_more_proves_nothing() -> None:
    rig = rig_of("ros2_control")
    assert isinstance(rig, CarryRig)
    world = OneTask(rig)
    world.advance(2.0)
    rig.listed["arm"].clear()
    world.killed_after(0.0)
    assert world.offers() == {Verb.RETRY, Verb.ABANDON}
    assert "arm does not number its commands, and proves nothing" in world.why_held()
