"""Bounded retries where one can help, and the piece sensor asked before, after and on the way."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import pytest

from arboleda.kinds.mobile import FollowPath
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Reason, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import Evidence, Retry
from arboleda.rig import faults
from arboleda.sim.arm import ArmBody
from arboleda.sim.mobile import MobileBody
from arboleda.testing import Rig
from arboleda.testing.storage_layout import StorageLayout
from arboleda.trees.tree_run import TreeRun
from arboleda.wire.transport import Publication
from arboleda_proofs.testing import Witness

Stage = Callable[..., tuple[Rig, Witness]]
TASK = "sis_a 0B 7"
TWICE = Retry(times=2, backoff_s=1.5)
levels = pytest.mark.parametrize("evidence", list(Evidence))


def cell(rig: Rig) -> Any:
    return rig.plant.cells["sis_a"]


def body(rig: Rig) -> ArmBody:
    return cast(ArmBody, rig.devices.boards["ra_1"].body)


def ended(rig: Rig, seconds: float = 120.0) -> TaskChanged:
    assert rig.wait(seconds, until=lambda: cell(rig).task is None), "it hangs"
    (change,) = rig.outcomes().values()
    return change


def first_lost(rig: Rig, topic: str, count: int) -> list[float]:
    """Lose the first `count` messages of a topic; when each of them, and of the later ones, was published."""
    published: list[float] = []

    def lost(publication: Publication) -> bool:
        if publication.topic != topic:
            return False
        published.append(rig.now)
        return len(published) <= count

    rig.lost = lost
    return published


def honest(witness: Witness) -> bool:
    return not witness.false_successes and not witness.illegal


@pytest.mark.sampled(4)
@levels
@pytest.mark.parametrize("topic", ["ra_1/juntas", "rm_sis_a/camino"])
def test_a_lost_goal_is_sent_again_after_the_back_off(stage: Stage, evidence: Evidence, topic: str) -> None:
    rig, witness = stage(evidence, retry=TWICE)
    goals = first_lost(rig, topic, 2)
    rig.submit(TASK)
    assert ended(rig).state is TaskState.DONE
    first, second, third = goals[:3]
    timeout_s = StorageLayout(rig.model.cell("sis_a")).arm.timeout_s
    assert second - first >= timeout_s + TWICE.backoff_s and third - second >= timeout_s + TWICE.backoff_s
    assert honest(witness)


@pytest.mark.sampled(3)
@levels
@pytest.mark.parametrize(
    ("starts_on", "drives"),
    [
        (2, [(2, 1, 0), (8, 5, 2, 1, 0), (0, 3, 4, 7)]),
        (0, [(0, 3, 4, 7), (8, 5, 2, 1, 0, 3, 4, 7)]),
    ],
    ids=["on the way to the start", "on the path"],
)
def test_a_drive_is_given_anew_from_where_the_mobile_was_carried_to(
    stage: Stage, evidence: Evidence, starts_on: int, drives: list[tuple[int, ...]]
) -> None:
    rig, witness = stage(evidence, retry=TWICE)
    put(rig, starts_on)
    goals = first_lost(rig, "rm_sis_a/camino", 1)
    rig.submit(TASK)
    rig.wait(5.0, until=lambda: bool(goals))
    put(rig, 8)
    assert ended(rig).state is TaskState.DONE
    assert [each.nodes for each in rig.sent if isinstance(each, FollowPath)] == drives
    assert honest(witness)


def test_where_a_cell_drives_to_no_start_a_path_is_given_anew_as_it_was(stage: Stage) -> None:
    rig, witness = stage(retry=TWICE, drive_to_start=False)
    first_lost(rig, "rm_sis_a/camino", 1)
    rig.submit(TASK)
    rig.wait(5.0, until=lambda: any(isinstance(each, FollowPath) for each in rig.sent))
    put(rig, 8)
    assert ended(rig).reason is Reason.REJECTED
    assert {each.nodes for each in rig.sent if isinstance(each, FollowPath)} == {(0, 3, 4, 7)}
    assert honest(witness)


@pytest.mark.parametrize("starts_on", [0, 4])
def test_a_mobile_that_is_silent_as_its_drive_begins_is_led_to_the_start_from_where_it_is_seen_next(
    stage: Stage, starts_on: int
) -> None:
    rig, witness = stage(retry=TWICE)
    put(rig, starts_on)
    rig.lost = lambda publication: publication.topic.startswith("rm_sis_a/")
    rig.wait(rig.plant.model.timing.stale_after_s - 0.1)
    rig.submit(TASK)
    rig.wait(0.4, until=lambda: not rig.plant.dispatcher.beliefs["rm_sis_a"].online)
    rig.wait(0.2)
    rig.lost = lambda publication: False
    assert ended(rig).state is TaskState.DONE
    drives = [each.nodes for each in rig.sent if isinstance(each, FollowPath)]
    assert drives == [*([(4, 1, 0)] if starts_on else []), (0, 3, 4, 7)]
    assert honest(witness)


def put(rig: Rig, node: int) -> None:
    """Carry the mobile robot there, and wait until it has said so."""
    body = cast(MobileBody, rig.devices.boards["rm_sis_a"].body)
    body.node = body.true_node = node
    rig.wait(0.5)


@pytest.mark.sampled(2)
@levels
def test_a_goal_that_is_lost_every_time_fails_after_the_declared_tries(
    stage: Stage, evidence: Evidence
) -> None:
    rig, witness = stage(evidence, retry=TWICE)
    goals = first_lost(rig, "rm_sis_a/camino", 99)
    rig.submit(TASK)
    change = ended(rig)
    assert (change.state, change.reason) == (TaskState.FAILED, Reason.DEADLINE)
    assert len(goals) == 1 + TWICE.times
    assert cell(rig).state is CellState.IDLE and honest(witness)


def broker_blip(rig: Rig) -> None:
    rig.stop_broker()
    rig.wait(1.0)
    rig.start_broker()


def silence(seconds: float) -> Callable[[Rig], None]:
    def fault(rig: Rig) -> None:
        rig.lost = lambda publication: True
        rig.wait(seconds)
        rig.lost = lambda publication: False

    return fault


HELPS = {"broker away for 1 s": broker_blip, "silence for 2 s": silence(2.0)}


@pytest.mark.sampled(4)
@pytest.mark.parametrize("evidence", [Evidence.IDS, Evidence.JOINTS])
@pytest.mark.parametrize("fault", HELPS)
@pytest.mark.parametrize("step", ["drive path 0B", "move to pick-up", "move to station 7", "move to home"])
def test_a_link_that_comes_back_within_the_back_off_costs_only_time(
    stage: Stage, evidence: Evidence, fault: str, step: str
) -> None:
    rig, witness = stage(evidence, retry=TWICE)
    rig.submit(TASK)
    rig.wait_for("sis_a", step)
    rig.wait(0.5)
    HELPS[fault](rig)
    assert ended(rig).state is TaskState.DONE
    assert witness.part["ra1"] == "station 7" and honest(witness)


def fault_code(rig: Rig) -> None:
    rig.carry = faults.says("ra_1", estado=2)


HOPELESS: dict[str, Callable[[Rig], None]] = {
    "the board reboots": lambda rig: rig.crash("ra_1"),
    "the board reports a fault": fault_code,
    "the part falls": lambda rig: body(rig).lose_piece(),
}


@pytest.mark.sampled(5)
@levels
@pytest.mark.parametrize("fault", HOPELESS)
def test_what_no_retry_can_help_is_sent_once(stage: Stage, evidence: Evidence, fault: str) -> None:
    rig, witness = stage(evidence, retry=TWICE, piece_check=True)
    rig.submit(TASK)
    rig.wait_for("sis_a", "move to station 7")
    rig.wait(0.5)
    HOPELESS[fault](rig)
    change = ended(rig)
    assert change.state is TaskState.FAILED
    goal = [each for _, each in rig.to_boards if each.topic == "ra_1/juntas" and b'"q2":19.8' in each.payload]
    assert len(goal) == 1
    assert honest(witness)


@pytest.mark.sampled(3)
@levels
@pytest.mark.parametrize("verb", [Verb.STOP, Verb.CANCEL])
def test_stop_and_cancel_end_a_back_off(stage: Stage, evidence: Evidence, verb: Verb) -> None:
    rig, witness = stage(evidence, retry=TWICE)
    goals = first_lost(rig, "rm_sis_a/camino", 1)
    rig.submit(TASK)
    rig.wait(120.0, until=lambda: "try 1 of 2 follows" in feedback(rig))
    rig.wait(0.5)
    assert rig.operate(verb, "sis_a") is None
    ended(rig)
    rig.wait(20.0)
    assert len(goals) == 1 and honest(witness)


def feedback(rig: Rig) -> str:
    tree = cell(rig).tree
    return " ".join(node.feedback_message for node in tree.iterate()) if tree else ""


@pytest.mark.sampled(3)
@levels
def test_a_back_off_stands_still_while_the_cell_is_held(stage: Stage, evidence: Evidence) -> None:
    rig, witness = stage(evidence, retry=TWICE)
    goals = first_lost(rig, "rm_sis_a/camino", 1)
    rig.submit(TASK)
    rig.wait(120.0, until=lambda: "try 1 of 2 follows" in feedback(rig))
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(30.0)
    assert cell(rig).state is CellState.HELD and len(goals) == 1
    again = Verb.RESUME if cell(rig).trouble is None else Verb.RETRY
    assert rig.operate(again, "sis_a") is None
    assert ended(rig).state is TaskState.DONE
    assert honest(witness)


@pytest.mark.sampled(3)
@levels
@pytest.mark.parametrize("late_s", [0.0, 1.0, 4.0])
def test_a_piece_that_comes_in_time_is_gripped(stage: Stage, evidence: Evidence, late_s: float) -> None:
    retry = TWICE if late_s > 2.0 else Retry()
    rig, witness = stage(evidence, piece_check=True, retry=retry)
    body(rig).supplied = False
    rig.submit(TASK)
    rig.wait_for("sis_a", "piece there")
    rig.wait(late_s)
    body(rig).supplied = True
    assert ended(rig).state is TaskState.DONE
    assert witness.part["ra1"] == "station 7" and honest(witness)


@levels
@pytest.mark.parametrize("times", [0, 2])
def test_a_piece_that_never_comes_is_waited_for_as_long_as_declared(
    stage: Stage, evidence: Evidence, times: int
) -> None:
    rig, witness = stage(evidence, piece_check=True, retry=Retry(times=times, backoff_s=1.5))
    body(rig).supplied = False
    rig.submit(TASK)
    rig.wait_for("sis_a", "piece there")
    began, wait_s = rig.now, rig.model.timing.piece_wait_s
    assert rig.wait(60.0, until=lambda: cell(rig).context.failures.first is not None)
    assert rig.now - began == pytest.approx(wait_s + times * (1.5 + wait_s))
    change = ended(rig)
    assert (change.state, change.reason, cell(rig).state) == (
        TaskState.FAILED,
        Reason.NO_PIECE,
        CellState.IDLE,
    )
    assert str(change.sentence) == "ra1: no piece at pick-up"
    assert witness.switches == [], "nothing was gripped, so nothing is let go"


def test_a_tree_that_waits_for_a_piece_is_left_alone_by_reports_that_there_is_none(
    stage: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig, _ = stage(piece_check=True)
    body(rig).supplied = False
    rig.submit(TASK)
    rig.wait_for("sis_a", "piece there")
    rig.wait(0.5)
    ticks: list[float] = []
    usual = TreeRun.tick
    monkeypatch.setattr(TreeRun, "tick", lambda run: (ticks.append(rig.now), usual(run))[1])
    rig.wait(1.0)
    assert ticks == [] and rig.runs("sis_a", "piece there")
    body(rig).supplied = True
    assert ended(rig).state is TaskState.DONE


def grips_at(rig: Rig, attempt: int) -> None:
    """The effector closes beside the piece, up to a later attempt; the sensor sees that at once."""
    arm, tried = body(rig), [0]
    arm.grips = False
    usual, was_on = rig.carry, [False]

    def carry(publication: Publication) -> Any:
        if arm.effector and not was_on[0]:
            tried[0] += 1
            arm.grips = tried[0] >= attempt
            arm.switch_effector(True)
        was_on[0] = arm.effector
        beside = arm.effector and not arm.holding
        for each in usual(publication):
            told = b'"pieza":' in each.payload and publication.topic == "ra_1/sensores"
            yield from faults.says("ra_1", pieza=0)(each) if beside and told else [each]

    rig.carry = carry


@pytest.mark.parametrize(
    ("evidence", "reason"), [(Evidence.IDS, Reason.NOT_REACHED), (Evidence.JOINTS, Reason.STOPPED_SHORT)]
)
@pytest.mark.parametrize("times", [0, 1])
def test_a_move_that_ended_before_its_goal_is_given_again(
    stage: Stage, evidence: Evidence, reason: Reason, times: int
) -> None:
    rig, witness = stage(evidence, retry=Retry(times=times, backoff_s=0.5))
    rig.submit(TASK)
    rig.wait_for("sis_a", "move to pick-up")
    rig.wait(0.5)
    body(rig).stop(round(rig.now * 1e6))
    assert ended(rig).reason is (None if times else reason) and honest(witness)


@pytest.mark.sampled(2)
@levels
@pytest.mark.parametrize("attempt", [2, 3])
def test_a_missed_grip_is_tried_again(stage: Stage, evidence: Evidence, attempt: int) -> None:
    rig, witness = stage(evidence, piece_check=True, retry=TWICE)
    grips_at(rig, attempt)
    rig.submit(TASK)
    assert ended(rig).state is TaskState.DONE
    assert [each.on for each in witness.switches] == [True, False] * attempt
    assert witness.part["ra1"] == "station 7" and not witness.illegal


@levels
@pytest.mark.parametrize("times", [0, 2])
def test_a_grip_that_is_missed_every_time_fails_after_the_declared_tries(
    stage: Stage, evidence: Evidence, times: int
) -> None:
    rig, witness = stage(evidence, piece_check=True, retry=Retry(times=times, backoff_s=0.5))
    grips_at(rig, 99)
    rig.submit(TASK)
    change = ended(rig)
    assert (change.state, change.reason) == (TaskState.FAILED, Reason.NOT_GRIPPED)
    assert cell(rig).state is CellState.IDLE
    assert [each.on for each in witness.switches] == [True, False] * (times + 1)
    assert honest(witness)


def test_an_effector_that_answers_only_the_second_attempt_fails_no_task(stage: Stage) -> None:
    once = Retry(times=1, backoff_s=0.5)
    rig, witness = stage(piece_check=True, retry=once)
    first_lost(rig, "ra_1/efector", 2)
    rig.submit(TASK)
    change = ended(rig)
    delivered = witness.part.get("ra1") == "station 7"
    assert (change.state is TaskState.DONE) == delivered, change
    assert not witness.illegal


@levels
def test_a_value_from_before_the_arm_arrived_does_not_count(stage: Stage, evidence: Evidence) -> None:
    rig, _ = stage(evidence, piece_check=True)
    rig.submit(TASK)
    rig.wait_for("sis_a", "move to pick-up")
    rig.carry = faults.says("ra_1", pieza=1)
    rig.wait(0.5)
    rig.carry = faults.says("ra_1", pieza=None)
    change = ended(rig)
    assert change.reason is Reason.NO_PIECE


@levels
def test_a_sensor_that_speaks_at_changes_only_is_believed_at_any_age(
    stage: Stage, evidence: Evidence
) -> None:
    rig, witness = stage(evidence, piece_check=True, arm={"piece_on_change": True})
    usual, last = rig.carry, [b""]

    def carry(publication: Publication) -> Any:
        for each in usual(publication):
            told = each.payload[-10:] if b'"pieza":' in each.payload else last[0]
            changed, last[0] = told != last[0], told
            yield from [each] if changed else faults.says("ra_1", pieza=None)(each)

    rig.carry = carry
    rig.submit(TASK)
    assert ended(rig).state is TaskState.DONE
    assert honest(witness)


@levels
def test_a_part_that_falls_is_noticed_once_it_is_gone_for_the_debounce_time(
    stage: Stage, evidence: Evidence
) -> None:
    rig, witness = stage(evidence, piece_check=True, retry=TWICE)
    rig.submit(TASK)
    rig.wait_for("sis_a", "move to station 7")
    rig.wait(0.5)
    body(rig).supplied = False
    body(rig).lose_piece()
    fell_at = rig.now
    assert rig.wait(10.0, until=lambda: cell(rig).context.failures.first is not None)
    timing = rig.model.timing
    assert timing.piece_debounce_s <= rig.now - fell_at <= timing.piece_debounce_s + 0.3
    change = ended(rig)
    assert (change.reason, cell(rig).state) == (Reason.PART_LOST, CellState.IDLE)
    assert str(change.sentence) == "ra1: the part was lost on the way"
    assert (witness.part["ra1"], honest(witness)) == ("floor", True)


@levels
def test_palletizing_checks_its_piece_too(stage: Stage, evidence: Evidence) -> None:
    rig, witness = stage(evidence, piece_check=True)
    rig.submit("ra1 palletizing")
    assert ended(rig).state is TaskState.DONE
    assert witness.part["ra1"] == "station 8" and honest(witness)
