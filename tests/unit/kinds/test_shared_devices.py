"""A device that two cells share: one of them has it at a time, whatever falls silent or is stopped."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import pytest
from tests.following import advised, follow, works

from arboleda.core.plant import Plant
from arboleda.kinds import motion
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Reason, TaskState, Verb
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.recipe import Recipe
from arboleda.model.sentence import NOTHING
from arboleda.recipes import Choice, Kit, parallel, recipe, work
from arboleda.recipes.errors import RecipeError
from arboleda.trees.hand_over import HandOver
from arboleda.trees.tree_run import step_of

from ...plants import device_of, kind_of, made
from .lab import Bench
from .tending import LAMP

LIFT = kind_of(
    "lift",
    {"at": ["low", "high"]},
    up=motion(sets={"at": "high"}, takes_s=2.0, at_most_s=6.0),
    down=motion(sets={"at": "low"}, takes_s=2.0, at_most_s=6.0),
)


@recipe("ride")
def ride(cell: Kit):  # type: ignore[no-untyped-def]
    """A lamp, a ride up and down with a wait between, another lamp."""
    lift, lamp = cell.devices("lift", "lamp")
    return work(
        lamp.light(on=True), lift.up(), cell.wait(2.0), lift.down(), lamp.light(on=False), cell.wait(4.0)
    )


def plant(*recipes: Recipe, wait_s: float = 30.0) -> PlantModel:
    """`below` and `above`, each with a lamp of its own, and the lift that both have."""
    lift = device_of(LIFT)
    cells = []
    for name in ("below", "above"):
        lamp = device_of(LAMP, f"{name}_lamp")
        members = (("lamp", lamp), ("lift", lift))
        cell = Cell(name=name, queue_limit=5, members=members, shared=("lift",), zone_wait_s=wait_s)
        cells.append(replace(cell, recipes=recipes or (ride,)))
    return PlantModel(name="shop", cells=tuple(cells))


def riding(model: PlantModel | None = None) -> Bench:
    """The cell below has the lift, and it is on its way up."""
    here = Bench(model or plant())
    here.submit("below ride")
    assert here.wait(10.0, lambda: holder(here) == "below" and here.boards["lift"].body.moving)
    return here


def holder(here: Bench) -> str | None:
    return here.plant.zones.holder("lift")


def state_of(here: Bench, cell: str) -> TaskState | None:
    """How the last task of a cell stands."""
    found = [each.state for each in here.changes if each.cell == cell]
    return found[-1] if found else None


def ended(here: Bench, *cells: str) -> Callable[[], bool]:
    over = (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED)
    return lambda: all(state_of(here, cell) in over for cell in cells)


def waits_for(here: Bench, cell: str) -> str:
    """What the running step of a cell says of itself."""
    tip = here.plant.cells[cell].tree.tip()  # type: ignore[union-attr]
    return str(tip.feedback_message) if tip else ""


def test_two_cells_have_it_one_after_the_other_each_from_its_first_use_to_its_last() -> None:
    here = Bench(plant())
    here.submit("below ride")
    here.submit("above ride")
    seen: list[str | None] = []
    while not ended(here, "below", "above")():
        here.wait(0.05)
        seen.append(holder(here))
    assert {state_of(here, "below"), state_of(here, "above")} == {TaskState.DONE}
    assert [each for each in here.told if each.startswith("lift")] == ["lift up", "lift down"] * 2
    turns = [now for before, now in pairwise([None, *seen]) if now != before]
    assert turns == ["below", "above", None]
    assert here.told.index("below_lamp light") < here.told.index("lift up")


def test_who_waits_says_for_what_and_which_cell_has_it() -> None:
    here = riding()
    here.submit("above ride")
    here.wait(1.0)
    assert waits_for(here, "above") == "waits for lift, which below holds"


@recipe("both")
def both(cell: Kit):  # type: ignore[no-untyped-def]
    """Hoist and lift are used together."""
    return work(cell.using(["hoist", "lift"], cell.device("hoist").up(), cell.device("hoist").down()))


@recipe("alone")
def alone(cell: Kit, role=Choice("hoist", "lift")):  # type: ignore[no-untyped-def]
    """One of them is used."""
    return work(cell.using(role, cell.device(role).up(), cell.device(role).down()))


def hoisting() -> Bench:
    """Three cells that share a hoist and a lift: `one` has the lift, and `two` waits for both."""
    shared = [(name, device_of(LIFT, name)) for name in ("hoist", "lift")]
    cell = Cell(name="one", queue_limit=5, members=tuple(shared), shared=("hoist", "lift"), zone_wait_s=30.0)
    cells = [replace(cell, name=name, recipes=(both, alone)) for name in ("one", "two", "three")]
    here = Bench(PlantModel(name="shop", cells=tuple(cells)))
    for task in ("one alone lift", "two both"):
        here.submit(task)
        here.wait(0.5)
    return here


def test_a_cell_that_waits_names_who_holds_a_device_before_who_asked_for_one_earlier() -> None:
    here = hoisting()
    here.submit("three both")
    here.wait(0.5)
    assert waits_for(here, "three") == "waits for lift, which one holds"


def test_a_cell_that_waits_names_who_got_its_device_meanwhile() -> None:
    here = hoisting()
    here.submit("three alone hoist")
    here.wait(0.5)
    assert waits_for(here, "three") == "waits for hoist, which two asked for before"
    assert here.wait(10.0, lambda: here.plant.zones.holder("hoist") == "two")
    assert waits_for(here, "three") == "waits for hoist, which two holds"


def test_a_cell_that_cannot_ask_yet_for_a_device_that_no_cell_holds_says_why(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(HandOver, "is_as_left", lambda self, device: False)
    here = Bench(plant())
    here.submit("above ride")
    here.wait(1.0)
    assert waits_for(here, "above") == "waits for lift, which no cell holds and which may still hold a part"


def test_who_waits_too_long_fails_and_names_the_cell_that_has_it() -> None:
    here = riding(plant(wait_s=1.5))
    here.submit("above ride")
    assert here.wait(4.0, ended(here, "above"))
    change = next(each for each in reversed(here.changes) if each.cell == "above")
    assert change.reason is Reason.ZONE_UNAVAILABLE
    assert str(change.sentence) == "above: lift, which below holds, was not free within 1.5 s"
    assert here.wait(20.0, ended(here, "below"))
    assert state_of(here, "below") is TaskState.DONE


def test_that_another_cell_moves_it_does_not_keep_a_cell_from_beginning() -> None:
    here = riding()
    assert works(here, "above")
    here.submit("above ride")
    assert here.wait(1.0, lambda: "above_lamp light" in here.told)


def test_a_cell_cannot_command_it_before_it_has_it_whatever_the_tree_says() -> None:
    @recipe("rude")
    def rude(cell: Kit):  # type: ignore[no-untyped-def]
        step = cell.device("lift").up()
        step.uses = None  # so that nothing is taken
        return step

    here = Bench(plant(rude))
    here.submit("below rude")
    assert here.wait(5.0, ended(here, "below"))
    assert here.changes[-1].reason is Reason.ZONE_UNAVAILABLE
    assert "below does not hold lift, which cells share" in str(here.changes[-1].sentence)
    assert "lift up" not in here.told


def test_what_stood_still_already_confirms_a_stop() -> None:
    here = Bench(plant())
    here.wait(1.0)
    here.operate(Verb.STOP, "below")
    here.wait(1.0)
    assert here.plant.cells["below"].state is CellState.ABORTED
    assert here.plant.cells["below"].trouble is None


def test_a_silent_one_stays_with_its_cell_until_it_is_heard_again() -> None:
    here = riding()
    here.power_off("lift")
    assert here.wait(20.0, ended(here, "below"))
    assert state_of(here, "below") is TaskState.FAILED
    assert holder(here) == "below"
    assert here.plant.zones.is_quarantined("lift")
    here.power_on("lift")
    assert here.wait(10.0, lambda: holder(here) is None)


def test_an_operator_frees_a_silent_one_once_its_cell_no_longer_uses_it() -> None:
    here = riding()
    here.operate(Verb.HOLD, "below")
    here.wait(1.0)
    here.power_off("lift")
    here.wait(1.0)
    refusal = here.operate(Verb.OVERRIDE, "lift")
    assert "below has not given up its work with lift" in str(refusal)
    here.operate(Verb.STOP, "below")
    here.wait(6.0)
    assert here.operate(Verb.OVERRIDE, "lift") is None
    assert holder(here) is None


def test_the_stop_of_a_cell_stops_it_too_and_says_so() -> None:
    here = Bench(plant())
    here.submit("above ride")
    assert here.wait(10.0, lambda: here.boards["lift"].body.moving)
    here.operate(Verb.STOP, "below")
    here.wait(1.0)
    assert not here.boards["lift"].body.moving
    sentence = str(here.plant.acts[-1].sentence)
    assert sentence == "stop below; lift, shared with above, stops too and stays so until reset below"
    assert here.wait(20.0, ended(here, "above"))
    assert state_of(here, "above") is TaskState.FAILED
    assert here.plant.cells["above"].state is not CellState.ABORTED


def test_a_cell_is_led_to_the_stop_of_the_other_that_keeps_it() -> None:
    here = Bench(plant())
    here.wait(1.0)
    here.operate(Verb.STOP, "below")
    here.wait(1.0)
    (row,) = [each for each in here.snapshot()["cells"] if each["name"] == "above"]
    assert str(row["not_ready"]) == "lift is stopped (latched); clear below"
    assert advised(here, "above") == ["clear below"]
    assert follow(here, "above") == ["clear below", "reset below"]
    here.submit("above ride")
    assert here.wait(30.0, ended(here, "above"))
    assert state_of(here, "above") is TaskState.DONE


def test_it_is_used_again_only_once_every_cell_that_was_stopped_is_reset() -> None:
    here = Bench(plant())
    here.wait(1.0)
    here.operate(Verb.STOP, "below")
    here.wait(1.0)
    here.submit("above ride")
    assert here.operate(Verb.CLEAR, "below") is None
    here.wait(5.0)
    assert "lift up" not in here.told
    assert "lift was stopped" in str(here.plant.cells["above"].not_ready)
    assert here.operate(Verb.RESET, "below") is None
    assert here.wait(30.0, ended(here, "above"))
    assert state_of(here, "above") is TaskState.DONE


def test_two_stops_keep_it_until_both_are_cleared() -> None:
    here = Bench(plant())
    here.wait(1.0)
    here.operate(Verb.STOP, "below")
    here.operate(Verb.STOP, "above")
    here.wait(1.0)
    assert here.operate(Verb.CLEAR, "below") is None
    here.wait(1.0)
    assert here.plant.cells["below"].state is CellState.STOPPED
    assert "lift" in here.plant.dispatcher.latches.stopped
    assert here.operate(Verb.RESET, "below") is None
    assert advised(here, "below") == ["clear above", "resume below"]
    assert "lift stays stopped while above is" in str(here.operate(Verb.CLEAR, "lift"))
    assert here.operate(Verb.CLEAR, "above") is None
    here.wait(1.0)
    assert "lift" not in here.plant.dispatcher.latches.stopped
    assert follow(here, "below") == ["reset above", "resume below"]


def test_a_cell_is_cleared_robot_by_robot_though_another_one_keeps_what_they_share_stopped() -> None:
    here = Bench(plant())
    here.wait(1.0)
    here.operate(Verb.STOP, "below")
    here.operate(Verb.STOP, "above")
    here.wait(1.0)
    assert here.operate(Verb.CLEAR, "below_lamp") is None
    assert here.plant.cells["below"].state is CellState.STOPPED
    assert here.plant.cells["above"].state is CellState.ABORTED
    assert "lift" in here.plant.dispatcher.latches.stopped


def test_a_clear_that_got_lost_is_given_again(monkeypatch: pytest.MonkeyPatch) -> None:
    here = Bench(plant())
    here.wait(1.0)
    here.operate(Verb.STOP, "below")
    here.wait(1.0)
    with monkeypatch.context() as deaf:
        deaf.setattr(here.boards["lift"], "receive", lambda now_us, event: None)
        assert here.operate(Verb.CLEAR, "below") is None
        here.wait(0.5)
    here.wait(2.0)
    assert here.plant.cells["below"].state is CellState.CLEARING
    assert here.operate(Verb.CLEAR, "below") is None
    here.wait(2.0)
    assert here.plant.cells["below"].state is CellState.STOPPED
    assert not here.boards["lift"].latched


def test_the_stop_of_the_whole_plant_is_cleared_at_once() -> None:
    here = riding()
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET, Verb.RESUME):
        here.wait(1.0)
        assert here.operate(verb) is None
    here.wait(1.0)
    assert works(here, "below")
    assert works(here, "above")


def test_its_own_stop_stops_all_who_share_it() -> None:
    here = riding()
    here.operate(Verb.STOP, "lift")
    here.wait(6.0)
    assert {run.state for run in here.plant.cells.values()} == {CellState.ABORTED}
    assert here.operate(Verb.CLEAR, "lift") is None
    assert "lift" not in here.plant.dispatcher.latches.stopped


@pytest.mark.parametrize("count", range(1, 6))
def test_after_a_stop_at_any_time_the_advice_leads_both_back(count: int) -> None:
    here = Bench(plant())
    here.submit("below ride")
    here.submit("above ride")
    assert here.wait(60.0, lambda: len([each for each in here.told if "stop" not in each]) >= count)
    here.operate(Verb.STOP, "below")
    here.wait(1.0)
    follow(here, "below")
    follow(here, "above")
    for cell in ("below", "above"):
        here.submit(f"{cell} ride")
        assert here.wait(60.0, ended(here, cell))
        assert state_of(here, cell) is TaskState.DONE
    assert holder(here) is None


def test_a_cell_that_was_not_stopped_does_not_begin_so_after_a_restart() -> None:
    here = Bench(plant())
    here.wait(1.0)
    here.operate(Verb.STOP, "below")
    again = Plant(here.model, epoch=9, now=0.0, memory=here.disk.facts)
    assert again.cells["below"].state is CellState.ABORTED
    assert again.cells["above"].state is CellState.IDLE
    assert "lift" in again.dispatcher.latches.stopped


def test_what_a_cell_had_before_a_restart_is_nobodys_before_it_is_heard() -> None:
    here = riding()
    again = Plant(here.model, epoch=9, now=0.0, memory=here.disk.facts)
    assert again.zones.holder("lift") == "below"
    assert again.zones.is_quarantined("lift")


def test_after_a_restart_it_is_of_the_cell_that_got_it_while_it_waited_for_it() -> None:
    here = riding()
    here.submit("above ride")
    assert here.wait(30.0, lambda: holder(here) == "above")
    again = Plant(here.model, epoch=9, now=0.0, memory=here.disk.facts)
    assert again.zones.holder("lift") == "above"


def test_a_recipe_can_say_itself_how_long_it_needs_it() -> None:
    @recipe("twice")
    def twice(cell: Kit):  # type: ignore[no-untyped-def]
        lift = cell.device("lift")
        return work(cell.using("lift", lift.up()), cell.wait(3.0), cell.using(["lift"], lift.down()))

    here = Bench(plant(twice))
    here.submit("below twice")
    assert here.wait(10.0, lambda: holder(here) == "below")
    here.wait(0.5)
    assert str(step_of(here.plant.cells["below"].tree)) == "lift up"
    assert here.wait(5.0, lambda: holder(here) is None)
    assert here.boards["lift"].body.facts["at"] == "high"  # type: ignore[attr-defined]
    assert here.wait(10.0, ended(here, "below"))
    assert state_of(here, "below") is TaskState.DONE


@pytest.mark.parametrize(
    ("build", "why"),
    [
        (lambda cell, lift: cell.using("lift", cell.using("lift", lift.up())), "another using"),
        (lambda cell, lift: work(cell.using("lift", lift.up()), lift.down()), "outside of using"),
        (lambda cell, lift: cell.using("lamp", lift.up()) and work(), None),
        (
            lambda cell, lift: parallel(cell.using("lift", lift.up()), cell.using("lift", lift.down())),
            "two branches of a parallel",
        ),
    ],
)
def test_what_would_let_a_cell_wait_with_something_in_its_hands_is_refused(
    build: Callable[..., object], why: str | None
) -> None:
    wrong = made("wrong", lambda cell: build(cell, cell.device("lift")))
    here = Bench(plant(wrong))
    context = here.plant.cells["below"].context
    order = here.plant.intake.task("below wrong", lambda orders: (orders[0], NOTHING)).order
    if why is None:
        assert wrong.build(order, context)
        return
    with pytest.raises(RecipeError, match=why):
        wrong.build(order, context)


def test_the_stop_of_one_robot_of_a_cell_leaves_what_is_shared_to_the_others() -> None:
    here = Bench(plant())
    here.wait(1.0)
    here.operate(Verb.STOP, "below_lamp")
    here.wait(1.0)
    assert here.operate(Verb.CLEAR, "below") is None
    here.submit("above ride")
    assert here.wait(30.0, ended(here, "above"))
    assert state_of(here, "above") is TaskState.DONE
