"""The operator's verbs: done or refused with a sentence, in every state; and what must survive everything."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from tests.scenario.restarts import crash_without_trail
from tests.scenario.test_operator import TASK, aborted, act, cell, fetch, levels, stopping

from arboleda.core import reasons
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Command
from arboleda.model.messages import Fact, Journal, OperatorRequest, Reason, TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig import faults
from arboleda.testing import Rig
from arboleda.wire.transport import Publication
from arboleda_proofs.testing import Witness

Stage = Callable[..., tuple[Rig, Witness]]


def carry(rig: Rig) -> None:
    """The part is on its way to its station."""
    rig.submit(TASK)
    rig.wait_for("sis_a", "move to station 7")
    rig.wait(0.5)


def break_down(rig: Rig) -> None:
    """A fault that the recovery cannot mend, and that is over then; the arm holds its part."""
    carry(rig)
    truth, rig.carry = rig.carry, faults.says("ra_1", estado=2)
    assert rig.wait(20.0, until=lambda: cell(rig).task is None)
    rig.carry = truth
    rig.wait(2.0)


def clearing(rig: Rig) -> None:
    aborted(rig)
    rig.lost = faults.to_board("ra_1")
    assert rig.operate(Verb.CLEAR, "sis_a") is None


def stopped(rig: Rig) -> None:
    aborted(rig)
    act(rig, Verb.CLEAR)


def paused(rig: Rig) -> None:
    stopped(rig)
    act(rig, Verb.RESET)


def holding(rig: Rig) -> None:
    fetch(rig)
    assert rig.operate(Verb.HOLD, "sis_a") is None


def held(rig: Rig) -> None:
    carry(rig)
    act(rig, Verb.HOLD)


def held_by_a_fault(rig: Rig) -> None:
    carry(rig)
    act(rig, Verb.HOLD)
    rig.lost = lambda publication: True
    rig.wait(2.0)
    rig.lost = lambda publication: False
    rig.wait(0.5)


STATES: dict[str, tuple[Callable[[Rig], None], CellState, set[Verb]]] = {
    "idle": (lambda rig: None, CellState.IDLE, {Verb.RELEASE, Verb.HOME}),
    "idle, its queue paused": (paused, CellState.IDLE, {Verb.RESUME, Verb.RELEASE, Verb.HOME}),
    "execute": (fetch, CellState.EXECUTE, {Verb.HOLD, Verb.CANCEL}),
    "holding": (holding, CellState.HOLDING, set()),
    "held": (
        held,
        CellState.HELD,
        {Verb.RESUME, Verb.CANCEL, Verb.ABANDON, Verb.RELEASE, Verb.HOME},
    ),
    "held by a fault": (
        held_by_a_fault,
        CellState.HELD,
        {Verb.RETRY, Verb.CANCEL, Verb.ABANDON, Verb.RELEASE, Verb.HOME},
    ),
    "held by a failed recovery": (
        break_down,
        CellState.HELD,
        {Verb.RETRY, Verb.RELEASE, Verb.HOME},
    ),
    "aborting": (stopping, CellState.ABORTING, set()),
    "aborted": (aborted, CellState.ABORTED, {Verb.CLEAR, Verb.RELEASE}),
    "clearing": (clearing, CellState.CLEARING, {Verb.CLEAR, Verb.RELEASE}),
    "stopped": (stopped, CellState.STOPPED, {Verb.RESET, Verb.RELEASE}),
}


def facts(rig: Rig) -> Any:
    """Everything that a refused verb must leave as it is."""
    latched = set(rig.plant.dispatcher.latches.stopped)
    grip = rig.plant.dispatcher.effectors.grips["ra1"]
    return rig.snapshot(), latched, grip, {fact: dict(kept) for fact, kept in rig.disk.facts.items()}


VERBS = [(verb, "sis_a") for verb in Verb] + [(verb, "ra1") for verb in (Verb.RELEASE, Verb.HOME)]


ALLOWED = {
    state: [(verb, scope) for verb, scope in VERBS if verb is Verb.STOP or verb in allowed]
    for state, (_, _, allowed) in STATES.items()
}


CASES = [(state, verb, scope) for state, pairs in ALLOWED.items() for verb, scope in pairs]


def brought(stage: Stage, state: str) -> tuple[Rig, Witness]:
    rig, witness = stage()
    bring, where, _ = STATES[state]
    bring(rig)
    assert cell(rig).state is where
    return rig, witness


def foretold(rig: Rig, verb: Verb, scope: str) -> str | None:
    """The refusal that is foretold; to ask for it changes nothing."""
    before = facts(rig)
    refusal = rig.plant.refusal(OperatorRequest(at=rig.now, verb=verb, scope=scope))
    assert facts(rig) == before
    return None if refusal is None else str(refusal)


def news(rig: Rig, since: int) -> list[Journal | Command]:
    return [message for message in rig.sent[since:] if isinstance(message, (Journal, Command))]


def goes_on(rig: Rig, witness: Witness, *, opened: bool) -> None:
    rig.lost = lambda publication: False
    rig.wait(10.0)
    assert witness.false_successes == []
    assert witness.illegal == [] or opened
    assert rig.plant.at_rest or cell(rig).state is CellState.HELD


@pytest.mark.sampled(14)
@pytest.mark.parametrize(("state", "verb", "scope"), CASES, ids=lambda word: getattr(word, "value", word))
def test_a_verb_that_a_state_allows_is_done(stage: Stage, state: str, verb: Verb, scope: str) -> None:
    rig, witness = brought(stage, state)
    sent = len(rig.sent)
    assert foretold(rig, verb, scope) is None
    assert rig.operate(verb, scope) is None
    journal = [each for each in news(rig, sent) if isinstance(each, Journal)]
    assert [each.verb for each in journal if each.outcome is None] == [verb]
    goes_on(rig, witness, opened=verb is Verb.RELEASE)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("state", STATES)
def test_every_other_verb_is_refused_and_changes_nothing(stage: Stage, state: str) -> None:
    rig, witness = brought(stage, state)
    before, sent, told = facts(rig), len(rig.sent), len(rig.to_boards)
    for verb, scope in VERBS:
        if (verb, scope) not in ALLOWED[state]:
            refusal = rig.operate(verb, scope)
            assert refusal == foretold(rig, verb, scope)
            assert refusal is not None and len(refusal.split()) > 3
            assert (facts(rig), news(rig, sent), len(rig.to_boards)) == (before, [], told)
    goes_on(rig, witness, opened=False)


@levels
def test_a_verb_for_nobody_is_refused(stage: Stage, evidence: Evidence) -> None:
    rig, _ = stage(evidence)
    for scope in ("sis_z", "ra9", "sis_a ra1"):
        assert "there are sis_a, ra1, rm_sis_a" in str(rig.operate(Verb.STOP, scope))
    assert cell(rig).state is CellState.IDLE


@pytest.mark.sampled(6)
@levels
@pytest.mark.parametrize("bring", [fetch, carry], ids=["empty", "with the part"])
def test_a_crash_keeps_the_latch(stage: Stage, evidence: Evidence, bring: Callable[[Rig], None]) -> None:
    rig, witness = stage(evidence)
    bring(rig)
    act(rig, Verb.STOP)
    mark, on = len(rig.to_boards), rig.devices.boards["ra_1"].body.effector  # type: ignore[attr-defined]
    rig.crash()
    rig.wait(3.0)
    assert cell(rig).state is CellState.ABORTED
    assert rig.submit("sis_a 0B 1").state is TaskState.QUEUED
    rig.wait(5.0)
    boards = [rig.devices.boards[name] for name in ("ra_1", "rm_sis_a")]
    assert all(board.latched for board in boards)
    latches = [each.topic for _, each in rig.to_boards[mark:] if b'"paro":1' in each.payload]
    assert set(latches) == {"ra_1/paro", "rm_sis_a/paro"}, "stopped again"
    act(rig, Verb.CLEAR, Verb.RESET)
    rig.wait(5.0)
    assert witness.motions_since(mark, rig.model.robots) == []
    assert boards[0].body.effector is on  # type: ignore[attr-defined]
    assert cell(rig).state is (CellState.HELD if on else CellState.IDLE)
    if on:
        act(rig, Verb.RETRY)
        rig.wait(30.0)
    assert cell(rig).queue, "a crash pauses the queue"
    act(rig, Verb.RESUME)
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert list(rig.outcomes().values())[-1].state is TaskState.DONE
    assert witness.illegal == []


@levels
def test_a_crash_between_clear_and_reset_still_needs_a_reset(stage: Stage, evidence: Evidence) -> None:
    rig, witness = stage(evidence)
    fetch(rig)
    act(rig, Verb.STOP, Verb.CLEAR)
    mark = len(rig.to_boards)
    rig.crash()
    rig.wait(2.0)
    rig.submit("sis_a 0B 1")
    rig.wait(10.0)
    assert witness.motions_since(mark, rig.model.robots) == []


@pytest.mark.sampled(3)
@levels
@pytest.mark.parametrize("bring", [fetch, carry], ids=["empty", "with the part"])
def test_after_a_crash_in_a_task_nothing_moves_by_itself(
    stage: Stage, evidence: Evidence, bring: Callable[[Rig], None]
) -> None:
    rig, witness = stage(evidence)
    bring(rig)
    on = rig.devices.boards["ra_1"].body.effector  # type: ignore[attr-defined]
    mark = len(rig.to_boards)
    crash_without_trail(rig)
    rig.wait(20.0)
    assert witness.motions_since(mark, rig.model.robots) == []
    assert rig.devices.boards["ra_1"].body.effector is on  # type: ignore[attr-defined]
    assert cell(rig).state is (CellState.HELD if on else CellState.IDLE)
    if on:
        act(rig, Verb.RETRY)
        rig.wait(30.0)
        assert (cell(rig).state, witness.part["ra1"]) == (CellState.IDLE, "pick-up")


def test_what_went_wrong_in_a_hold_is_told_in_words_that_stay_true(stage: Stage) -> None:
    rig, _ = stage()
    held(rig)
    rig.power_off("ra_1")
    rig.wait(3.0)
    assert str(cell(rig).trouble.sentence) == "ra1 was lost"


def test_clear_is_refused_while_a_robot_moves(stage: Stage) -> None:
    rig, _ = stage()
    rig.submit(TASK)
    rig.wait_for("sis_a", "drive path 0B")
    rig.wait(0.3)
    rig.operate(Verb.STOP, "sis_a")
    assert "aborting" in str(rig.operate(Verb.CLEAR, "sis_a"))
    rig.wait(0.3)
    assert rig.operate(Verb.CLEAR, "sis_a") is not None
    rig.wait(2.0)
    assert rig.operate(Verb.CLEAR, "sis_a") is None


@levels
def test_a_board_that_does_not_confirm_a_stop_is_named(stage: Stage, evidence: Evidence) -> None:
    rig, _ = stage(evidence)
    fetch(rig)
    rig.carry = faults.says("ra_1", estado=1)
    rig.operate(Verb.STOP, "sis_a")
    stop_s = rig.model.timing.stop_timeout_s
    assert rig.wait(stop_s + 0.1, until=lambda: cell(rig).state is CellState.ABORTED)
    assert cell(rig).trouble.reason is Reason.STOP_UNCONFIRMED
    assert "ra1 did not confirm the stop" in str(cell(rig).trouble.sentence)
    assert "ra1 is not still yet" in str(rig.operate(Verb.CLEAR, "sis_a"))


@pytest.mark.sampled(3)
@levels
@pytest.mark.parametrize("away", ["broker", "bridge", "board"])
def test_a_stop_reaches_a_board_that_was_away(stage: Stage, evidence: Evidence, away: str) -> None:
    rig, witness = stage(evidence)
    fetch(rig)
    gone = {"broker": rig.stop_broker, "bridge": rig.stop_bridge, "board": lambda: rig.power_off("ra_1")}
    back = {"broker": rig.start_broker, "bridge": rig.start_bridge, "board": lambda: rig.power_on("ra_1")}
    gone[away]()
    rig.wait(1.0)
    mark = len(rig.to_boards)
    assert rig.operate(Verb.STOP, "sis_a") is None
    rig.wait(3.0)
    back[away]()
    rig.wait(2.0)
    assert rig.devices.boards["ra_1"].latched and rig.devices.boards["rm_sis_a"].latched
    rig.wait(20.0)
    assert witness.motions_since(mark, rig.model.robots) == []
    assert cell(rig).state is CellState.ABORTED


@levels
@pytest.mark.parametrize("again", ["board", "bridge", "broker"])
def test_a_stop_is_repeated_to_a_board_that_may_have_forgotten_it(
    stage: Stage, evidence: Evidence, again: str
) -> None:
    rig, witness = stage(evidence)
    fetch(rig)
    act(rig, Verb.STOP)
    mark = len(rig.to_boards)
    if again == "board":
        rig.crash("ra_1")
    elif again == "bridge":
        rig.stop_bridge()
        rig.start_bridge()
    else:
        rig.stop_broker()
        rig.start_broker()
    rig.wait(2.0)
    assert rig.devices.boards["ra_1"].latched
    assert any(each.topic == "ra_1/paro" and b'"paro":1' in each.payload for _, each in rig.to_boards[mark:])
    assert witness.motions_since(mark, rig.model.robots) == []


FAULTS: dict[str, Callable[[Rig], None]] = {
    "the arm's board reboots": lambda rig: rig.crash("ra_1"),
    "the mobile's board reboots": lambda rig: rig.crash("rm_sis_a"),
    "the arm's board dies": lambda rig: rig.power_off("ra_1"),
    "somebody latches the arm": lambda rig: rig.inject(foreign_stop("ra_1")),
}


def foreign_stop(board: str) -> Publication:
    return Publication(topic=f"{board}/paro", payload=b'{"paro":1,"seq":1,"epoca":1}')


@pytest.mark.sampled(4)
@levels
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_while_held_makes_resume_impossible(stage: Stage, evidence: Evidence, fault: str) -> None:
    rig, witness = stage(evidence)
    held(rig)
    FAULTS[fault](rig)
    rig.wait(2.0)
    mark = len(rig.to_boards)
    assert cell(rig).trouble is not None
    robbed = (
        evidence is Evidence.IDS and fault == "the arm's board reboots"
    )  # its effector went off, and says so
    refusal = str(rig.operate(Verb.RESUME, "sis_a"))
    assert (
        refusal == str(reasons.of_hold(cell(rig))) and "abandon sis_a" in refusal
    ) or "stop sis_a" in refusal
    assert ("no part to go on with" in refusal) is robbed
    rig.wait(10.0)
    assert witness.motions_since(mark, rig.model.robots) == []
    assert rig.operate(Verb.ABANDON, "sis_a") is None
    assert rig.wait(30.0, until=lambda: cell(rig).task is None)
    (change,) = rig.outcomes().values()
    assert change.state is TaskState.FAILED and change.reason is not Reason.CANCELLED
    assert (witness.false_successes, witness.illegal) == ([], [])


@pytest.mark.parametrize("evidence", [Evidence.IDS, Evidence.JOINTS])
def test_a_link_lost_and_found_while_held_is_retried(stage: Stage, evidence: Evidence) -> None:
    rig, witness = stage(evidence)
    held(rig)
    rig.lost = lambda publication: True
    rig.wait(3.0)
    rig.lost = lambda publication: False
    rig.wait(1.0)
    assert cell(rig).trouble.reason is Reason.LINK_LOST
    assert "retry" in str(rig.operate(Verb.RESUME, "sis_a"))
    assert rig.operate(Verb.RETRY, "sis_a") is None
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    (change,) = rig.outcomes().values()
    assert change.state is TaskState.DONE
    assert (witness.false_successes, witness.illegal) == ([], [])


@pytest.mark.sampled(2)
@levels
def test_after_a_failed_recovery_retry_carries_the_part_back(stage: Stage, evidence: Evidence) -> None:
    rig, witness = stage(evidence)
    break_down(rig)
    (change,) = rig.outcomes().values()
    assert (change.state, change.reason) == (TaskState.FAILED, Reason.DEVICE_FAULT)
    assert witness.part["ra1"] == "effector"
    rig.submit("sis_a 0B 1")
    assert "held" in str(reasons.of_waiting(cell(rig)))
    act(rig, Verb.RETRY)
    assert rig.wait(30.0, until=lambda: cell(rig).state is CellState.IDLE)
    assert witness.part["ra1"] == "pick-up"
    rig.wait(10.0)
    assert cell(rig).queue, "held paused the queue"
    act(rig, Verb.RESUME)
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert [change.state for change in rig.outcomes().values()] == [TaskState.FAILED, TaskState.DONE]
    assert witness.illegal == []


@levels
def test_after_a_failed_recovery_the_part_is_released_before_it_is_abandoned(
    stage: Stage, evidence: Evidence
) -> None:
    rig, witness = stage(evidence)
    break_down(rig)
    assert "release ra1 first" in str(rig.operate(Verb.ABANDON, "sis_a"))
    mark = len(rig.to_boards)
    act(rig, Verb.RELEASE, scope="ra1")
    assert witness.part["ra1"] == "floor"
    assert rig.disk.facts[Fact.EFFECTOR]["ra1"] == "off"
    act(rig, Verb.ABANDON)
    rig.wait(10.0)
    assert cell(rig).state is CellState.IDLE
    assert witness.motions_since(mark, rig.model.robots) == []


@levels
def test_a_held_task_whose_part_was_released_can_only_be_abandoned(stage: Stage, evidence: Evidence) -> None:
    rig, witness = stage(evidence)
    carry(rig)
    act(rig, Verb.HOLD)
    rig.wait(2.0)
    act(rig, Verb.RELEASE)
    rig.wait(0.5)
    for verb in (Verb.RESUME, Verb.RETRY):
        assert "ra1 has no part to go on with: abandon sis_a" in str(rig.operate(verb, "sis_a"))
    act(rig, Verb.ABANDON)
    rig.wait(30.0, until=lambda: rig.plant.at_rest)
    (change,) = rig.outcomes().values()
    assert (change.state, change.reason) == (TaskState.FAILED, Reason.PART_LOST)
    assert str(change.sentence) == "ra1 let go of its part on the operator's word"
    assert witness.part["ra1"] == "floor" and witness.false_successes == []


def test_a_held_task_that_holds_no_part_goes_on_after_a_release(stage: Stage) -> None:
    rig, witness = stage()
    fetch(rig)
    act(rig, Verb.HOLD)
    rig.wait(2.0)
    act(rig, Verb.RELEASE, Verb.RESUME)
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    (change,) = rig.outcomes().values()
    assert change.state is TaskState.DONE and witness.illegal == []


@levels
def test_a_stop_does_not_hide_that_an_arm_to_be_released_is_not_homed(
    stage: Stage, evidence: Evidence
) -> None:
    rig, _ = stage(evidence)
    rig.crash("ra_1")
    rig.wait(1.0)
    act(rig, Verb.STOP)
    assert ("ra1 is not homed" in str(rig.operate(Verb.RELEASE, "ra1"))) is (evidence is not Evidence.STATE)


def test_release_of_a_mobile_is_refused(stage: Stage) -> None:
    rig, _ = stage()
    assert "has no effector" in str(rig.operate(Verb.RELEASE, "rm_sis_a"))


def test_a_rebooted_arm_is_homed_by_the_verb(stage: Stage) -> None:
    rig, witness = stage()
    rig.crash("ra_1")
    rig.wait(1.0)
    rig.submit(TASK)
    assert str(reasons.of_waiting(cell(rig))) == "ra1 is not homed"
    mark = len(rig.to_boards)
    rig.wait(20.0)
    assert witness.motions_since(mark, rig.model.robots) == [], "the position is unknown"
    act(rig, Verb.HOME, scope="ra1")
    rig.wait(60.0, until=lambda: rig.plant.at_rest and not cell(rig).queue)
    assert [change.state for change in rig.outcomes().values()] == [TaskState.DONE]


def test_a_robot_that_says_itself_whether_it_is_homed_is_not_homed_by_hand(stage: Stage) -> None:
    rig, _ = stage()
    assert "says itself" in str(rig.operate(Verb.HOME, "ra1", by_hand=True))


@pytest.mark.parametrize("verb", [each for each in Verb if each is not Verb.CANCEL])
def test_only_cancel_can_mean_a_task(stage: Stage, verb: Verb) -> None:
    rig, _ = stage(Evidence.IDS)
    fetch(rig)
    assert rig.operate(verb, cell(rig).task.id) is not None
    assert cell(rig).task.state is TaskState.RUNNING and cell(rig).task.failure is None


@levels
def test_cancel_of_a_queued_task_leaves_the_running_one(stage: Stage, evidence: Evidence) -> None:
    rig, witness = stage(evidence)
    fetch(rig)
    waits = rig.submit("sis_a 0B 1 #second").task
    assert rig.operate(Verb.CANCEL, waits) is None
    assert rig.outcomes()[waits].state is TaskState.CANCELLED
    assert "ended already" in str(rig.operate(Verb.CANCEL, waits))
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert [change.state for change in rig.outcomes().values()] == [TaskState.DONE, TaskState.CANCELLED]
    assert witness.false_successes == []


@levels
def test_cancel_of_the_running_task_by_its_id_lets_the_next_one_start(
    stage: Stage, evidence: Evidence
) -> None:
    rig, witness = stage(evidence)
    rig.submit("sis_a 0B 7 #first")
    rig.submit("sis_a 0B 1 #second")
    rig.wait_for("sis_a", "move to station 7")
    assert rig.operate(Verb.CANCEL, "#first") is None
    rig.wait(90.0, until=lambda: rig.plant.at_rest and not cell(rig).queue)
    assert [change.state for change in rig.outcomes().values()] == [TaskState.CANCELLED, TaskState.DONE]
    assert (witness.false_successes, witness.illegal) == ([], [])


def test_a_cancel_says_whether_an_operator_or_the_client_asked_for_it(stage: Stage) -> None:
    rig, _ = stage()
    for number in range(4):
        rig.submit(f"sis_a 0B 7 #t{number}")
    for number, client in ((2, False), (3, True), (0, False), (1, True)):  # two that wait, then two that run
        rig.wait_for("sis_a", "move to pick-up")
        rig.tell(OperatorRequest(at=rig.now, verb=Verb.CANCEL, scope=f"t{number}", client=client))
        assert rig.answers[-1].refusal is None
        task = rig.plant.intake.tasks[f"t{number}"]
        assert rig.wait(60.0, until=lambda task=task: task.state is TaskState.CANCELLED)
    said = {task: str(change.sentence) for task, change in rig.outcomes().items()}
    by = ("operator", "client", "operator", "client")
    assert said == {f"t{number}": f"cancelled by the {who}" for number, who in enumerate(by)}
    acts = [str(act.sentence) for act in rig.plant.acts]
    assert acts == ["cancel t2", "cancel t3 by its client", "cancel t0", "cancel t1 by its client"]


@levels
def test_cancel_before_the_command_is_accepted(stage: Stage, evidence: Evidence) -> None:
    rig, witness = stage(evidence)
    rig.lost = faults.nth("ra_1/juntas", 1)
    rig.submit(TASK)
    rig.wait_for("sis_a", "move to pick-up")
    assert rig.operate(Verb.CANCEL, "sis_a") is None
    assert rig.wait(20.0, until=lambda: cell(rig).task is None)
    (change,) = rig.outcomes().values()
    assert (change.state, cell(rig).state) == (TaskState.CANCELLED, CellState.IDLE)
    assert witness.illegal == []


@levels
def test_a_cancel_whose_halt_is_not_confirmed_holds_the_cell(stage: Stage, evidence: Evidence) -> None:
    rig, _ = stage(evidence)
    carry(rig)
    rig.carry = faults.says("ra_1", estado=1)
    assert rig.operate(Verb.CANCEL, "sis_a") is None
    timing = rig.model.timing
    assert rig.wait(timing.stop_timeout_s + 2.0, until=lambda: cell(rig).task is None)
    (change,) = rig.outcomes().values()
    assert (change.state, cell(rig).state) == (TaskState.CANCELLED, CellState.HELD)


@levels
def test_the_queue_is_paused_after_a_stop_until_resume(stage: Stage, evidence: Evidence) -> None:
    rig, _ = stage(evidence)
    fetch(rig)
    rig.submit("sis_a 0B 1")
    act(rig, Verb.STOP, Verb.CLEAR, Verb.RESET)
    rig.wait(10.0)
    assert "paused" in str(reasons.of_waiting(cell(rig))) and len(cell(rig).queue) == 1
    act(rig, Verb.RESUME)
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert [change.state for change in rig.outcomes().values()] == [TaskState.FAILED, TaskState.DONE]
