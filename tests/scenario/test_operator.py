"""The operator's verbs: done or refused with a sentence, in every state; and what must survive everything."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from arboleda.core import reasons
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Home, Stop, StopMode
from arboleda.model.messages import Journal, Reason, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import Evidence, Link, PlantModel
from arboleda.rig import faults
from arboleda.testing import Rig, shipped, slowed

from ..cells import with_robot
from ..readying import due, make_ready

TASK = "sis_a 0B 7"
levels = pytest.mark.parametrize("evidence", list(Evidence))


def cell(rig: Rig) -> Any:
    return rig.plant.cells["sis_a"]


def act(rig: Rig, *verbs: Verb, scope: str = "sis_a") -> None:
    """Verbs that must be done, each with time to take effect."""
    for verb in verbs:
        assert rig.operate(verb, scope) is None
        rig.wait(2.0)


def fetch(rig: Rig) -> None:
    """The arm is on its way to the part."""
    rig.submit(TASK)
    rig.wait_for("sis_a", "move to pick-up")
    rig.wait(0.5)


def stopping(rig: Rig) -> None:
    fetch(rig)
    assert rig.operate(Verb.STOP, "sis_a") is None


def aborted(rig: Rig) -> None:
    stopping(rig)
    rig.wait(5.0)


SCOPES = {"plant": ("", {"sis_a", "sis_b"}), "cell": ("sis_a", {"sis_a"}), "robot": ("ra1", {"sis_a"})}


@pytest.mark.parametrize(("scope", "cells"), SCOPES.values(), ids=SCOPES)
def test_a_stop_is_for_its_scope(scope: str, cells: set[str]) -> None:
    rig = Rig(slowed(shipped("sis_a", "sis_b"), 8))
    rig.wait(0.5)
    for name in ("sis_a", "sis_b"):
        rig.submit(f"{name} 0B 7")
    rig.wait(1.0)
    assert rig.operate(Verb.STOP, scope) is None
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    ended = {change.cell: change.state for change in rig.outcomes().values()}
    assert {name for name, state in ended.items() if state is TaskState.FAILED} == cells
    latched = {"ra1"} if scope == "ra1" else {r.name for name in cells for r in rig.model.cell(name).robots}
    assert rig.plant.dispatcher.latches.stopped == latched


@pytest.mark.parametrize("asked", [True, False], ids=["home_at_start", "not asked for"])
def test_an_arm_that_is_not_homed_at_start_is_homed_where_the_plant_file_says_so(asked: bool) -> None:
    model = shipped("sis_a")
    cells = [with_robot(each, "arm", home_at_start=asked) for each in model.cells]
    rig = Rig(replace(model, cells=tuple(cells)))
    rig.stop_bridge()
    rig.crash("ra_1")
    rig.crash()
    rig.start_bridge()
    rig.wait(30.0)
    assert rig.devices.boards["ra_1"].homed is asked
    rig.crash("ra_1")
    rig.wait(30.0)
    assert not rig.devices.boards["ra_1"].homed, "only at the start"


@levels
def test_a_robot_that_cannot_say_so_is_homed_by_hand(evidence: Evidence) -> None:
    rig = Rig(slowed(shipped("sis_a", evidence=evidence, assume_homed=True), 8))
    rig.wait(0.5)
    fetch(rig)
    rig.lost = lambda publication: publication.topic == "ra_1/conexion"
    rig.crash("ra_1")
    rig.wait(30.0, until=lambda: rig.plant.at_rest)
    if evidence is Evidence.STATE:
        return  # a reboot is not detectable there
    assert "not homed" in str(reasons.of_hold(cell(rig)))
    if evidence is Evidence.JOINTS:
        assert "--by-hand" in str(rig.operate(Verb.HOME, "ra1"))
    assert rig.operate(Verb.HOME, "ra1", by_hand=True) is None
    act(rig, Verb.RETRY)
    assert rig.wait(30.0, until=lambda: cell(rig).state is CellState.IDLE)


def test_a_reset_of_the_plant_waits_for_a_cell_that_is_clearing() -> None:
    rig = Rig(shipped())
    aborted(rig)
    act(rig, Verb.STOP, scope="")
    rig.lost = faults.to_board("ra_1")
    act(rig, Verb.CLEAR, scope="")

    def states() -> list[CellState]:
        return [each.state for each in rig.plant.cells.values()]

    before = [CellState.CLEARING, CellState.STOPPED, CellState.STOPPED]
    assert states() == before
    assert "sis_a is clearing" in str(rig.operate(Verb.RESET))
    assert states() == before
    rig.lost = lambda publication: False
    act(rig, Verb.CLEAR, Verb.RESET, scope="")
    assert set(states()) == {CellState.IDLE}


def test_a_clear_that_a_robot_has_not_heard_is_due_again_once_it_had_the_time() -> None:
    rig = Rig(shipped("sis_a"))
    aborted(rig)
    rig.lost = faults.to_board("ra_1")
    act(rig, Verb.CLEAR)
    waits = due(rig, "sis_a")
    assert waits is not None and waits.advice is None
    rig.lost = lambda publication: False
    rig.wait(rig.model.timing.stop_timeout_s)
    again = due(rig, "sis_a")
    assert again is not None and again.advice is not None
    assert str(again.advice["why"]) == "ra1 did not confirm the clear"
    assert make_ready(rig, "sis_a")[0] == "clear sis_a"
    assert cell(rig).state is CellState.IDLE


def test_every_robot_is_told_to_stop_before_any_task_is_said_to_have_failed() -> None:
    rig = Rig(shipped())
    for task in (TASK, "sis_b 1C 3"):
        rig.submit(task)
    rig.wait(3.0)
    rig.sent.clear()
    assert rig.operate(Verb.STOP) is None
    stops = [n for n, each in enumerate(rig.sent) if isinstance(each, Stop) and each.mode is StopMode.LATCH]
    failures = [n for n, each in enumerate(rig.sent) if isinstance(each, TaskChanged)]
    assert len(stops) == len(rig.model.robots) and len(failures) == 2
    assert max(stops) < min(failures)


def drawn_mobile(**changes: Any) -> PlantModel:
    """sis_a with a mobile robot that is only drawn."""
    model = shipped("sis_a", **changes)
    (only,) = model.cells
    return replace(model, cells=(with_robot(only, "mobile", link=Link.NONE),))


@pytest.mark.parametrize("scope", ["sis_a", "plant"])
def test_home_of_a_cell_leaves_out_what_is_only_drawn(scope: str) -> None:
    rig = Rig(drawn_mobile())
    rig.wait(1.0)
    assert rig.operate(Verb.HOME, scope) is None
    assert [each.robot for each in rig.sent if isinstance(each, Home)] == ["ra1"]


@pytest.mark.parametrize("by_hand", [False, True])
def test_home_of_a_robot_that_is_only_drawn_says_so(by_hand: bool) -> None:
    rig = Rig(drawn_mobile(assume_homed=True))
    rig.wait(1.0)
    refusal = rig.operate(Verb.HOME, "rm_sis_a", by_hand=by_hand)
    assert refusal == "rm_sis_a is only drawn (link: none)"


def test_cancel_of_an_unknown_task_says_so_and_which_tasks_are_open() -> None:
    rig = Rig(shipped("sis_a"))
    none = rig.operate(Verb.CANCEL, "lot42")
    assert none == (
        "there is no task 'lot42'; open tasks: none; cells and robots of this plant: sis_a, ra1, rm_sis_a"
    )
    for number in range(12):
        rig.submit(f"sis_a 0B 7 #n{number}")
    assert "open tasks: n0, n1, n2, n3, n4, n5, n6, n7, n8, n9 and 2 more;" in str(
        rig.operate(Verb.CANCEL, "#lot42")
    )


def test_a_task_is_abandoned_by_the_operator_also_where_its_arm_was_homed_meanwhile() -> None:
    rig = Rig(shipped("sis_a", evidence=Evidence.JOINTS))
    rig.wait(1.0)
    fetch(rig)
    act(rig, Verb.HOLD)
    assert rig.operate(Verb.HOME, "ra1", by_hand=True) is None
    rig.wait(2.0)
    assert rig.operate(Verb.RESUME, "sis_a") is not None
    act(rig, Verb.ABANDON)
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    (end,) = rig.outcomes().values()
    assert (end.reason, str(end.sentence)) == (Reason.CANCELLED, "abandoned by the operator")


def test_cancel_knows_a_cell_in_any_case_as_the_other_verbs_do() -> None:
    rig = Rig(shipped("sis_a"))
    rig.wait(1.0)
    rig.submit(TASK)
    rig.wait(1.0)
    assert rig.operate(Verb.CANCEL, "SIS_A") is None


def test_an_act_and_its_journal_entry_name_the_cell() -> None:
    rig = Rig(shipped())
    rig.wait(1.0)
    rig.submit("sis_b 0B 7 #sis_c")
    rig.wait(1.0)
    for verb, scope in ((Verb.CANCEL, "sis_c"), (Verb.STOP, "ra1"), (Verb.STOP, "SIS_C"), (Verb.STOP, "")):
        assert rig.operate(verb, scope) is None
    cells = ["sis_b", "sis_a", "sis_c", None]
    assert [act["cell"] for act in rig.snapshot()["acts"]] == cells
    assert [each.cell for each in rig.sent if isinstance(each, Journal)] == cells


@pytest.mark.parametrize(("limit", "waiting"), [(1, "1 task waiting"), (2, "2 tasks waiting")])
def test_a_full_queue_is_counted_in_words_for_one_and_for_many(limit: int, waiting: str) -> None:
    model = shipped("sis_a")
    rig = Rig(replace(model, cells=(replace(model.cells[0], queue_limit=limit),)))
    rig.wait(1.0)
    for _ in range(limit + 1):
        rig.submit(TASK)
        rig.wait(0.1)
    assert str(rig.submit(TASK).sentence) == f"sis_a has {waiting}, its limit; send it again later"
