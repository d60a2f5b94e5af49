"""Invariants of zones, motion, grip and stop hold for a plant that works, and find more than their mutant."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from typing import Any

import pytest
from tests.cells import with_poses
from tests.lengths import sample

from arboleda.dispatch import evidence, whereabouts
from arboleda.dispatch.evidence import CommandVerdict
from arboleda.dispatch.ledger import Feed
from arboleda.kinds.arm import SetEffector
from arboleda.model.commands import Home
from arboleda.model.messages import Verb
from arboleda.model.plant_model import Evidence, PlantModel
from arboleda.sim.arm import ArmBody
from arboleda.sim.mobile import MobileBody
from arboleda.testing.plants import shipped
from arboleda.wire.payloads import EffectorGoal, Goal, JointsGoal, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Publication
from arboleda_proofs.simulator.invariants.grips import GRIPS
from arboleda_proofs.simulator.invariants.motion import MOTION
from arboleda_proofs.simulator.invariants.part_places import (
    done_tasks_leave_nothing_behind,
    parts_are_taken_and_put_where_they_can_be,
    recipes_end_as_they_say,
)
from arboleda_proofs.simulator.invariants.stop import STOP
from arboleda_proofs.simulator.invariants.zones import ZONES

from .watch import Watched

OF_PARTS = (
    parts_are_taken_and_put_where_they_can_be,
    done_tasks_leave_nothing_behind,
    recipes_end_as_they_say,
)
INVARIANTS = (*ZONES, *MOTION, *GRIPS, *OF_PARTS, *STOP)
ARM, MOBILE = "ra_1", "rm_sis_a"
Patch = pytest.MonkeyPatch


class Watch(Watched):
    """Judges by these invariants; an arm of its world can be told things by a stranger."""

    def __init__(self, model: PlantModel | None = None, **world: Any) -> None:
        super().__init__(INVARIANTS, model, **world)

    @property
    def body(self) -> Any:
        return self.world.boards[ARM].body

    def task(self, text: str = "sis_a palletizing", wait_s: float = 20.0) -> None:
        super().task(text, wait_s)

    def carry(self) -> None:
        """Be in the middle of the way from pick-up to place."""
        self.task(wait_s=0.0)
        self.wait(60.0, until=lambda: self.body.holding and self.body.moving)
        self.wait(0.1)

    def say(self, channel: Channel, make: Callable[..., Goal], **fields: Any) -> None:
        """A stranger with better numbers than anybody's commands ra1."""
        goal = make(**fields, seq=1, epoch=9999)
        self.world.publish(Publication(topic=topic(ARM, channel), payload=encode(goal)))
        self.wait(0.01)


def zoned() -> PlantModel:
    """Three cells whose pick-ups lie in one zone."""
    plant = shipped()
    cells = []
    for cell in plant.cells:
        assert cell.handover is not None
        pickup = replace(cell.taker.targets[cell.handover.otherwise], zones=frozenset({"centre"}))
        cells.append(with_poses(cell, pickup=pickup))
    return replace(plant, zones=("centre",), cells=tuple(cells))


def test_every_invariant_says_what_must_hold() -> None:
    for each in INVARIANTS:
        assert each.sentence.endswith("."), each.name
    assert len({each.name for each in INVARIANTS}) == len(INVARIANTS)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("model", [shipped, zoned], ids=["shipped", "zoned"])
def test_nothing_is_found_while_all_goes_well(model: Callable[[], PlantModel]) -> None:
    watch = Watch(model())
    for round in range(4):
        for cell in watch.world.model.cells:
            watch.world.request_task(f"{cell.name} 0B {3 * round % 9}")
            watch.world.request_task(f"{cell.name} palletizing")
        watch.wait(30.0)
    assert watch.found == {}


FAULTS: dict[str, Callable[[Watch], None]] = {
    "power": lambda watch: watch.world.crash(ARM),
    "mobile's power": lambda watch: watch.world.crash(MOBILE),
    "lost steps": lambda watch: watch.body.motors.lose_steps(0, 3),
    "alarm": lambda watch: watch.world.boards[ARM].fail(round(watch.world.now * 1e6)),
    "bridge": lambda watch: watch.world.crash("bridge"),
    "plant": lambda watch: watch.world.crash(),
    "stall": lambda watch: watch.world.stall(ARM, 3.0),
    "stop": lambda watch: watch.verb(Verb.STOP),
    "hold": lambda watch: watch.verb(Verb.HOLD, "sis_a"),
    "cancel": lambda watch: watch.verb(Verb.CANCEL, "sis_a"),
}


@pytest.mark.sampled(13)
@pytest.mark.parametrize(("fault", "after_s"), sample(product(FAULTS, (0.4, 1.0, 1.3, 1.6, 2.2)), every=4))
def test_nothing_is_found_when_a_fault_is_handled(fault: str, after_s: float) -> None:
    watch = Watch(zoned())
    for cell in watch.world.model.cells:
        watch.world.request_task(f"{cell.name} palletizing")
    watch.wait(after_s)
    watch.world.faults_active = 1
    FAULTS[fault](watch)
    watch.wait(10.0)
    for verb in (Verb.CLEAR, Verb.RESET, Verb.RESUME):
        watch.verb(verb, "sis_a")
    watch.verb(Verb.HOME, "ra1", wait_s=10.0)
    watch.verb(Verb.ABANDON, "sis_a", wait_s=10.0)
    assert watch.found == {}


def moved_after_a_boot_that_its_joints_show(patch: Patch) -> Watch:
    patch.setattr(whereabouts, "came_back_at_zero", lambda before, belief, report, stood: False)
    watch = Watch(shipped("sis_a", evidence=Evidence.JOINTS, assume_homed=True))
    watch.task("sis_a palletizing", wait_s=3.0)
    assert watch.body.moving
    watch.world.power_off(ARM, will_after_s=60.0)
    watch.wait(3.0)
    watch.world.power_on(ARM)
    watch.wait(10.0)
    return watch


def switched_by_itself(patch: Patch) -> Watch:
    watch = Watch()
    watch.body.switch_effector(True)
    watch.wait(1.0)
    return watch


def obeyed_a_stranger(patch: Patch) -> Watch:
    watch = Watch()
    watch.say(Channel.JOINTS, JointsGoal, q_deg=(9.0, 9.0, 0.0))
    return watch


def done_when_accepted(command: type) -> Callable[[Patch], Watch]:
    """The plant takes a command for done as soon as it hears anything."""

    def break_it(patch: Patch) -> Watch:
        rule: Any = lambda entry, belief, report: CommandVerdict(feed=Feed.DONE)  # noqa: E731
        patch.setitem(evidence.RULES, (command, Evidence.IDS), rule)
        if command is SetEffector:
            patch.setattr(ArmBody, "switch_effector", lambda self, on: None)
        watch = Watch()
        if command is Home:
            watch.task(wait_s=1.0)
            watch.world.crash(ARM)
            watch.wait(10.0)
            watch.verb(Verb.HOME, "ra1")
        watch.task()
        return watch

    return break_it


def gripped_at_home(patch: Patch) -> Watch:
    watch = Watch()
    watch.say(Channel.EFFECTOR, EffectorGoal, on=True)
    return watch


def a_part_from_nowhere(patch: Patch) -> Watch:
    watch = Watch()
    watch.body.holding = True
    watch.wait(0.5)
    return watch


def lost_for_no_reason(patch: Patch) -> Watch:
    watch = Watch()
    watch.carry()
    watch.body.lose_piece()
    watch.wait(0.5)
    return watch


def arm_runs_on(patch: Patch) -> Watch:
    patch.setattr(ArmBody, "stop", lambda self, now_us: None)
    watch = Watch()
    watch.task("sis_a palletizing", wait_s=0.45)
    watch.verb(Verb.STOP)
    return watch


def mobile_runs_on(patch: Patch) -> Watch:
    patch.setattr(MobileBody, "stop", lambda self, now_us: None)
    watch = Watch()
    watch.task("sis_a 0B 7", wait_s=1.0)
    watch.verb(Verb.STOP, wait_s=10.0)
    return watch


# each further way to break them than the bugs that are planted in tools/tests/mutants
BREAKS: list[tuple[str, Callable[[Patch], Watch]]] = [
    ("no_move_after_a_boot_that_was_told", moved_after_a_boot_that_its_joints_show),
    ("nothing_moves_unasked", switched_by_itself),
    ("nothing_moves_unasked", obeyed_a_stranger),
    ("done_is_true", done_when_accepted(SetEffector)),
    ("done_is_true", done_when_accepted(Home)),
    ("effector_on_only_for_a_part", gripped_at_home),
    ("parts_conserved", a_part_from_nowhere),
    ("parts_conserved", lost_for_no_reason),
    ("speed_never_rises_after_stop", arm_runs_on),
    ("speed_never_rises_after_stop", mobile_runs_on),
]


@pytest.mark.sampled(7)
@pytest.mark.parametrize(("name", "break_it"), BREAKS, ids=[f"{n}-{b.__name__}" for n, b in BREAKS])
def test_it_bites(name: str, break_it: Callable[[Patch], Watch], monkeypatch: Patch) -> None:
    assert name in break_it(monkeypatch).found
