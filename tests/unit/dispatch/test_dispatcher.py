"""What a dispatcher sends, and what it refuses to send."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import pytest

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.ledger import State
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Home, Stop, StopMode, Switch
from arboleda.model.messages import MotionState, Reason, Report
from arboleda.model.plant_model import DriverUse, Evidence
from arboleda.testing import shipped

EPOCH = 7


STILL = {"robot": "ra1", "state": MotionState.STOPPED, "q": (0.0, 0.0, 0.0), "homed": True}


@pytest.fixture
def dispatcher() -> Dispatcher:
    """An arm that stands still, as it said twice."""
    dispatcher = Dispatcher(shipped("sis_a"), EPOCH, {})
    for at in (99.9, 100.0):
        dispatcher.report(Report(at=at, **STILL), at)
    return dispatcher


@pytest.fixture
def latched(dispatcher: Dispatcher) -> Dispatcher:
    """The same, stopped by an operator."""
    dispatcher.latches.latch("ra1")
    return dispatcher


def test_a_halt_is_proven_only_by_what_is_said_after_it(dispatcher: Dispatcher) -> None:
    move = dispatcher.send(partial(MoveJoints, robot="ra1", q=(0.5, 0.0, 0.0)), "sis_a", "moving", 100.1)
    dispatcher.cancel(move, 100.2)
    states = []
    for at in (100.3, 100.4):
        dispatcher.report(Report(at=at, **STILL), at)
        states.append(move.state)
    assert states == [State.CANCELLING, State.CANCELLED]


@pytest.mark.parametrize(
    ("make", "settles"),
    [(partial(SetEffector, on=True), False), (Switch, True)],
    ids=["of a fact that is told", "of none"],
)
def test_at_joints_a_switch_of_a_fact_that_is_told_does_not_settle(make: type, *, settles: bool) -> None:
    dispatcher = Dispatcher(shipped("sis_a", evidence=Evidence.JOINTS), EPOCH, {})
    dispatcher.report(Report(at=100.0, **STILL, effector=False), 100.0)
    entry = dispatcher.send(partial(make, robot="ra1"), "sis_a", "switching", 100.1)
    dispatcher.expire(102.0, 102.0)
    assert (entry.state is State.DONE) is settles


@pytest.mark.parametrize("failed", [False, True])
def test_after_a_failed_one_a_switch_is_done_once_its_board_names_it(
    dispatcher: Dispatcher, *, failed: bool
) -> None:
    switch = partial(SetEffector, robot="ra1", on=True)
    if failed:
        dispatcher.send(switch, "sis_a", "switching", 100.1)
        dispatcher.expire(110.0, 110.0)
    dispatcher.report(Report(at=110.0, **STILL), 110.0)
    entry = dispatcher.send(switch, "sis_a", "switching", 110.1)
    states = []
    for number, accepted in ((5, None), (6, entry.command.id), (7, None)):
        said = Report(at=110.0 + number / 10, **STILL, effector=True, number=number, accepted=accepted)
        dispatcher.report(said, said.at)
        states.append(entry.state is State.DONE)
    assert states == [not failed, True, True]


@pytest.mark.parametrize("late_s", [1.0, 20.0])  # the second is past the deadline
def test_what_left_late_settles_from_when_it_left(late_s: float) -> None:
    dispatcher = Dispatcher(shipped("sis_a", evidence=Evidence.JOINTS), EPOCH, {})
    dispatcher.report(Report(at=100.0, **STILL, effector=False), 100.0)
    entry = dispatcher.send(partial(Switch, robot="ra1"), "sis_a", "switching", 100.1)
    dispatcher.left_late(entry.command.id, late_s)
    dispatcher.report(Report(at=100.1 + late_s, **STILL, effector=False), 100.1 + late_s)
    states = []
    for at in (100.25 + late_s, 100.35 + late_s):
        dispatcher.expire(at, at)
        states.append(entry.state)
    assert states == [State.SENT, State.DONE]


def test_a_robot_that_is_back_is_stopped_once_and_not_by_a_word_of_only_where_it_stands(
    latched: Dispatcher,
) -> None:
    latched.report(Report(at=100.1, robot="ra1", state=MotionState.NO_LINK), 100.1)
    latched.outbox.clear()
    for at in (100.2, 100.3):
        latched.report(Report(at=at, robot="ra1", q=(0.0, 0.0, 0.0)), at)
    assert latched.outbox == []
    for at in (100.4, 100.5):
        latched.report(Report(at=at, **STILL), at)
    assert [type(message) for message in latched.outbox] == [Stop]


@pytest.mark.parametrize("make", [partial(SetEffector, on=True), Home], ids=["effector", "home"])
def test_a_stopped_robot_is_sent_nothing_by_a_task(latched: Dispatcher, make: type) -> None:
    entry = latched.send(partial(make, robot="ra1"), "sis_a", "doing", 100.1)
    assert entry.state is State.FAILED and entry.failure and entry.failure.reason is Reason.STOPPED


@pytest.mark.parametrize(("said", "stopped"), [({}, True), ({"epoch": 1}, True), ({"epoch": 2}, False)])
def test_what_a_bridge_refused_for_a_stop_is_stopped_until_another_start_of_the_bridge(
    said: dict[str, int], stopped: bool
) -> None:
    model = shipped("sis_a", evidence=Evidence.IDS)
    (cell,) = (each.with_robots(partial(replace, has_stop=False)) for each in model.cells)
    dispatcher = Dispatcher(replace(model, cells=(cell,)), EPOCH, {})
    stands = partial(Report, robot="rm_sis_a", state=MotionState.STOPPED, node=0, boot_id=3)
    dispatcher.report(stands(at=100.0, epoch=1, plant=EPOCH), 100.0)
    drive = dispatcher.send(partial(FollowPath, robot="rm_sis_a", nodes=(0, 1)), "sis_a", "driving", 100.1)
    refused = stands(at=100.2, epoch=1, plant=EPOCH, rejected=drive.command.id, refusal="paro")
    dispatcher.report(refused, 100.2)
    assert drive.failure is not None and drive.failure.reason is Reason.STOPPED
    dispatcher.report(stands(at=100.3, **said), 100.3)
    assert dispatcher.beliefs["rm_sis_a"].barred is stopped


@pytest.mark.parametrize(
    ("state", "stopped"), [(MotionState.STOPPED, True), (MotionState.STOP_LATCHED, False)]
)
def test_a_refusal_for_a_stop_counts_as_the_report_of_it_that_is_missing_until_the_stop_is_cleared(
    dispatcher: Dispatcher, state: MotionState, stopped: bool
) -> None:
    move = partial(MoveJoints, robot="ra1", q=(0.5, 0.0, 0.0))
    entry = dispatcher.send(move, "sis_a", "moving", 100.1)
    refused = {**STILL, "state": state, "rejected": entry.command.id, "refusal": "paro"}
    dispatcher.report(Report(at=100.2, **refused), 100.2)
    dispatcher.report(Report(at=100.3, **STILL), 100.3)
    again = dispatcher.send(move, "sis_a", "moving", 100.4)
    assert (again.failure is not None and again.failure.reason is Reason.STOPPED) is stopped
    dispatcher.latches.unlatch("ra1")
    assert dispatcher.beliefs["ra1"].obstacle(was=False) is None


def test_a_stopped_robot_lets_its_part_go_by_hand(latched: Dispatcher) -> None:
    let_go = partial(SetEffector, robot="ra1", on=False)
    assert latched.send(let_go, "sis_a", "doing", 100.1, by_hand=True).failure is None


def test_a_robot_that_moves_takes_no_second_motion_and_opens_nothing(dispatcher: Dispatcher) -> None:
    move = partial(MoveJoints, robot="ra1", q=(0.5, 0.0, 0.0))
    dispatcher.send(move, "sis_a", "moving", 100.1)
    second = dispatcher.send(move, "sis_a", "moving", 100.2)
    failures = [second.failure, dispatcher.obstacles.to_opening("ra1")]
    assert [failure and str(failure.sentence) for failure in failures] == [
        "ra1 had an open motion command: no moving",
        "ra1 has an open motion command",
    ]


@pytest.mark.parametrize("lost", [{"state": MotionState.NO_LINK}, {"state": MotionState.NOT_HOMED}], ids=str)
def test_where_a_robot_is_is_known_while_it_is_heard_and_homed(
    dispatcher: Dispatcher, lost: dict[str, MotionState]
) -> None:
    belief = dispatcher.beliefs["ra1"]
    assert belief.known_q == belief.known_position == STILL["q"]
    dispatcher.report(Report(at=100.1, robot="ra1", **lost), 100.1)
    assert belief.known_q is None and belief.known_position is None


def test_a_command_names_the_last_telemetry_of_its_robot_that_was_heard_and_a_stop_does_not(
    dispatcher: Dispatcher,
) -> None:
    for at, number in ((100.1, 41), (100.2, 42)):  # the second only repeats the first
        dispatcher.report(Report(at=at, **STILL, number=number), at)
    dispatcher.send(partial(MoveJoints, robot="ra1", q=(0.5, 0.0, 0.0)), "sis_a", "moving", 100.3)
    dispatcher.latches.latch("ra1")
    sent = [each for each in dispatcher.outbox if isinstance(each, MoveJoints | Stop)]
    assert [(type(each), each.heard) for each in sent] == [(MoveJoints, 42), (Stop, None)]


@pytest.mark.parametrize("moving", [False, True])
def test_a_command_that_the_plant_never_gave_is_told_and_halted_and_the_next_number_is_above_it(
    dispatcher: Dispatcher, *, moving: bool
) -> None:
    go = partial(MoveJoints, robot="ra1", q=(0.5, 0.0, 0.0))
    move = dispatcher.send(go, "sis_a", "moving", 100.1) if moving else None
    dispatcher.outbox.clear()
    told = replace(Report(at=100.2, **STILL), state=MotionState.MOVING, accepted=f"{EPOCH}-9999")
    for at in (100.2, 100.3):
        dispatcher.report(replace(told, at=at), at)
    assert dispatcher.outbox == [Stop(id=f"{EPOCH}-10000", robot="ra1", mode=StopMode.HALT)]
    (noticed,) = dispatcher.interference.noticed
    assert f"took command {EPOCH}-9999, which this plant never gave" in str(noticed.sentence)
    assert move is None or move.interference == noticed.sentence


@pytest.mark.parametrize("pace", [1.0, 0.05])
def test_a_move_has_the_time_that_its_pace_takes(pace: float) -> None:
    """A driver told to move at five percent takes twenty times as long."""
    model = shipped("sis_a")
    slow = DriverUse(name="slow", make=object, pace=pace)
    cells = tuple(cell.with_robots(lambda robot: replace(robot, driver=slow)) for cell in model.cells)
    dispatcher = Dispatcher(replace(model, cells=cells), EPOCH, {})
    for at in (99.9, 100.0):
        dispatcher.report(Report(at=at, **STILL), at)
    arm, goal = dispatcher.model.robots["ra1"], (math.radians(150), 0.0, 0.0)
    move = dispatcher.send(partial(MoveJoints, robot="ra1", q=goal), "sis_a", "moving", 100.0)
    takes_s = arm.motion.travel_s((0.0, 0.0, 0.0), (goal,)) / pace
    timing = dispatcher.model.timing
    allowed_s = max(arm.timeout_s, takes_s * timing.deadline_factor + timing.deadline_floor_s)
    assert move.deadline == pytest.approx(100.0 + allowed_s)
