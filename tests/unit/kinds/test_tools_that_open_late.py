"""A tool that may let go late keeps its robot; a part in a device that no robot carries is to be released."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from arboleda.core import reasons
from arboleda.core.plant import Plant
from arboleda.model.advice import sentence
from arboleda.model.grips import Grip
from arboleda.model.messages import Fact, TaskState, Verb
from arboleda.recipes import Kit, recipe, work

from .lab import Bench, model
from .tending import plant
from .test_recipes_of_robots import load, moved

AT_THE_VISE, OPENS = "left -0.5 0.3", "jaw open"
NEVER_S = 1000.0


def opening_late(bench: Bench) -> Bench:
    """A task has failed, as the jaw at the vise does not open in time."""
    jaw = bench.machines["jaw"]
    jaw.lasts = lambda goal: NEVER_S if goal.verb == "open" else 0.0
    bench.submit("tending load feed_2")
    bench.outcome()
    assert bench.wait(30.0, lambda: bench.plant.cells["tending"].state.value == "held")
    return bench


def after_the_vise(bench: Bench) -> list[str]:
    """What left and its jaw were told since the arm went to the vise."""
    lines = [line for line in moved(bench) if line.startswith(("left", "jaw"))]
    return lines[lines.index(AT_THE_VISE) + 1 :]


def test_the_robot_stays_and_the_recovery_has_its_tool_let_go_first() -> None:
    here = opening_late(Bench(plant(load)))
    assert set(after_the_vise(here)) == {OPENS}
    here.machines["jaw"].lasts = lambda goal: 0.0
    before = len(after_the_vise(here))
    assert here.operate(Verb.RETRY, "tending") is None
    assert here.wait(30.0, lambda: here.plant.cells["tending"].state.value == "idle")
    first, *moves = after_the_vise(here)[before:]
    assert first == OPENS
    assert moves[-1] == "left 0.0 0.0"
    assert OPENS not in moves


def reboot(here: Bench) -> None:
    here.power_off("jaw")
    here.power_on("jaw")


def end_late(here: Bench) -> None:
    here.machines["jaw"].catch_up(round(here.now * 1e6))


@pytest.mark.parametrize("happens", [reboot, end_late])
def test_what_proves_that_it_opens_no_more_lets_the_robot_go(happens: Callable[[Bench], None]) -> None:
    here = opening_late(Bench(plant(load)))
    before = len(after_the_vise(here))
    happens(here)
    here.wait(3.0)
    assert here.operate(Verb.RETRY, "tending") is None
    assert here.wait(30.0, lambda: here.plant.cells["tending"].state.value == "idle")
    assert OPENS not in after_the_vise(here)[before:]


def test_what_gives_up_to_open_still_holds_and_is_brought_back() -> None:
    here = Bench(plant(load))
    jaw = here.machines["jaw"]
    tries: list[str] = []

    def fails(goal: object) -> str | None:
        tries.append(goal.verb)  # type: ignore[attr-defined]
        return "atasco" if tries.count("open") == 1 and tries[-1] == "open" else None

    jaw.fails = fails
    here.submit("tending load feed_2")
    here.outcome()
    assert here.wait(30.0, lambda: here.plant.cells["tending"].state.value == "idle")
    told = after_the_vise(here)
    assert told.index("left 0.5 0.4") > told.index(OPENS)
    assert told[told.index("left 0.5 0.4") + 1] == OPENS


def test_a_recipe_that_goes_on_without_it_is_refused_the_move() -> None:
    @recipe("load")
    def goes_on(cell: Kit):  # type: ignore[no-untyped-def]
        left, jaw = cell.devices("left", "jaw")
        opened = cell.fallback(jaw.open(), left.go("feed"))
        return work(left.visit("feed_2", jaw.close()), left.visit("vise", opened))

    here = Bench(plant(goes_on))
    here.machines["jaw"].lasts = lambda goal: NEVER_S if goal.verb == "open" else 0.0
    here.submit("tending load")
    why = "left stays where it is: jaw was told to let go and may still do it"
    assert why in str(here.outcome().sentence)
    assert set(after_the_vise(here)) == {OPENS}


def test_a_plant_that_starts_again_knows_that_the_tool_may_still_open() -> None:
    here = opening_late(Bench(plant(load)))
    assert here.plant.dispatcher.memory.value(Fact.EFFECTOR, "jaw") == Grip.SWITCHING.value
    again = Plant(here.model, epoch=2, now=here.now, memory={Fact.EFFECTOR: {"jaw": Grip.SWITCHING.value}})
    assert again.dispatcher.effectors.opening_tool("left") == "jaw"


def test_a_part_from_nobody_knows_where_is_to_be_released() -> None:
    here = Bench(plant(load))
    here.manual.set_facts("jaw", (("gripped", True),))
    assert here.wait(5.0, lambda: bool(here.plant.advice("tending")))
    assert str(sentence(here.plant.advice("tending"))) == "release jaw, then resume tending"


def test_a_recovery_does_not_let_go_of_a_part_from_nobody_knows_where() -> None:
    here = Bench(plant(load))
    here.submit("tending load feed_2")
    here.wait(0.5)
    assert here.operate(Verb.HOLD, "tending") is None
    here.wait(2.0)
    here.manual.set_facts("jaw", (("gripped", True),))
    here.wait(1.0)
    assert here.operate(Verb.ABANDON, "tending") is None
    here.wait(20.0)
    assert "left 0.0 0.0" in moved(here) and OPENS not in moved(here)
    assert "jaw may hold a part" in str(reasons.of_hold(here.plant.cells["tending"]))


def test_a_held_task_that_can_only_be_abandoned_keeps_no_zone_that_its_robot_has_left() -> None:
    here = Bench(plant(load))
    here.submit("tending load feed_2")
    assert here.wait(60.0, lambda: AT_THE_VISE in moved(here))
    assert here.operate(Verb.HOLD, "tending") is None
    assert here.wait(5.0, lambda: here.plant.cells["tending"].state.value == "held")
    assert here.plant.zones.holder("vise") == "left"
    assert here.operate(Verb.HOME, "left") is None
    assert here.wait(30.0, lambda: here.plant.zones.holder("vise") is None)


def test_after_a_failure_the_device_is_to_be_released() -> None:
    here = Bench(model())
    here.submit("bench careless")
    assert here.outcome().state is TaskState.FAILED
    assert here.wait(30.0, lambda: bool(here.plant.advice("bench")))
    ways = here.plant.advice("bench")
    assert str(sentence(ways)) == "release oven, then resume bench"
    assert "oven may hold a part: clamped is true" in str(reasons.of_hold(here.plant.cells["bench"]))
    for each in ways:  # none is refused once those before it are done
        assert here.operate(Verb(each.do), each.scope) is None
        here.wait(3.0)
    assert here.plant.advice("bench") == ()


def test_after_a_stop_the_device_is_to_be_released_once_the_cell_is_reset() -> None:
    here = Bench(model())
    here.submit("bench bake 10")
    assert here.wait(30.0, lambda: here.told[-1:] == ["oven close"])
    assert here.operate(Verb.STOP) is None
    here.wait(3.0)
    told = str(sentence(here.plant.advice("bench")))
    assert told == "clear bench, then reset bench, then release oven, then resume bench"
