"""Recipes that send robots to targets: visits, zones, tools, recovery; and steps around steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from py_trees.behaviours import Success
from py_trees.common import Status

from arboleda.kinds.arm import Arm
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Command
from arboleda.model.errors import TextError
from arboleda.model.messages import Reason, TaskState, Verb
from arboleda.model.plant_model import PlantModel, Retry, Robot
from arboleda.model.recipe import Recipe
from arboleda.model.text import parse
from arboleda.recipes import Choice, Kit, Number, RecipeError, Target, parallel, recipe, work
from arboleda.recipes.decorators import Inverted

from ...plants import made
from .lab import Bench
from .tending import plant


def moved(bench: Bench) -> list[str]:
    """What each robot was told, in order, without stops: `left 0.5 0.2`, `jaw close`."""
    lines = []
    for each in (message for message in bench.sent if isinstance(message, Command)):
        where = getattr(each, "q", None) or getattr(each, "nodes", None)
        words = " ".join(map(str, where)) if where else getattr(each, "verb", None)
        if words:
            lines.append(f"{each.robot} {words}")
    return lines


@recipe("load")
def load(cell: Kit, blank=Target("pallet")):  # type: ignore[no-untyped-def]
    """Bring a blank from the pallet to the vise."""
    left, jaw = cell.devices("left", "jaw")
    return work(left.visit(blank, jaw.close()), left.visit("vise", jaw.open()), left.home())


def test_a_visit_goes_there_works_and_leaves_the_zone() -> None:
    here = Bench(plant(load))
    here.submit("tending load feed_2")
    assert here.outcome().state.value == "done"
    assert moved(here) == ["left 0.5 0.4", "jaw close", "left -0.5 0.3", "jaw open", *["left 0.0 0.0"] * 2]
    assert here.plant.zones.holder("vise") is None


def test_an_approach_height_is_kept_on_the_way_there_and_back() -> None:
    here = Bench(plant(load))
    here.submit("tending load feed")
    here.outcome()
    assert moved(here)[:4] == ["left 0.5 0.0", "left 0.5 0.2", "jaw close", "left 0.5 0.0"]


def test_a_zone_that_somebody_else_holds_is_waited_for_as_long_as_the_cell_says() -> None:
    @recipe("long")
    def long(cell: Kit):  # type: ignore[no-untyped-def]
        left, right = cell.devices("left", "right")
        return parallel(left.visit("vise", cell.wait(60.0)), work(cell.wait(1.0), right.visit("vise")))

    here = Bench(plant(long))
    here.submit("tending long")
    assert here.outcome().reason is Reason.ZONE_UNAVAILABLE
    assert not [each for each in moved(here) if each == "right -0.5 0.3"]


@pytest.mark.parametrize(
    ("blank", "way_back"),
    [
        ("feed", ["left 0.5 0.0", "left 0.5 0.2", "jaw open", "left 0.5 0.0"]),
        ("feed_2", ["left 0.5 0.4", "jaw open"]),
    ],
    ids=["with an approach", "without one"],
)
def test_what_the_gripper_holds_is_brought_back_where_it_was_taken(blank: str, way_back: list[str]) -> None:
    @recipe("spoil")
    def spoil(cell: Kit, blank=Target("pallet")):  # type: ignore[no-untyped-def]
        left, jaw = cell.devices("left", "jaw")
        return work(left.visit(blank, jaw.close()), left.home(), cell.fail("the blank is bad"))

    here = Bench(plant(spoil))
    here.submit(f"tending spoil {blank}")
    assert str(here.outcome().sentence) == "the blank is bad"
    assert here.wait(30.0, lambda: here.plant.cells["tending"].state.value == "idle")
    back = moved(here)[moved(here).index("left 0.0 0.0") + 1 :]
    assert [each for each in back if each in way_back] == way_back


def test_a_gripper_that_opens_by_itself_is_named_as_what_it_is() -> None:
    here = Bench(plant(load))
    here.submit("tending load feed")
    assert here.wait(60.0, lambda: moved(here)[-1:] == ["left 0.5 0.0"] and "jaw close" in moved(here))
    here.power_off("jaw")
    here.power_on("jaw")
    ended = here.outcome()
    assert ended.reason is Reason.PART_LOST
    assert str(ended.sentence) == "jaw let go of the part that it held, as its board rebooted"


def test_a_robot_grips_and_lets_go_with_its_tool() -> None:
    @recipe("plain")
    def plain(cell: Kit):  # type: ignore[no-untyped-def]
        left = cell.device("left")
        return work(left.visit("feed", left.grip()), left.visit("vise", left.let_go()))

    here = Bench(plant(plain))
    here.submit("tending plain")
    assert here.outcome().state.value == "done"
    assert [each for each in moved(here) if each.startswith("jaw")] == ["jaw close", "jaw open"]


def test_a_recipe_says_where_a_recovery_brings_what_a_robot_holds() -> None:
    @recipe("reject")
    def reject(cell: Kit):  # type: ignore[no-untyped-def]
        left, jaw = cell.devices("left", "jaw")
        left.brings_back_to("feed_2")
        return work(left.visit("feed", jaw.close()), cell.fail("bad"))

    here = Bench(plant(reject))
    here.submit("tending reject")
    here.outcome()
    here.wait(30.0, lambda: here.plant.cells["tending"].state.value == "idle")
    told = [each for each in moved(here) if each.startswith(("left", "jaw"))]
    assert told[told.index("jaw open") - 1] == "left 0.5 0.4"


def test_two_arms_work_at_the_same_time_and_take_turns_in_a_zone() -> None:
    both = made("both", lambda cell, left, right: parallel(left.visit("vise"), right.visit("vise")))
    here = Bench(plant(both))
    holders = set()
    here.submit("tending both")
    while here.changes[-1].state.value not in ("done", "failed"):
        here.wait(0.1)
        holders.add(here.plant.zones.holder("vise"))
    assert here.changes[-1].state.value == "done"
    assert {"left", "right"} <= holders


def test_a_mobile_robot_goes_to_its_targets_over_its_grid() -> None:
    drive = made("drive", lambda cell, shuttle: work(shuttle.go("store"), shuttle.home()))
    here = Bench(plant(drive))
    here.submit("tending drive")
    assert here.outcome().state.value == "done"
    assert moved(here) == ["shuttle 0 1 2 5 8", "shuttle 8 5 2 1 0"]


def test_numbers_and_names_in_the_text_of_a_task() -> None:
    @recipe("press")
    def press(cell: Kit, force: Number[1, 40], speed: Number[0.5, 2.0], side=Choice("a", "b")):  # type: ignore[no-untyped-def,valid-type]
        return cell.wait(0.1)

    model = plant(press)
    assert parse("tending press 7 1.5 b", model).values == {"force": 7, "speed": 1.5, "side": "b"}
    named = parse("tending press side=a 7 speed=2", model)
    assert named.text == "tending press 7 2.0 a"
    for text, sentence in (
        ("tending press 41 1 a", "force is a whole number from 1 to 40, not '41'"),
        ("tending press 7 fast a", "speed is a number from 0.5 to 2, not 'fast'"),
        ("tending press 7.5 1 a", "force is a whole number from 1 to 40, not '7.5'"),
        ("tending press 7 1 colour=b", "side of tending cannot be 'colour=b'"),
        ("tending press force=1 force=2 a", "force is named twice"),
        ("tending press force=1 speed=1 side=c", "side of tending cannot be 'c'"),
    ):
        with pytest.raises(TextError) as caught:
            parse(text, model)
        assert sentence in str(caught.value)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda cell: cell.device("left").visit("vice"), "left has no target 'vice'"),
        (lambda cell: cell.device("jaw").opne(), "a gripper has no verb 'opne'"),
        (lambda cell: cell.device("lamp").light(True, False), "light of a lamp takes on"),
    ],
    ids=["target", "verb", "too many values"],
)
def test_words_that_are_wrong_are_named(make: Callable[[Kit], Any], sentence: str) -> None:
    wrong = made("wrong", make)
    here = Bench(plant(wrong))
    here.submit("tending wrong")
    assert sentence in str(here.outcome().sentence)
    assert moved(here) == []


def attempts(make: Callable[[Kit, Any], Any], times: int) -> tuple[Bench, list[float]]:
    """A task with a step that the lamp gives up so many times; when it did it, or gave it up."""
    tries = made("try", lambda cell: make(cell, cell.device("lamp").light(on=True)))
    here, asked = Bench(plant(tries)), []

    def fails(order: Any) -> str | None:
        asked.append(here.now)
        return "roto" if len(asked) <= times else None

    here.machines["lamp"].fails = fails
    here.submit("tending try")
    return here, asked


def test_a_retry_waits_and_tries_again() -> None:
    here, asked = attempts(lambda cell, step: cell.retry(step, times=3, pause_s=2.0), times=2)
    assert here.outcome().state.value == "done"
    assert [round(b - a, 1) for a, b in pairwise(asked)] == [2.0, 2.0]


def test_a_retry_ends_with_the_last_failure() -> None:
    here, asked = attempts(lambda cell, step: cell.retry(step, times=1, pause_s=0.0), times=9)
    assert here.outcome().state.value == "failed"
    assert len(asked) == 2


def test_a_retry_is_only_for_its_causes() -> None:
    here, asked = attempts(lambda cell, step: cell.retry(step, causes=["deadline"]), times=9)
    assert here.outcome().reason is Reason.DEVICE_FAULT
    assert len(asked) == 1


def test_a_fallback_is_what_is_done_instead() -> None:
    here, _ = attempts(lambda cell, step: cell.fallback(step, cell.device("left").go("feed_2")), times=9)
    assert here.outcome().state.value == "done"
    assert moved(here)[-1] == "left 0.5 0.4"


def test_a_repeat_does_it_so_often() -> None:
    here, _ = attempts(lambda cell, step: cell.repeat(step, 3), times=0)
    assert here.outcome().state.value == "done"
    assert moved(here) == ["lamp light"] * 3


def test_an_inverted_step_has_to_fail() -> None:
    here, _ = attempts(lambda cell, step: cell.invert(step), times=9)
    assert here.outcome().state.value == "done"
    here, _ = attempts(lambda cell, step: cell.invert(step), times=0)
    assert "was to fail, and did not" in str(here.outcome().sentence)


def test_an_inverted_step_fails_where_its_step_does_not() -> None:
    inverted = Inverted(Success("found"), Bench(plant(load)).plant.cells["tending"].context.failures)
    inverted.tick_once()
    assert inverted.status is Status.FAILURE


def test_a_timeout_leaves_its_step() -> None:
    slow = made("slow", lambda cell: cell.timeout(cell.device("left").go("feed_2"), 0.2))
    here = Bench(plant(slow))
    here.submit("tending slow")
    assert here.outcome().reason is Reason.DEADLINE
    assert str(here.changes[-1].sentence) == "visit feed_2 did not end within 0.2 s"


def test_a_recipe_is_a_step_of_another() -> None:
    twice = made("twice", lambda cell: work(cell.run(load, blank="feed"), cell.run(load, blank="feed_2")))
    here = Bench(plant(twice))
    here.submit("tending twice")
    assert here.outcome(240.0).state.value == "done"
    assert moved(here).count("jaw close") == 2


def test_a_number_is_a_whole_one_where_both_its_limits_are() -> None:
    assert [Number(*limits).limits.whole for limits in ((1, 2), (1, 2.0), (1.0, 2))] == [True, False, False]


@pytest.mark.parametrize("limits", [5, (5,), (1, 2, 3), (2, 1), (1, 1)])
def test_a_number_needs_two_limits_the_lower_one_first(limits: Any) -> None:
    with pytest.raises(RecipeError, match="two limits"):
        Number[limits]


def test_a_held_task_of_robots_goes_on_where_it_was() -> None:
    here = Bench(plant(load))
    here.submit("tending load feed_2")
    here.wait(0.5)
    assert here.operate(Verb.HOLD, "tending") is None
    assert here.wait(3.0, lambda: here.plant.cells["tending"].state.value == "held")
    before = moved(here)
    here.wait(3.0)
    assert moved(here) == before == ["left 0.5 0.4"]
    assert here.operate(Verb.RESUME, "tending") is None
    assert here.outcome().state.value == "done"
    assert moved(here).count("jaw close") == moved(here).count("jaw open") == 1


def lifting(*recipes: Recipe) -> PlantModel:
    """The plant with arms whose second joint slides up and down."""

    def lifted(robot: Robot) -> Robot:
        if not isinstance(robot, Arm):
            return robot
        turning, other = robot.joints
        return replace(robot, joints=(turning, replace(other, pinion_radius_m=0.01)))

    model = plant(*recipes)
    (cell,) = model.cells
    return replace(model, cells=(cell.with_robots(lifted),))


def path(bench: Bench) -> list[tuple[float, ...]]:
    """The joints to which the left arm was sent, in order, to a tenth."""
    goals = [each.q for each in bench.sent if isinstance(each, MoveJoints) and each.robot == "left"]
    return [tuple(round(value, 1) for value in goal) for goal in goals]


ABOVE, DOWN = (0.5, 0.0), (0.5, 0.2)


@pytest.mark.parametrize(("goal", "there"), [("vise", (-0.5, 0.3)), ("feed_2", (0.5, 0.4)), ("home", (0, 0))])
def test_an_arm_rises_where_its_work_failed_before_it_goes_elsewhere(goal: str, there: object) -> None:
    @recipe("anyway")
    def anyway(cell: Kit):  # type: ignore[no-untyped-def]
        left = cell.device("left")
        return cell.fallback(left.visit("feed", cell.fail("no blanks")), left.go(goal))

    here = Bench(lifting(anyway))
    here.submit("tending anyway")
    assert here.outcome().state is TaskState.DONE
    assert path(here)[:4] == [ABOVE, DOWN, ABOVE, there]


def test_an_arm_rises_where_it_was_halted_on_its_way_down() -> None:
    @recipe("hurries")
    def hurries(cell: Kit):  # type: ignore[no-untyped-def]
        left = cell.device("left")
        return cell.fallback(cell.timeout(left.go("feed"), 1.0), left.go("feed_2"))

    here = Bench(lifting(hurries))
    here.submit("tending hurries")
    assert here.outcome().state is TaskState.DONE
    assert path(here)[:4] == [ABOVE, DOWN, ABOVE, (0.5, 0.4)]


def test_an_arm_that_was_silent_when_its_work_failed_rises_once_it_is_heard() -> None:
    @recipe("patient")
    def patient(cell: Kit):  # type: ignore[no-untyped-def]
        left = cell.device("left")
        blanks = left.visit("feed", [cell.wait(6.0), cell.fail("no blanks")])
        return cell.fallback(blanks, left.go("feed_2"))

    model = lifting(patient)
    (tending,) = model.cells
    here = Bench(replace(model, cells=(replace(tending, retry=Retry(times=9, backoff_s=1.0)),)))
    here.submit("tending patient")
    assert here.wait(10.0, lambda: path(here) == [ABOVE, DOWN])
    here.wait(2.0)
    here.carry = lambda said: [] if said.topic.startswith("left/") else [said]
    here.wait(8.0)
    here.carry = lambda said: [said]
    assert here.outcome().state is TaskState.DONE
    assert path(here)[2:4] == [ABOVE, (0.5, 0.4)]


def test_an_arm_goes_up_once_where_its_work_is_tried_again() -> None:
    again = made("again", lambda cell, left: cell.retry(left.visit("feed", cell.fail("no blanks")), times=1))
    here = Bench(lifting(again))
    here.submit("tending again")
    assert here.outcome().state is TaskState.FAILED
    assert path(here)[:5] == [ABOVE, DOWN, ABOVE, DOWN, ABOVE]


def test_an_arm_whose_work_is_done_does_not_rise_once_more() -> None:
    @recipe("rounds")
    def rounds(cell: Kit):  # type: ignore[no-untyped-def]
        left = cell.device("left")
        return work(left.visit("feed", cell.wait(1.0)), left.visit("feed_2"), left.home())

    here = Bench(lifting(rounds))
    here.submit("tending rounds")
    assert here.outcome().state is TaskState.DONE
    assert path(here) == [ABOVE, DOWN, ABOVE, (0.5, 0.4), (0, 0)]
