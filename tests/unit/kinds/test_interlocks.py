"""A machine occupies a shared zone unless it says the contrary: its door is an interlock of the arm."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from tests.following import advised, follow

from arboleda.kinds import motion, process, switch
from arboleda.model.commands import FRESH_S
from arboleda.model.messages import Fact, MotionState, Reason, Verb
from arboleda.model.plant_model import Cell, Interlock, PlantModel
from arboleda.model.recipe import Recipe
from arboleda.recipes import Kit, parallel, recipe, work
from arboleda.wire.transport import Publication

from ...plants import device_of, kind_of, made
from .lab import Bench
from .tending import LAMP, plant

SHUT_S = 0.6
MILL = kind_of(
    "mill",
    {"door": ["open", "closed"]},
    open=motion(sets={"door": "open"}, takes_s=2.0, at_most_s=8.0),
    close=motion(sets={"door": "closed"}, takes_s=2.0, at_most_s=8.0),
    shut=switch(sets={"door": "closed"}, takes_s=0.1, at_most_s=SHUT_S),
    seal=process(sets={"door": "closed"}, takes_s=0.1, at_most_s=SHUT_S, finishes=True),
)


def with_mill(*recipes: Recipe) -> PlantModel:
    """The tending cell and a mill around its vise, into which arms reach only while its door is open."""
    model = plant(*recipes)
    (cell,) = model.cells
    mill = device_of(MILL)
    lock = Interlock(device="mill", zone="vise", free_while=(("door", "open"),))
    cell = replace(cell, members=(*cell.members, ("mill", mill)), interlocks=(lock,))
    return replace(model, cells=(cell,))


@recipe("machine")
def machine(cell: Kit):  # type: ignore[no-untyped-def]
    """The arm reaches in, the mill works behind its door, the arm reaches in again."""
    left, mill = cell.devices("left", "mill")
    return work(left.visit("vise"), mill.close(), cell.wait(1.0), mill.open(), left.visit("vise"))


def test_a_door_is_closed_when_the_arm_is_out_and_the_arm_enters_when_it_is_open() -> None:
    here = Bench(with_mill(machine))
    here.submit("tending machine")
    seen = set()
    while here.changes[-1].state.value not in ("done", "failed"):
        here.wait(0.05)
        seen.add((here.plant.zones.holder("vise"), here.machines["mill"].facts["door"]))
    assert here.changes[-1].state.value == "done"
    assert ("left", "closed") not in seen
    assert {("left", "open"), ("mill", "closed"), (None, "open")} <= seen


def test_a_door_waits_for_an_arm_inside() -> None:
    @recipe("hasty")
    def hasty(cell: Kit):  # type: ignore[no-untyped-def]
        left, mill = cell.devices("left", "mill")
        return parallel(left.visit("vise", cell.wait(5.0)), work(cell.wait(1.5), mill.close()))

    here = Bench(with_mill(hasty))
    here.submit("tending hasty")
    here.wait(4.0)
    assert here.plant.zones.holder("vise") == "left"
    assert here.machines["mill"].facts["door"] == "open"
    assert here.outcome().state.value == "done"
    assert here.machines["mill"].facts["door"] == "closed"


def test_an_arm_does_not_reach_behind_a_door_that_nobody_knows_to_be_open() -> None:
    here = Bench(with_mill(machine))
    here.machines["mill"].facts["door"] = "closed"  # somebody shuts it by hand
    here.wait(1.0)
    assert here.plant.zones.holder("vise") == "mill"
    here.submit("tending machine")
    assert here.outcome().reason is Reason.ZONE_UNAVAILABLE
    kept = "zone vise was not free within 10 s: mill keeps it as long as it does not report door open"
    assert kept in str(here.changes[-1].sentence)
    assert here.machines["mill"].facts["door"] == "closed"


def test_a_silent_machine_keeps_its_zone() -> None:
    here = Bench(with_mill(machine))
    here.machines["mill"].facts["door"] = "closed"
    here.wait(1.0)
    here.power_off("mill")
    here.wait(5.0)
    assert here.plant.zones.is_quarantined("vise")
    here.machines["mill"].facts["door"] = "open"
    here.power_on("mill")
    here.wait(5.0)
    assert here.plant.zones.holder("vise") is None


def test_a_machine_keeps_its_zone_as_long_as_it_may_obey_an_order_that_is_still_on_its_way() -> None:
    shut = made("shut", lambda cell: work(cell.device("mill").shut()))
    here = Bench(with_mill(shut))
    late: list[Publication] = []

    def is_held_up(publication: Publication) -> bool:
        if publication.topic == "mill/orden":
            late.append(publication)
        return publication.topic == "mill/orden"

    here.lost = is_held_up
    here.submit("tending shut")
    assert here.outcome().reason is Reason.DEADLINE
    [order] = late
    here.wait(FRESH_S - 0.3 - SHUT_S)
    assert here.plant.zones.holder("vise") == "mill"
    here.lost = lambda _: False
    here.inject(order)
    here.wait(0.2)
    assert here.machines["mill"].facts["door"] == "closed"
    assert here.plant.zones.holder("vise") == "mill"


def test_a_machine_that_was_told_to_halt_keeps_its_zone_while_its_next_order_is_on_its_way() -> None:
    """It moves still, on its last order."""
    other = made("other", lambda cell, mill: cell.fallback(mill.close(), mill.open()))
    here = Bench(with_mill(other))
    here.machines["mill"].lasts = lambda goal: 60.0
    here.submit("tending other")
    assert here.wait(20.0, lambda: len(here.plant.dispatcher.ledger.of_robot("mill")) == 1)
    first = here.plant.dispatcher.ledger.work_of("mill")
    here.lost = lambda publication: publication.topic in ("mill/paro", "mill/orden")
    assert here.wait(20.0, lambda: here.plant.dispatcher.ledger.work_of("mill") not in (first, None))
    here.wait(0.3)
    assert here.plant.dispatcher.beliefs["mill"].state is MotionState.MOVING
    assert here.plant.zones.holder("vise") == "mill"


def order_lost(verb: str) -> Bench:
    """A task tells the mill something that never comes to it."""
    told = made("told", lambda cell: work(getattr(cell.device("mill"), verb)()))
    here = Bench(with_mill(told))
    here.lost = lambda publication: publication.topic == "mill/orden"
    here.submit("tending told")
    return here


def test_reports_that_do_not_name_an_order_free_no_zone_once_it_was_called_off() -> None:
    """They may be of before it came: on a slow line the mill closes its door meanwhile."""
    here = order_lost("close")
    here.wait(0.3)
    assert here.operate(Verb.CANCEL, "tending") is None
    here.wait(0.6)
    assert not here.plant.dispatcher.ledger.of_robot("mill"), "two reports have shown it at rest"
    assert here.plant.zones.holder("vise") == "mill"
    here.wait(FRESH_S)
    assert here.plant.zones.holder("vise") is None


def test_work_that_no_stop_ends_keeps_the_zone_of_its_machine_past_its_deadline() -> None:
    """Nothing halts it, and what is reported may be of before it came."""
    seal = made("seal", lambda cell: work(cell.device("mill").seal()))
    here = Bench(with_mill(seal))
    here.lost = lambda publication: publication.topic == "mill/orden"
    here.submit("tending seal")
    assert here.outcome().reason is Reason.DEADLINE
    here.wait(SHUT_S)
    assert here.plant.zones.holder("vise") == "mill"
    here.wait(FRESH_S + SHUT_S)
    assert here.plant.zones.holder("vise") is None


def test_an_order_that_never_came_frees_the_zone_of_its_machine_in_the_end() -> None:
    here = order_lost("shut")
    assert here.outcome().reason is Reason.DEADLINE
    here.wait(FRESH_S + SHUT_S)
    assert here.plant.zones.holder("vise") is None


def test_a_motion_into_a_zone_that_is_not_held_is_refused_whatever_the_tree_says() -> None:
    blind = made("blind", lambda cell: work(*without_zones(cell.device("left").visit("vise"))))
    here = Bench(with_mill(blind))
    here.submit("tending blind")
    assert here.outcome().reason is Reason.ZONE_UNAVAILABLE
    assert str(here.changes[-1].sentence).startswith("left does not hold zone vise")
    here.wait(20.0)
    assert not [each for each in here.sent if getattr(each, "q", None) == (-0.5, 0.3)]


def test_a_door_that_may_hit_an_arm_is_not_closed_whatever_the_tree_says() -> None:
    blind = made("blind", lambda cell, left, mill: left.visit("vise", *without_zones(mill.close())))
    here = Bench(with_mill(blind))
    here.submit("tending blind")
    assert here.outcome().reason is Reason.ZONE_UNAVAILABLE
    assert here.machines["mill"].facts["door"] == "open"


def test_after_a_stop_in_the_zone_the_cell_is_brought_back_to_work() -> None:
    here = Bench(with_mill(machine))
    here.submit("tending machine")
    assert here.wait(20.0, lambda: here.plant.zones.holder("vise") == "left")
    assert here.operate(Verb.STOP, "tending") is None
    here.wait(5.0)
    for verb in (Verb.CLEAR, Verb.RESET):
        assert here.operate(verb, "tending") is None, verb
        here.wait(5.0)
    for advice in here.plant.advice("tending"):
        here.operate(advice.do, advice.scope)
    here.wait(20.0)
    here.submit("tending machine")
    assert here.outcome().state.value == "done"


def without_zones(step: Any) -> list[Any]:
    """The parts of a step that take and leave no zones."""
    parts = [child for child in step.children if "zones" not in child.name]
    for child in parts:
        child.parent = None
    return parts


GATE = kind_of(
    "gate",
    {"at": ["left", "right"]},
    go_left=motion(sets={"at": "left"}, takes_s=2.0, at_most_s=8.0),
    go_right=motion(sets={"at": "right"}, takes_s=2.0, at_most_s=8.0),
)


@recipe("slide")
def slide(cell: Kit):  # type: ignore[no-untyped-def]
    """An arm is in the vise while the gate, which shuts the feed, is to shut the vise instead."""
    left, gate = cell.devices("left", "gate")
    return parallel(left.visit("vise", cell.wait(4.0)), work(cell.wait(1.0), gate.go_left()))


def with_gate() -> PlantModel:
    """A gate that is always in the way: of the vise on its left, of the feed on its right."""
    model = with_mill(slide)
    (cell,) = model.cells
    gate = device_of(GATE)
    locks = (
        Interlock(device="gate", zone="vise", free_while=(("at", "right"),)),
        Interlock(device="gate", zone="feed", free_while=(("at", "left"),)),
    )
    cell = replace(cell, members=(*cell.members, ("gate", gate)), interlocks=locks)
    return replace(model, cells=(cell,), zones=(*model.zones, "feed"))


def test_a_machine_in_the_way_of_one_zone_moves_over_into_another_one_once_nobody_is_there() -> None:
    here = Bench(with_gate())
    here.machines["gate"].facts["at"] = "right"
    here.wait(1.0)
    assert here.plant.zones.holder("feed") == "gate"
    assert here.plant.zones.holder("vise") is None
    here.submit("tending slide")
    assert here.wait(10.0, lambda: "gate" in dict(here.plant.zones.queue.waiting))
    assert here.plant.zones.holder("vise") == "left"
    assert here.outcome().state.value == "done"
    assert here.machines["gate"].facts["at"] == "left"
    here.wait(1.0)
    assert (here.plant.zones.holder("vise"), here.plant.zones.holder("feed")) == ("gate", None)


def with_shared_gate() -> PlantModel:
    """The same gate, which a cell that does nothing has, too."""
    model = with_gate()
    (cell,) = model.cells
    lamp = device_of(LAMP, "other_lamp")
    members = (("lamp", lamp), ("gate", cell.roles["gate"]))
    idle = Cell(name="other", queue_limit=5, members=members, shared=("gate",), interlocks=cell.interlocks)
    return replace(model, cells=(replace(cell, shared=("gate",)), idle))


def test_a_cell_at_rest_does_not_withdraw_what_a_machine_asked_for_that_another_cell_has() -> None:
    here = Bench(with_shared_gate())
    here.machines["gate"].facts["at"] = "right"
    here.wait(1.0)
    here.submit("tending slide")
    assert here.wait(10.0, lambda: "gate" in dict(here.plant.zones.queue.waiting))
    here.wait(0.5)
    assert "gate" in dict(here.plant.zones.queue.waiting)
    assert here.outcome().state.value == "done"
    assert here.machines["gate"].facts["at"] == "left"


def test_a_machine_that_is_heard_again_keeps_its_zone_without_quarantine() -> None:
    here = Bench(with_gate())
    here.wait(1.0)
    context = here.plant.cells["tending"].context
    assert here.plant.zones.acquire("somebody", frozenset({"feed"}))
    here.power_off("gate")
    here.wait(3.0)
    assert here.plant.zones.is_quarantined("vise")
    assert not context.zones.take("gate", frozenset({"feed"}))  # nobody knows where it is
    assert here.plant.zones.queue.waiting == ()
    here.power_on("gate")
    here.wait(3.0)
    assert here.plant.zones.holder("vise") == "gate"
    assert not here.plant.zones.is_quarantined("vise")


def test_a_machine_is_only_in_the_way_of_a_zone_in_which_it_is() -> None:
    here = Bench(with_gate())
    here.wait(1.0)
    context = here.plant.cells["tending"].context
    assert context.zones.interlocks.in_the_way("gate", ["vise"]) == ("at right",)
    assert context.zones.interlocks.in_the_way("gate", ["feed"]) is None


def test_a_zone_kept_for_a_robot_that_the_plant_file_no_longer_has_is_freed_on_advice() -> None:
    here = Bench(with_mill(machine))
    here.disk.facts[Fact.QUARANTINE] = {"vise": "an_arm_of_last_year"}
    here.crash()
    here.power_off("left")
    here.power_on("left")
    here.wait(3.0)
    assert here.plant.zones.holder("vise") == "an_arm_of_last_year"
    assert advised(here, "tending")[:3] == ["see that nobody is in vise", "override vise", "home left"]
    follow(here, "tending")
    here.submit("tending machine")
    assert here.outcome().state.value == "done"


def test_a_task_begins_as_soon_as_an_arm_is_surely_outside_though_nothing_else_happens() -> None:
    here = Bench(with_mill(machine))
    here.wait(1.0)
    here.disk.facts[Fact.QUARANTINE] = {"vise": "mill"}
    here.crash()
    here.submit("tending machine")
    here.wait(0.9)
    assert here.changes[-1].state.value == "queued"
    here.wait(0.2)
    assert here.changes[-1].state.value == "running"
