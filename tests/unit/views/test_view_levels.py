"""What screens are told of a plant: how far a task is, and how each robot and cell fares."""

from __future__ import annotations

from typing import Any

import pytest
from py_trees.behaviours import Failure, Running, Success
from py_trees.composites import Selector, Sequence

from arboleda.model.messages import MotionState, TaskState, Verb
from arboleda.testing import Rig, shipped
from arboleda.views import diagnostics, tree_view, view
from arboleda.wire.status import ERROR, OK, STALE, WARN

TASK = "sis_a 0B 7"


def recipe(*work: Any) -> Selector:
    """A tree as recipes are, ticked once."""
    main = Sequence("main", memory=True, children=list(work))
    recovery = Sequence("recovery", memory=True, children=[Running("go home")])
    tree = Selector("storage", memory=True, children=[main, recovery])
    tree.tick_once()
    return tree


@pytest.mark.parametrize(
    ("work", "share"),
    [
        ([Running("drive"), Success("grip")], 0.0),
        ([Success("drive"), Running("grip"), Success("go"), Success("home")], 0.25),
        ([Success("drive"), Failure("grip")], 0.5),
        ([Success("drive")], 1.0),
    ],
    ids=["first step", "second of four", "recovering", "done"],
)
def test_progress_is_the_share_of_the_steps_that_are_done(work: list[Any], share: float) -> None:
    assert tree_view.progress_of(recipe(*work)) == share


@pytest.mark.parametrize(
    "tree", [None, Success("alone"), Sequence("recovery", memory=True)], ids=["none", "leaf", "recovery"]
)
def test_without_work_there_is_no_progress(tree: Any) -> None:
    assert tree_view.progress_of(tree) is None


def test_progress_only_grows_while_a_task_is_carried_out() -> None:
    rig, seen = Rig(shipped("sis_a")), [0.0]

    def look() -> bool:
        share = rig.snapshot()["cells"][0]["progress"]
        if share is not None and share != seen[-1]:
            seen.append(share)
        return [change.state for change in rig.changes][-1] is TaskState.DONE

    rig.wait(0.5)
    rig.submit(TASK)
    assert rig.wait(60.0, until=look)
    assert len(seen) == 8 and seen == sorted(seen) and seen[-1] < 1.0


def levels(rig: Rig) -> dict[str, int]:
    told = diagnostics.diagnostics(rig.snapshot())
    return {name.removeprefix("arboleda: "): level for name, _, level, _, _ in told}


def test_every_robot_and_cell_has_a_level() -> None:
    rig = Rig(shipped("sis_a", "sis_b"))
    rig.wait(0.5)
    robots = dict.fromkeys(rig.model.robots, OK)
    assert levels(rig) == {**robots, "sis_a": OK, "sis_b": OK}
    assert rig.operate(Verb.STOP, "sis_a") is None
    rig.wait(1.0)
    assert levels(rig) == {**robots, "ra1": ERROR, "rm_sis_a": ERROR, "sis_a": WARN, "sis_b": OK}
    assert rig.plant.dispatcher.beliefs["ra1"].state is MotionState.STOP_LATCHED


def test_a_silent_robot_is_stale() -> None:
    rig = Rig(shipped("sis_a"))
    rig.wait(0.5)
    rig.power_off("ra_1", will_after_s=7.0)
    rig.wait(rig.model.timing.stale_after_s + 0.1)
    assert levels(rig) == {"ra1": STALE, "rm_sis_a": OK, "sis_a": WARN}


def test_an_idle_cell_that_cannot_work_is_told_with_what_leads_out() -> None:
    rig = Rig(shipped("sis_a"))
    rig.wait(0.5)
    rig.power_off("ra_1")
    rig.wait(2.0)
    snapshot = rig.snapshot()
    (cell,) = snapshot["cells"]
    assert (cell["state"], str(cell["not_ready"])) == ("idle", "ra1 is offline; bring ra1 back")
    assert view.standing(cell) == "blocked"
    assert [dict(each, said=str(each["said"]), why=str(each["why"])) for each in cell["advice"]] == [
        {
            "do": "bring_back",
            "hand": True,
            "scope": "ra1",
            "by_hand": False,
            "arguments": {},
            "instead": False,
            "said": "bring ra1 back",
            "why": "ra1 is offline",
            "moves": [],
            "drops": [],
            "refusal": None,
        }
    ]
    *_, (_, _, level, message, values) = diagnostics.diagnostics(snapshot)
    assert (level, message, values["waiting_for"]) == (WARN, str(cell["not_ready"]), str(cell["not_ready"]))
    assert values["advice"] == "bring ra1 back"


def test_a_paused_queue_is_told_before_anything_waits_in_it() -> None:
    rig = Rig(shipped("sis_a"))
    rig.wait(0.5)
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET):
        rig.operate(verb, "sis_a")
        rig.wait(1.0)
    (cell,) = rig.snapshot()["cells"]
    said = "the queue of sis_a is paused; resume sis_a starts it"
    assert (str(cell["not_ready"]), cell["waiting_for"]) == (said, None)
    assert view.standing(cell) == "paused"
    assert rig.operate(Verb.RESUME, "sis_a") is None
    (cell,) = rig.snapshot()["cells"]
    assert (cell["not_ready"], cell["advice"], view.standing(cell)) == (None, [], "idle")
