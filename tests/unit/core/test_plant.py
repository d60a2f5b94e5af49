from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from arboleda.core.plant import Plant
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Stop, StopMode
from arboleda.model.messages import (
    Fact,
    Heartbeat,
    Interference,
    InternalError,
    MotionState,
    OperatorRequest,
    Reason,
    Shutdown,
    SystemStart,
    TaskChanged,
    TaskRequest,
    TaskState,
    Verb,
)
from arboleda.model.plant_model import APART_S, Evidence, Timing
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.trees import leaves
from arboleda.views import view

MOVING, STILL = MotionState.MOVING, MotionState.STOPPED


def driven_to_the_arm(
    hand: Callable[[Evidence], Any], evidence: Evidence, *, at_goal: bool = False
) -> tuple[Any, MoveJoints]:
    """A storage task whose mobile arrived and whose arm was just sent to its pick-up pose."""
    plant = hand(evidence)
    pickup = StorageLayout(plant.plant.model.cell("sis_a")).pickup.q
    plant.awake(**({"ra1": pickup} if at_goal else {}))
    plant.submit("sis_a 0B 7")
    plant.wait(0.2)
    (path,) = plant.commands(FollowPath)
    plant.tell("rm_sis_a", state=MOVING, accepted=path.id)
    plant.tell("rm_sis_a", state=STILL, node=7, accepted=path.id, done=path.id)
    if evidence is Evidence.JOINTS:
        plant.tell("rm_sis_a", after=APART_S, node=7)
    (move,) = plant.commands(MoveJoints)
    return plant, move


def test_a_plant_that_is_fenced_off_says_by_whom_and_how_to_get_back(hand: Any) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    plant.tell("ra1", state=STILL, epoch=1, plant=4_000_000_000)
    (robot,) = (row for row in view.snapshot(plant.plant)["robots"] if row["name"] == "ra1")
    assert "obeys plant 4000000000, which started after this one (7)" in str(robot["obstacle"])
    assert "start the bridge anew" in str(robot["obstacle"])
    plant.submit("sis_a 0B 7")
    assert "obeys plant 4000000000" in str(last_change(plant).sentence)
    plant.tell("ra1", state=STILL, epoch=1, plant=6)
    assert "does not hear this plant yet" in str(plant.plant.dispatcher.obstacles.of("ra1"))


def last_change(plant: Any) -> TaskChanged:
    return plant.commands(TaskChanged)[-1]


def test_a_storage_task_sends_its_commands_in_order(hand: Any) -> None:
    plant, move = driven_to_the_arm(hand, Evidence.IDS)
    q = move.q
    plant.tell("ra1", state=STILL, q=q, accepted=move.id, done=move.id, effector=False)
    plant.tell("ra1", state=STILL, q=q, effector=True)
    plant.wait(0.2)
    away = plant.commands(MoveJoints)[-1]
    plant.tell("ra1", state=STILL, q=away.q, accepted=away.id, done=away.id)
    plant.tell("ra1", state=STILL, q=away.q, effector=False)
    plant.wait(0.2)
    home = plant.commands(MoveJoints)[-1]
    plant.tell("ra1", state=STILL, q=home.q, accepted=home.id, done=home.id)
    assert plant.states() == ["queued", "running", "done"]
    assert [command.on for command in plant.commands(SetEffector)] == [True, False]
    cell = plant.plant.model.cell("sis_a")
    layout = StorageLayout(cell)
    assert (q, away.q, home.q) == (layout.pickup.q, cell.stations[7].q, layout.home.q)
    assert len(plant.commands(SystemStart)) == 1 and not plant.commands(Stop)


def test_a_robot_already_at_its_goal_is_done_by_its_next_report(hand: Any) -> None:
    plant, move = driven_to_the_arm(hand, Evidence.IDS, at_goal=True)
    plant.tell("ra1", state=STILL, q=move.q, accepted=move.id, done=move.id)
    assert plant.commands(SetEffector)


def test_by_state_a_move_is_done_only_after_it_was_seen_moving(hand: Any) -> None:
    plant, _ = driven_to_the_arm(hand, Evidence.STATE)
    plant.tell("ra1", state=STILL)
    assert not plant.commands(SetEffector)
    plant.tell("ra1", state=MOVING)
    plant.tell("ra1", state=STILL)
    assert plant.commands(SetEffector)


SHORT = (0.3, 0.0, 0.0)
FAULTS: dict[str, tuple[Evidence, list[dict[str, Any]], Reason]] = {
    "ids: bridge restarted": (Evidence.IDS, [{"state": MOVING, "epoch": 2}], Reason.LINK_LOST),
    "ids: board rebooted": (Evidence.IDS, [{"state": STILL, "boot_id": 12}], Reason.REBOOTED),
    "ids: link lost": (Evidence.IDS, [{"state": MotionState.NO_LINK}], Reason.LINK_LOST),
    "ids: rejected": (
        Evidence.IDS,
        [{"state": STILL, "rejected": "ID", "refusal": "limite"}],
        Reason.REJECTED,
    ),
    "ids: not sent": (Evidence.IDS, [{"rejected": "ID", "refusal": "no_link"}], Reason.LINK_LOST),
    "ids: fault": (Evidence.IDS, [{"state": MotionState.FAULT}], Reason.DEVICE_FAULT),
    "ids: not homed": (Evidence.IDS, [{"state": MotionState.NOT_HOMED}], Reason.NOT_HOMED),
    "ids: latched": (Evidence.IDS, [{"state": MotionState.STOP_LATCHED}], Reason.STOPPED),
    "ids: short": (
        Evidence.IDS,
        [{"state": MOVING, "accepted": "ID"}, {"state": STILL, "q": SHORT, "accepted": "ID"}],
        Reason.STOPPED_SHORT,
    ),
    "ids: done off target": (
        Evidence.IDS,
        [{"state": STILL, "q": SHORT, "accepted": "ID", "done": "ID"}],
        Reason.NOT_REACHED,
    ),
    "joints: short": (
        Evidence.JOINTS,
        [{"state": MOVING, "q": (0.05, 0.0, 0.0)}, *[{"state": STILL, "q": (0.1, 0.0, 0.0)}] * 10],
        Reason.STOPPED_SHORT,
    ),
    "joints: jumped": (
        Evidence.JOINTS,
        [{"state": MOVING, "q": (0.05, 0.0, 0.0)}, {"state": STILL, "q": (0.9, 0.0, 0.0)}],
        Reason.REBOOTED,
    ),
    "state: link lost": (Evidence.STATE, [{"state": MotionState.NO_LINK}], Reason.LINK_LOST),
    "state: fault": (Evidence.STATE, [{"state": MotionState.FAULT}], Reason.DEVICE_FAULT),
}


def test_a_failure_names_what_somebody_else_sent_meanwhile(hand: Any) -> None:
    plant, move = driven_to_the_arm(hand, Evidence.IDS)
    sent = "ra1: joint_goals_q of /teach was sent to it"
    plant.plant.step(plant.now, [Interference(at=plant.now, robot="ra1", sentence=sent)])
    plant.tell("ra1", state=STILL, q=SHORT, accepted=move.id, done=move.id)
    plant.wait(20)
    assert str(last_change(plant).sentence).endswith(f"; {sent}")


@pytest.mark.parametrize(("evidence", "reports", "reason"), FAULTS.values(), ids=FAULTS)
def test_a_fault_fails_the_task_with_its_reason(
    hand: Any, evidence: Evidence, reports: list[dict[str, Any]], reason: Reason
) -> None:
    plant, move = driven_to_the_arm(hand, evidence)
    for report in reports:
        plant.tell("ra1", **{key: move.id if value == "ID" else value for key, value in report.items()})
    plant.wait(20)
    change = last_change(plant)
    assert (change.state.value, change.reason) == ("failed", reason)
    assert "ra1" in str(change.sentence) and "pick-up" in str(change.sentence)
    assert not plant.commands(SetEffector)
    assert plant.plant.at_rest


@pytest.mark.parametrize("evidence", [Evidence.IDS, Evidence.JOINTS])
def test_a_silent_robot_fails_its_move_and_is_halted(hand: Any, evidence: Evidence) -> None:
    plant, _ = driven_to_the_arm(hand, evidence)
    plant.wait(20)
    assert str(last_change(plant).sentence) == "ra1: no telemetry for 1.5 s while moving to pick-up"
    assert last_change(plant).reason is Reason.LINK_LOST
    assert [(stop.robot, stop.mode) for stop in plant.commands(Stop)] == [("ra1", StopMode.HALT)]
    assert plant.plant.cells["sis_a"].state is CellState.HELD


@pytest.mark.parametrize("evidence", list(Evidence))
def test_a_move_that_never_ends_meets_its_deadline(hand: Any, evidence: Evidence) -> None:
    plant, move = driven_to_the_arm(hand, evidence)
    for _ in range(120):
        plant.tell("ra1", after=0.1, state=MOVING, q=SHORT, accepted=move.id)
    plant.wait(20)
    assert last_change(plant).reason is Reason.DEADLINE
    assert [stop.mode for stop in plant.commands(Stop)] == [StopMode.HALT]


def test_a_report_stamped_by_the_deadline_counts(hand: Any) -> None:
    plant, _ = driven_to_the_arm(hand, Evidence.STATE)
    (entry,) = plant.plant.dispatcher.ledger.entries.values()
    plant.tell("ra1", after=entry.deadline - plant.now - 1, state=MOVING)
    plant.tell("ra1", after=1, state=STILL)
    assert plant.now == entry.deadline
    assert plant.commands(SetEffector)


def test_a_report_stamped_after_the_deadline_is_too_late(hand: Any) -> None:
    plant, _ = driven_to_the_arm(hand, Evidence.STATE)
    plant.tell("ra1", state=MOVING)
    plant.tell("ra1", after=60, state=STILL)
    assert not plant.commands(SetEffector)
    plant.tell("ra1", state=MotionState.FAULT)
    plant.wait(20)
    assert last_change(plant).reason is Reason.DEADLINE


def test_a_task_for_a_busy_cell_waits_and_delays_no_other(hand: Any) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    plant.submit("sis_a 0B 7")
    plant.submit("sis_a 0A 1")
    assert "sis_a is busy" in str(last_change(plant).sentence)
    plant.submit("sis_b 1C 3")
    running = [change.text for change in plant.commands(TaskChanged) if change.state.value == "running"]
    assert running == ["sis_a 0B 7", "sis_b 1C 3"]


def test_who_waits_behind_a_step_that_is_retried_is_told_that_the_queue_is_paused(hand: Any) -> None:
    plant, move = driven_to_the_arm(hand, Evidence.IDS)
    plant.operate(Verb.HOLD, "sis_a")
    plant.tell("ra1", state=MotionState.FAULT, q=SHORT, accepted=move.id)
    plant.tell("ra1", state=STILL, q=SHORT, accepted=move.id, done=None)
    plant.operate(Verb.RETRY, "sis_a")
    cell = plant.plant.cells["sis_a"]
    assert cell.state is CellState.EXECUTE and cell.queue.paused
    plant.submit("sis_a 0A 1")
    assert str(last_change(plant).sentence) == (
        "sis_a is busy, and its queue is paused; once it is idle, resume sis_a starts it"
    )


def test_a_full_queue_refuses_with_its_limit(hand: Any) -> None:
    plant = hand(Evidence.IDS)
    limit = plant.plant.model.cell("sis_a").queue_limit
    for _ in range(limit + 1):
        plant.submit("sis_a 0B 7")
    assert last_change(plant).state.value == "refused"
    assert f"{limit} tasks waiting" in str(last_change(plant).sentence)
    assert last_change(plant).for_now


def test_a_task_waits_for_robots_that_were_never_heard_and_says_so(hand: Any) -> None:
    plant = hand(Evidence.IDS)
    plant.submit("sis_a 0B 7")
    assert str(last_change(plant).sentence) == "ra1 was not heard yet"
    plant.awake()
    assert plant.states()[-1] == "running"


@pytest.mark.parametrize("heard", [None, 6], ids=["no plant", "another plant"])
def test_a_task_waits_until_the_bridge_hears_this_plant(hand: Any, heard: int | None) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    plant.tell("ra1", state=STILL, epoch=2, plant=heard)
    plant.submit("sis_a 0B 7")
    assert str(last_change(plant).sentence) == "ra1 has a bridge that does not hear this plant yet"
    plant.tell("ra1", state=STILL, epoch=2, plant=7)
    assert plant.states()[-1] == "running"


def test_the_same_id_and_text_is_the_same_task(hand: Any) -> None:
    plant = hand(Evidence.IDS)
    plant.submit("sis_a 0B 7 #lot42")
    plant.submit("SIS_A 0b 7 #lot42")
    assert [change.task for change in plant.commands(TaskChanged)] == ["lot42", "lot42"]
    assert len(plant.plant.cells["sis_a"].queue) == 1
    plant.submit("sis_a 0B 8 #lot42")
    assert last_change(plant).state.value == "refused"
    assert "already the id of 'sis_a 0B 7'" in str(last_change(plant).sentence)


def test_a_refused_text_changes_nothing(hand: Any) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    before = view.snapshot(plant.plant)
    plant.submit("sis_z 0B 7")
    assert last_change(plant).state.value == "refused"
    assert view.snapshot(plant.plant) == before


def test_a_failed_cell_is_held_and_the_others_go_on(hand: Any) -> None:
    plant, _ = driven_to_the_arm(hand, Evidence.IDS)
    plant.tell("ra1", state=MotionState.FAULT)
    for _ in range(12):
        for robot in plant.plant.model.robots:
            plant.tell(robot, after=0.1)
    plant.submit("sis_a 0B 7")
    assert last_change(plant).state.value == "queued" and "held" in str(last_change(plant).sentence)
    plant.submit("sis_b 1C 3")
    assert last_change(plant).state.value == "running"


def test_a_leaf_that_raises_fails_its_task_and_halts_its_robot(
    hand: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def raises(*args: Any) -> None:
        raise ZeroDivisionError("in a leaf")

    plant = hand(Evidence.IDS)
    monkeypatch.setattr(leaves.Act, "update", raises)
    plant.awake()
    plant.submit("sis_a palletizing")
    plant.wait(0.2)
    assert last_change(plant).reason is Reason.INTERNAL
    assert "ZeroDivisionError" in str(last_change(plant).sentence)
    assert [(stop.robot, stop.mode) for stop in plant.commands(Stop)] == [("ra1", StopMode.HALT)]
    plant.submit("sis_b 1C 3")
    assert last_change(plant).state.value == "running"


@pytest.mark.parametrize("drops_waiting", [False, True])
@pytest.mark.parametrize("evidence", list(Evidence))
def test_shutdown_halts_what_moves_and_rests_when_the_halt_is_confirmed(
    hand: Any, evidence: Evidence, drops_waiting: bool
) -> None:
    plant, move = driven_to_the_arm(hand, evidence)
    plant.tell("ra1", state=MOVING, q=(0.05, 0.0, 0.0), accepted=move.id)
    plant.plant.step(plant.now, [Shutdown(at=plant.now, drops_waiting=drops_waiting)])
    assert not plant.plant.at_rest
    for _ in range(2 if evidence is not Evidence.JOINTS else 8):
        plant.tell("ra1", state=STILL, q=(0.08, 0.0, 0.0), accepted=move.id)
    assert plant.plant.at_rest
    (task,) = plant.plant.intake.tasks.values()
    if drops_waiting:
        assert task.failure is not None and task.failure.reason is Reason.INTERRUPTED
    else:
        assert task.state is TaskState.RUNNING
        assert plant.plant.dispatcher.memory.value(Fact.STEP, task.id), "the next start finds it at its step"


def test_an_arm_that_goes_on_moving_is_waited_for_as_long_as_a_stop_may_take(hand: Any) -> None:
    plant = hand(Evidence.JOINTS)
    plant.awake()
    plant.submit("sis_a palletizing")
    context, failed_after = plant.plant.cells["sis_a"].context, 0.0
    while context.failures.first is None and failed_after < 10.0:
        failed_after += 0.1
        plant.tell("ra1", after=0.1, state=MOVING, q=(0.1, 0.0, 0.0))
    timing = plant.plant.model.timing
    assert failed_after == pytest.approx(timing.dwell_s + timing.stop_timeout_s, abs=0.15)
    assert str(context.failures.first.sentence) == "ra1 was still moving: no moving to home"
    assert plant.commands(MoveJoints) == []


@pytest.mark.parametrize("drops_waiting", [False, True])
def test_a_plant_without_work_rests_at_once_when_it_ends(hand: Any, drops_waiting: bool) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    said = plant.plant.step(plant.now, [Shutdown(at=plant.now, drops_waiting=drops_waiting)])
    assert plant.plant.at_rest
    assert not [message for message in said if isinstance(message, InternalError)]


def test_a_plant_that_ends_takes_no_task_and_shows_that_it_ends(hand: Any) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    plant.plant.step(plant.now, [Shutdown(at=plant.now)])
    plant.submit("sis_a 0B 7")
    assert last_change(plant).state.value == "refused"
    assert "the plant is ending" in str(last_change(plant).sentence)
    assert view.snapshot(plant.plant)["ending"] is True


def test_what_an_operator_does_is_shown_anew(hand: Any) -> None:
    plant, _ = driven_to_the_arm(hand, Evidence.IDS)
    before = plant.plant.version
    plant.plant.step(plant.now, [OperatorRequest(at=plant.now, verb=Verb.HOLD, scope="sis_a")])
    assert plant.plant.cells["sis_a"].state is CellState.HOLDING
    assert plant.plant.version != before


def test_a_cell_that_is_held_after_an_absence_is_shown_anew(hand: Any) -> None:
    plant, _ = driven_to_the_arm(hand, Evidence.IDS)
    before = plant.plant.version
    plant.plant.step(plant.now + 60.0, [])
    assert view.snapshot(plant.plant)["cells"][0]["state"] == "held"
    assert plant.plant.version != before


def test_a_snapshot_shows_open_tasks_and_the_last_ended_ones(hand: Any) -> None:
    plant = hand(Evidence.IDS)
    for number in range(view.RECENT + 5):
        plant.submit(f"sis_a 0B 7 #n{number}")
        plant.plant.intake.tasks[f"n{number}"].ended_at = plant.now
        plant.plant.cells["sis_a"].queue.clear()
    plant.submit("sis_b 0B 7 #open")
    shown = [task["id"] for task in view.snapshot(plant.plant)["tasks"]]
    assert shown == [*(f"n{number}" for number in range(5, view.RECENT + 5)), "open"]
    assert view.task_by_id(plant.plant, "n0")["text"] == "sis_a 0B 7"
    assert view.task_by_id(plant.plant, "n99") is None


def test_a_mobile_elsewhere_is_driven_to_the_start_first(hand: Any) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    plant.tell("rm_sis_a", state=STILL, node=4)
    plant.submit("sis_a 0B 7")
    plant.wait(0.2)
    (there,) = plant.commands(FollowPath)
    assert there.nodes == (4, 1, 0)
    plant.tell("rm_sis_a", state=STILL, node=0, accepted=there.id, done=there.id)
    assert plant.commands(FollowPath)[-1].nodes == (0, 3, 4, 7)


def test_the_heartbeat_names_the_epoch_every_quarter_second(hand: Any) -> None:
    plant = hand(Evidence.IDS)
    plant.wait(1.0)
    assert plant.commands(Heartbeat) == [Heartbeat(epoch=7)] * 5


def test_the_same_inputs_give_the_same_outputs() -> None:
    def run() -> list[Any]:
        plant = Plant(shipped(), epoch=3, now=0.0)
        return [plant.step(0.1 * n, [TaskRequest(at=0.1 * n, text="sis_a 0B 7")]) for n in range(5)]

    assert run() == run()


@pytest.mark.parametrize(("stale_after_s", "away_after_s"), [(0.3, 1.0), (1.2, 1.2), (30.0, 1.5)])
def test_how_long_a_plant_may_do_nothing_hangs_on_silence_and_on_the_boards_own_watch(
    stale_after_s: float, away_after_s: float
) -> None:
    model = replace(shipped(), timing=Timing(stale_after_s=stale_after_s))
    assert Plant(model, epoch=7, now=0.0).away_after_s == away_after_s
