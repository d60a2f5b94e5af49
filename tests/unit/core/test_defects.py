"""What a report cannot say is ignored; what a tree, a rule or a verb raises holds one cell and no other."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence

from arboleda.core import reasons
from arboleda.core.cell import CellRun
from arboleda.core.operator import Operator
from arboleda.core.plant import Plant
from arboleda.dispatch import evidence
from arboleda.dispatch.ledger import Feed, Ledger
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Stop, StopMode
from arboleda.model.messages import (
    InternalError,
    MotionState,
    OperatorAnswer,
    OperatorRequest,
    Reason,
    Shutdown,
    TaskChanged,
    Undelivered,
    Verb,
)
from arboleda.model.plant_model import Evidence
from arboleda.testing.storage_layout import StorageLayout
from arboleda.trees.leaves import Act

MOVING, STILL = MotionState.MOVING, MotionState.STOPPED
Make = Callable[[Evidence], Any]
FOREIGN: dict[str, tuple[str, dict[str, Any]]] = {
    "a mobile has no effector": ("rm_sis_c", {"effector": True}),
    "nor says that it is off": ("rm_sis_c", {"effector": False}),
    "a mobile has no piece sensor": ("rm_sis_c", {"piece": True}),
    "a mobile has no joints": ("rm_sis_c", {"q": (0.0, 0.0, 0.0)}),
    "a node is on the grid": ("rm_sis_c", {"node": 9}),
    "and not below it": ("rm_sis_c", {"node": -1}),
    "an arm stands on no node": ("ra1", {"node": 0}),
    "an arm has no more joints": ("ra1", {"q": (0.0, 0.0, 0.0, 0.0)}),
    "nor fewer": ("ra1", {"q": ()}),
}


class Boom(Behaviour):
    """A leaf that raises when it is ticked, or when it is left."""

    def __init__(self, *, at_end: bool = False) -> None:
        super().__init__("boom")
        self.at_end = at_end

    def update(self) -> Status:
        if self.at_end:
            return Status.RUNNING
        raise RuntimeError("by design")

    def terminate(self, new_status: Status) -> None:
        if self.at_end:
            raise RuntimeError("by design")


def exploding(hand: Make, *leaves: Callable[[Any], Behaviour]) -> Any:
    """A plant whose palletizing recipe is these leaves, in a row."""
    plant = hand(Evidence.IDS)
    cell = plant.plant.cells["sis_a"]

    def build(order: Any, context: Any) -> Behaviour:
        return Sequence("boom", memory=True, children=[leaf(context) for leaf in leaves])

    plant.plant = Plant(plant.plant.model, epoch=7, now=plant.now, recipes={"palletizing": build})
    assert cell is not plant.plant.cells["sis_a"]
    plant.awake()
    return plant


def moving(context: Any) -> Behaviour:
    """A leaf that drives the arm."""
    cell = context.cell
    layout = StorageLayout(cell)

    def make(id: str) -> MoveJoints:
        return MoveJoints(id=id, robot=layout.arm.name, q=layout.pickup.q)

    return Act("move", context, make, "moving")


def cell_of(plant: Any, name: str) -> CellRun:
    return plant.plant.cells[name]


def driving(hand: Make, level: Evidence = Evidence.IDS) -> Any:
    """Two cells whose mobiles drive."""
    plant = hand(level)
    plant.awake()
    for cell in ("sis_a", "sis_b"):
        plant.submit(f"{cell} {StorageLayout(plant.plant.model.cell(cell)).paths[0].code} 3")
    plant.wait(0.2)
    assert len(plant.commands(FollowPath)) == 2
    return plant


def operate(plant: Any, verb: Verb, scope: str = "") -> str | None:
    plant._step([OperatorRequest(at=plant.now, verb=verb, scope=scope)])
    return plant.commands(OperatorAnswer)[-1].refusal


@pytest.mark.parametrize("level", list(Evidence))
@pytest.mark.parametrize(("robot", "said"), FOREIGN.values(), ids=FOREIGN)
def test_what_such_a_robot_cannot_say_is_ignored(
    hand: Make, robot: str, said: dict[str, Any], level: Evidence
) -> None:
    plant = hand(level)
    plant.awake()
    before = vars(plant.plant.dispatcher.beliefs[robot]).copy()
    plant.tell(robot, state=MOVING, **said)
    assert vars(plant.plant.dispatcher.beliefs[robot]) == before
    assert plant.plant.dispatcher.ledger.ignored["report"] == 1
    assert not plant.commands(InternalError)


def test_a_leaf_that_raises_holds_its_cell_and_the_error_is_handed_out_whole(hand: Make) -> None:
    plant = exploding(hand, lambda context: Boom())
    plant.submit("sis_a palletizing")
    assert cell_of(plant, "sis_a").state is CellState.HELD
    assert plant.commands(TaskChanged)[-1].reason is Reason.INTERNAL
    (told,) = plant.commands(InternalError)
    assert told.cell == "sis_a" and told.error.__traceback__ is not None


def test_a_leaf_that_raises_when_it_is_left_does_not_keep_what_moves_from_its_halt(hand: Make) -> None:
    plant = exploding(hand, moving)
    plant.submit("sis_a palletizing")
    assert plant.commands(MoveJoints)
    cell_of(plant, "sis_a").tree.children.append(Boom(at_end=True))
    cell_of(plant, "sis_a").tree.children[-1].status = Status.RUNNING
    assert operate(plant, Verb.STOP, "sis_a") is None
    assert StopMode.LATCH in [stop.mode for stop in plant.commands(Stop)]
    assert cell_of(plant, "sis_a").state is CellState.ABORTING
    assert plant.commands(InternalError)


def broken_rule(*args: Any) -> None:
    raise ZeroDivisionError("by design")


def test_a_rule_that_raises_holds_its_cell_and_halts_what_moves(
    hand: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    plant = driving(hand)
    monkeypatch.setitem(evidence.RULES, (FollowPath, Evidence.IDS), broken_rule)
    for _ in range(3):
        plant.tell("rm_sis_a", state=MOVING, node=0)
    monkeypatch.undo()
    held = cell_of(plant, "sis_a")
    assert (held.state, held.trouble.reason) == (CellState.HELD, Reason.INTERNAL)
    assert "retry sis_a or abandon sis_a" in str(reasons.of_hold(held))
    assert [stop.robot for stop in plant.commands(Stop)] == ["rm_sis_a"]
    assert len(plant.commands(InternalError)) == 1
    assert plant.states()[-1] == "failed" and cell_of(plant, "sis_b").state is CellState.EXECUTE


@pytest.mark.parametrize("verb", [Verb.RETRY, Verb.ABANDON])
def test_a_cell_that_is_held_for_a_defect_can_be_got_going_again(
    hand: Make, monkeypatch: pytest.MonkeyPatch, verb: Verb
) -> None:
    plant = driving(hand)
    monkeypatch.setitem(evidence.RULES, (FollowPath, Evidence.IDS), broken_rule)
    plant.tell("rm_sis_a", state=MOVING, node=0)
    monkeypatch.undo()
    for _ in range(2):
        plant.tell("rm_sis_a", state=STILL, node=0)
    assert operate(plant, verb, "sis_a") is None
    home = StorageLayout(plant.plant.model.cell("sis_a")).home.q
    for _ in range(30):
        last = plant.commands(MoveJoints)[-1].id if plant.commands(MoveJoints) else None
        plant.tell("ra1", after=0.1, state=STILL, q=home, accepted=last, done=last)
    assert cell_of(plant, "sis_a").state is CellState.IDLE
    assert operate(plant, Verb.RESUME, "sis_a") is None


def test_a_rule_that_raises_in_a_held_cell_ends_its_task(hand: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    plant = driving(hand)
    assert operate(plant, Verb.HOLD, "sis_a") is None
    monkeypatch.setattr(evidence, "judge", broken_rule)
    plant.tell("rm_sis_a", state=MOVING, node=0)
    held = cell_of(plant, "sis_a")
    assert (held.state, held.task, held.trouble.reason) == (CellState.HELD, None, Reason.INTERNAL)


def test_a_deadline_that_raises_holds_its_cell_only(hand: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    plant = driving(hand, Evidence.STATE)
    sound = Ledger.feed

    def broken(ledger: Ledger, id: str, feed: Feed, *rest: Any) -> None:
        failure = rest[-1]
        if failure and failure.reason is Reason.DEADLINE and "rm_sis_a" in str(failure.sentence):
            broken_rule()
        sound(ledger, id, feed, *rest)

    monkeypatch.setattr(Ledger, "feed", broken)
    plant.wait(60.0)
    assert [told.cell for told in plant.commands(InternalError)] == ["sis_a"]
    assert cell_of(plant, "sis_a").trouble.reason is Reason.INTERNAL


def test_a_cell_that_raises_on_its_own_is_held_and_the_others_advance(
    hand: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    sound = CellRun.advance

    def broken(run: CellRun, leave: Any, *, woken: bool) -> bool:
        return broken_rule() or False if run.cell.name == "sis_a" else sound(run, leave, woken=woken)

    monkeypatch.setattr(CellRun, "advance", broken)
    plant.submit("sis_a 1C 3")
    plant.submit("sis_b 1C 3")
    plant.wait(1.0)
    assert cell_of(plant, "sis_a").state is CellState.HELD
    assert [path.robot for path in plant.commands(FollowPath)] == ["rm_sis_b"]
    assert len(plant.commands(InternalError)) == 1


def test_a_task_is_the_business_of_the_cell_that_takes_it(
    hand: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    sound, advanced = CellRun.advance, set()

    def noted(run: CellRun, leave: Any, *, woken: bool) -> bool:
        advanced.add(run.cell.name)
        return sound(run, leave, woken=woken)

    monkeypatch.setattr(CellRun, "advance", noted)
    before = dict(plant.plant.revisions)
    plant.submit("sis_b 1C 3")
    changed = {name for name, number in plant.plant.revisions.items() if number != before[name]}
    assert advanced == changed == {"sis_b"}


def test_cells_that_never_come_to_rest_are_held(hand: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    plant = hand(Evidence.IDS)
    sound = CellRun.advance

    def restless(run: CellRun, leave: Any, *, woken: bool) -> bool:
        return sound(run, leave, woken=woken) or (run.cell.name == "sis_a" and run.state is CellState.IDLE)

    monkeypatch.setattr(CellRun, "advance", restless)
    plant.awake()
    assert cell_of(plant, "sis_a").trouble.reason is Reason.INTERNAL
    assert cell_of(plant, "sis_b").state is CellState.IDLE


def test_a_stop_that_raises_in_one_cell_stops_the_others(hand: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    plant = driving(hand)
    sound = CellRun.stop

    def broken(run: CellRun) -> None:
        return broken_rule() if run.cell.name == "sis_a" else sound(run)

    monkeypatch.setattr(CellRun, "stop", broken)
    operate(plant, Verb.STOP)
    stopped = {stop.robot for stop in plant.commands(Stop) if stop.mode is StopMode.LATCH}
    assert stopped == set(plant.plant.model.robots)
    assert cell_of(plant, "sis_a").state is CellState.HELD
    assert cell_of(plant, "sis_b").state is CellState.ABORTING


def test_whoever_asks_for_what_raises_is_answered(hand: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    monkeypatch.setattr(Operator, "act", broken_rule)
    refusal = operate(plant, Verb.HOLD)
    assert refusal is not None and "internal error" in str(refusal)
    monkeypatch.setattr(type(plant.plant.intake), "task", broken_rule)
    plant.submit("sis_a 0B 7")
    assert "internal error" in str(plant.commands(TaskChanged)[-1].sentence)
    assert [told.cell for told in plant.commands(InternalError)] == ["", ""]


def test_a_plant_ends_though_a_cell_raises(hand: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    plant = driving(hand)
    sound = CellRun.close

    def broken(run: CellRun, *, drops_waiting: bool) -> None:
        return broken_rule() if run.cell.name == "sis_a" else sound(run, drops_waiting=drops_waiting)

    monkeypatch.setattr(CellRun, "close", broken)
    plant._step([Shutdown(at=plant.now)])
    assert {stop.robot for stop in plant.commands(Stop)} == {"rm_sis_a", "rm_sis_b"}


def test_a_word_that_a_command_did_not_leave_names_a_robot_of_the_plant_or_nobody(hand: Make) -> None:
    plant = driving(hand)
    plant._step([Undelivered(at=plant.now, id="7-1", robot="nobody", sentence="gone")])
    assert cell_of(plant, "sis_a").state is CellState.EXECUTE
