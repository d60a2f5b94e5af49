"""Stop, hold and cancel at every step of the storage task and of its recovery, and what is possible then."""

from __future__ import annotations

from collections.abc import Callable
from itertools import cycle, product
from typing import Any, cast

import pytest
from tests.lengths import sample

from arboleda.core import reasons
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Reason, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.sim.arm import ArmBody
from arboleda.testing import Rig
from arboleda.trees.leaves import Act, Await, Dwell
from arboleda_proofs.testing import Witness

Stage = Callable[..., tuple[Rig, Witness]]
TASK, STATION = "sis_a 1B 7", "station 7"
STEPS = [
    "system start/dwell",
    "be at node 1",
    "drive path 1B",
    "move to pick-up",
    "piece there",
    "effector on/switch",
    "effector on/dwell",
    "piece gripped",
    "move to station 7",
    "piece brought",
    "effector off/switch",
    "effector off/dwell",
    "move to home",
]
RECOVERY = [
    "recovery/settle",
    "carry back/move to pick-up",
    "carry back/effector off/switch",
    "carry back/effector off/dwell",
    "recovery/move to home",
]
GRIPPED = STEPS.index("effector on/switch")  # from here on the part is in the effector
PLACED = STEPS.index("effector off/switch")  # from here on it is in its station

levels = pytest.mark.parametrize("evidence", list(Evidence))
at_every_step_and_level = pytest.mark.parametrize(
    ("step", "evidence"),
    sample(product(STEPS, Evidence), every=4),  # of three levels: each with many steps
)
at_every_step_one_level = pytest.mark.parametrize(
    ("step", "evidence"), list(zip(STEPS, cycle(Evidence), strict=False))
)
at_every_recovery_step = pytest.mark.parametrize("step", RECOVERY)


class Scene:
    """A task in the middle of a step."""

    def __init__(self, rig: Rig, witness: Witness) -> None:
        self.rig, self.witness = rig, witness
        self.cell = rig.plant.cells["sis_a"]

    def run_to(self, step: str) -> None:
        self.rig.submit(TASK)
        self._reach(step)

    def recover_to(self, step: str) -> None:
        """Cancel the task while the part is carried, up to a step of the recovery."""
        self.run_to("move to station 7")
        self.rig.wait(0.5)
        assert self.operate(Verb.CANCEL) is None
        self._reach(step)

    def _reach(self, step: str) -> None:
        """Up to the middle of a step; a short one is caught at its beginning."""
        self.rig.wait_for("sis_a", step)
        self.rig.wait(0.05, until=lambda: not self.rig.runs("sis_a", step))
        assert self.rig.runs("sis_a", step)

    def operate(self, verb: Verb, scope: str = "sis_a") -> str | None:
        return self.rig.operate(verb, scope)

    def becomes(self, state: CellState, seconds: float) -> None:
        assert self.rig.wait(seconds, until=lambda: self.cell.state is state), (
            f"{self.cell.state.value}: {reasons.of_waiting(self.cell)}"
        )

    @property
    def stop_s(self) -> float:
        return self.rig.model.timing.stop_timeout_s

    def ended(self, seconds: float = 60.0) -> TaskChanged:
        assert self.rig.wait(seconds, until=lambda: self.cell.task is None), "it hangs"
        (change,) = self.rig.outcomes().values()
        return change

    def honest(self) -> None:
        assert (self.witness.false_successes, self.witness.illegal) == ([], [])

    @property
    def part(self) -> str:
        return self.witness.part.get("ra1", "pick-up")

    @property
    def body(self) -> ArmBody:
        return cast(ArmBody, self.rig.devices.boards["ra_1"].body)


@pytest.fixture
def scene(stage: Stage) -> Callable[[Evidence], Scene]:
    return lambda evidence: Scene(*stage(evidence, piece_check=True))


def part_after(step: str) -> str:
    """The place of the part once a task that was given up at a step is recovered."""
    return STATION if step in STEPS[PLACED:] else "pick-up"


@levels
def test_these_are_all_the_steps_that_take_time(scene: Any, evidence: Evidence) -> None:
    here = scene(evidence)
    seen: list[str] = []
    here.rig.watchers.append(lambda: seen.append(here.rig.leaf("sis_a") or ""))
    here.run_to(STEPS[0])
    timed = [node for node in here.cell.tree.iterate() if isinstance(node, (Act, Await, Dwell))]
    main = [node for node in timed if not any(up.name == "recovery" for up in ancestors(node))]
    assert here.ended().state is TaskState.DONE
    order = list(dict.fromkeys(leaf for leaf in seen if leaf))
    assert [any(leaf.endswith(f"/{step}") for leaf in order) for step in STEPS] == [True] * len(STEPS)
    assert len(order) == len(STEPS) == len(main)
    here.honest()


def ancestors(node: Any) -> list[Any]:
    return [node.parent, *ancestors(node.parent)] if node.parent else []


@pytest.mark.sampled(3)
@at_every_step_and_level
def test_stop_then_clear_reset_and_resume(scene: Any, evidence: Evidence, step: str) -> None:
    here = scene(evidence)
    here.run_to(step)
    on, mark = here.body.effector, len(here.rig.to_boards)
    assert here.operate(Verb.STOP) is None
    change = here.ended(0.0)
    assert (change.state, change.reason) == (TaskState.FAILED, Reason.STOPPED)
    assert here.operate(Verb.RESET) is not None
    here.becomes(CellState.ABORTED, here.stop_s)
    assert here.cell.trouble is None, "every board has confirmed"
    here.rig.submit("sis_a 0B 1")
    here.rig.wait(2.0)
    assert here.cell.state is CellState.ABORTED
    assert here.operate(Verb.RESUME) is not None and here.operate(Verb.RESET) is not None
    assert here.operate(Verb.CLEAR) is None
    here.becomes(CellState.STOPPED, 1.0)
    here.rig.wait(2.0)
    assert here.operate(Verb.RESUME) is not None
    assert here.operate(Verb.RESET) is None
    here.rig.wait(2.0)
    assert here.witness.motions_since(mark, here.rig.model.robots) == []
    assert here.body.effector is on, "effectors keep their state"
    assert here.cell.state is (CellState.HELD if here.cell.context.parts.holding else CellState.IDLE)
    assert not on or here.cell.state is CellState.HELD
    if here.cell.state is CellState.HELD:
        assert here.operate(Verb.RESUME) is not None
        assert here.operate(Verb.RETRY) is None
        here.becomes(CellState.IDLE, 60.0)
    here.rig.wait(2.0)
    assert here.part == part_after(step) and len(here.cell.queue) == 1
    assert here.operate(Verb.RESUME) is None
    assert here.cell.task is not None, "only now the next task starts"
    here.honest()


@pytest.mark.sampled(5)
@at_every_step_one_level
def test_hold_then_nothing(scene: Any, evidence: Evidence, step: str) -> None:
    here = scene(evidence)
    here.run_to(step)
    assert here.operate(Verb.HOLD) is None
    here.becomes(CellState.HELD, here.stop_s)
    here.rig.wait(1.0)
    told, position = len(here.rig.to_boards), here.body.motors.position
    here.rig.wait(20.0)
    assert (len(here.rig.to_boards), here.body.motors.position) == (told, position)
    assert here.cell.state is CellState.HELD and here.cell.task is not None
    assert here.cell.trouble is None
    here.honest()


@pytest.mark.sampled(3)
@at_every_step_and_level
def test_hold_then_resume_does_the_task(scene: Any, evidence: Evidence, step: str) -> None:
    here = scene(evidence)
    here.run_to(step)
    here.operate(Verb.HOLD)
    here.becomes(CellState.HELD, here.stop_s)
    here.rig.wait(2.0)
    assert here.operate(Verb.RESUME) is None
    assert here.ended().state is TaskState.DONE
    assert here.part == STATION
    here.honest()


@pytest.mark.sampled(5)
@at_every_step_one_level
@pytest.mark.parametrize("verb", [Verb.ABANDON, Verb.CANCEL])
def test_hold_then_give_up_recovers(scene: Any, evidence: Evidence, step: str, verb: Verb) -> None:
    here = scene(evidence)
    here.run_to(step)
    here.operate(Verb.HOLD)
    here.becomes(CellState.HELD, here.stop_s)
    assert here.operate(verb) is None
    change = here.ended()
    state = TaskState.CANCELLED if verb is Verb.CANCEL else TaskState.FAILED
    assert (change.state, change.reason) == (state, Reason.CANCELLED)
    assert (here.cell.state, here.part) == (CellState.IDLE, part_after(step))
    here.honest()


@pytest.mark.sampled(3)
@at_every_step_one_level
def test_hold_then_stop(scene: Any, evidence: Evidence, step: str) -> None:
    here = scene(evidence)
    here.run_to(step)
    here.operate(Verb.HOLD)
    mark = len(here.rig.to_boards)
    assert here.operate(Verb.STOP) is None
    assert here.ended(0.0).reason is Reason.STOPPED
    here.becomes(CellState.ABORTED, here.stop_s)
    here.rig.wait(5.0)
    assert here.operate(Verb.RESUME) is not None
    assert here.witness.motions_since(mark, here.rig.model.robots) == []
    here.honest()


@at_every_step_and_level
def test_cancel_recovers(scene: Any, evidence: Evidence, step: str) -> None:
    here = scene(evidence)
    here.run_to(step)
    assert here.operate(Verb.CANCEL) is None
    change = here.ended()
    assert (change.state, change.reason) == (TaskState.CANCELLED, Reason.CANCELLED)
    assert (here.cell.state, here.part) == (CellState.IDLE, part_after(step))
    here.rig.submit("sis_a 0B 1")
    assert here.cell.task is not None, "the next one starts at once"
    here.honest()


@pytest.mark.sampled(4)
@levels
@at_every_recovery_step
def test_stop_in_a_recovery(scene: Any, evidence: Evidence, step: str) -> None:
    here = scene(evidence)
    here.recover_to(step)
    mark = len(here.rig.to_boards)
    assert here.operate(Verb.STOP) is None
    assert here.ended(0.0).state is TaskState.CANCELLED
    here.becomes(CellState.ABORTED, here.stop_s)
    here.rig.wait(5.0)
    assert here.witness.motions_since(mark, here.rig.model.robots) == []
    here.honest()


@pytest.mark.sampled(6)
@levels
@at_every_recovery_step
def test_hold_in_a_recovery_then_resume(scene: Any, evidence: Evidence, step: str) -> None:
    here = scene(evidence)
    here.recover_to(step)
    assert here.operate(Verb.HOLD) is None
    here.becomes(CellState.HELD, here.stop_s)
    here.rig.wait(2.0)
    assert here.operate(Verb.RESUME) is None
    assert here.ended().state is TaskState.CANCELLED
    assert (here.cell.state, here.part) == (CellState.IDLE, "pick-up")
    here.honest()


@pytest.mark.sampled(4)
@levels
@at_every_recovery_step
def test_cancel_in_a_recovery_lets_it_run_to_its_end(scene: Any, evidence: Evidence, step: str) -> None:
    here = scene(evidence)
    here.recover_to(step)
    here.operate(Verb.CANCEL)
    assert here.ended().state is TaskState.CANCELLED
    assert (here.cell.state, here.part) == (CellState.IDLE, "pick-up")
    here.honest()
