"""Record of a world, by what was said and done in it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.dispatch.ledger import State
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Stop, StopMode
from arboleda.model.messages import MotionState, Report, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig.world import BRIDGE, PLANT, World
from arboleda.testing.plants import shipped
from arboleda.wire.hop import FromPlant
from arboleda.wire.transport import Publication
from arboleda_proofs.simulator.record import Record
from arboleda_proofs.simulator.recorded.robots import KnownRobot, Obstacle, StopProgress
from arboleda_proofs.simulator.recorded.scopes import Scopes
from arboleda_proofs.simulator.recorded.tasks import KEPT, Tasks

TASK = "sis_a 0B 7"
STALE_S = 1.5


@pytest.fixture
def world() -> World:
    return World(shipped("sis_a"))


@pytest.fixture
def record(world) -> Record:
    record = Record(world)
    world.watchers.append(record.look)
    world.advance(0.5)
    return record


def robot(evidence: Evidence = Evidence.IDS) -> KnownRobot:
    return KnownRobot(shipped("sis_a", evidence=evidence).robots["ra1"], STALE_S)


def said(**words) -> Report:
    return Report(
        **{"at": 10.0, "robot": "ra1", "epoch": 1, "plant": 5, "boot_id": 3, "homed": True, **words}
    )


def verb(world: World, verb: Verb, scope: str = "sis_a", wait_s: float = 1.0) -> None:
    world.request_verb(verb, scope)
    world.advance(wait_s)


# Robots, by what they say.


def test_a_robot_that_was_never_heard_is_offline():
    assert robot().obstacles(10.0, 5) == {Obstacle.OFFLINE}
    assert robot(Evidence.STATE).obstacles(10.0, 5) == frozenset()


@pytest.mark.parametrize(
    ("words", "obstacles"),
    [
        ({"state": MotionState.STOPPED}, set()),
        ({"state": MotionState.MOVING}, set()),
        ({"state": MotionState.NO_LINK}, {Obstacle.OFFLINE}),
        ({"state": MotionState.FAULT}, {Obstacle.FAULTED}),
        ({"state": MotionState.STOP_LATCHED}, {Obstacle.LATCHED}),
        ({"state": MotionState.NOT_HOMED}, {Obstacle.UNHOMED}),
        ({"state": MotionState.FAULT, "homed": False}, {Obstacle.FAULTED, Obstacle.UNHOMED}),
        ({"state": MotionState.STOPPED, "plant": 4}, {Obstacle.UNANSWERED}),
    ],
)
def test_what_a_robot_says_speaks_against_a_command(words, obstacles):
    known = robot()
    known.hear(said(**words))
    assert known.obstacles(10.5, 5) == obstacles


def test_silence_makes_offline_where_it_means_something():
    for evidence, obstacles in ((Evidence.IDS, {Obstacle.OFFLINE}), (Evidence.STATE, set())):
        known = robot(evidence)
        known.hear(said(state=MotionState.STOPPED))
        assert known.obstacles(10.0 + STALE_S - 0.001, 5) == frozenset()
        assert known.obstacles(10.0 + STALE_S, 5) == obstacles


def test_another_boot_of_a_robot_that_cannot_report_homing_makes_it_unhomed():
    known = robot(Evidence.JOINTS)
    known.hear(said(homed=None, state=MotionState.STOPPED))
    known.hear(said(homed=None, epoch=2, boot_id=0))
    assert known.obstacles(10.0, 5) == frozenset()
    known.hear(said(homed=None, epoch=2, boot_id=1))
    assert known.obstacles(10.0, 5) == {Obstacle.UNHOMED}


def test_reports_tell_position_and_link_of_each_robot(world, record):
    known = record.robots["rm_sis_a"]
    assert (known.q, known.node, known.homed, known.state) == (None, 0, True, MotionState.STOPPED)
    world.power_off("rm_sis_a")
    world.advance(0.1)
    assert record.robots["rm_sis_a"].offline(world.now)
    assert not record.robots["ra1"].offline(world.now)


def test_a_new_plant_has_heard_nothing(world, record):
    world.to_plant.troubles.append(lambda report: [])
    world.crash(PLANT)
    world.advance(0.01)
    assert record.robots["ra1"].heard_at is None
    assert record.robots["ra1"].q is None


# Stops, by what operators were answered.


def test_a_stop_lasts_until_clear_and_reset_and_outlives_the_plant(world, record):
    stops = []
    for act in (Verb.STOP, None, Verb.CLEAR, None, Verb.RESET):
        if act is None:
            world.crash(PLANT)
            world.advance(1.0)
        else:
            verb(world, act)
        stops.append((record.robots["ra1"].stop, record.cells["sis_a"].stopped))
    latched, cleared = (StopProgress.LATCHED, True), (StopProgress.CLEARED, True)
    assert stops == [latched, latched, cleared, cleared, (None, False)]


def test_what_was_refused_changes_nothing(world, record):
    verb(world, Verb.STOP, "sis_x")
    verb(world, Verb.RESET)
    assert record.robots["ra1"].stop is None
    assert not record.cells["sis_a"].stopped
    assert [answer.verb for answer in record.operator_requests.answers] == []


def test_the_stop_of_one_robot_stops_its_cell(world, record):
    verb(world, Verb.STOP, "ra1")
    assert record.robots["ra1"].stop is StopProgress.LATCHED
    assert record.robots["rm_sis_a"].stop is None
    assert record.cells["sis_a"].stopped


# Commands.


def test_a_command_is_followed_from_sent_to_its_end(world, record):
    world.request_task(TASK)
    world.advance(0.5)
    (sent,) = record.commands.open.values()
    assert (sent.robot, type(sent.command), sent.state) == ("rm_sis_a", FollowPath, State.RUNNING)
    assert sent.at < world.now < sent.deadline == record.commands.soonest
    assert sent.obstacles == frozenset()
    world.advance(20)
    assert sent.state is State.DONE
    assert record.commands.open == {}


def test_a_cancelled_command_had_its_halt(world, record):
    world.request_task(TASK)
    world.advance(1)
    (sent,) = record.commands.open.values()
    halts = record.robots["rm_sis_a"].halts
    verb(world, Verb.CANCEL, wait_s=0.01)
    assert sent.state is State.CANCELLING
    assert sent.cancelled_at is not None
    assert record.robots["rm_sis_a"].halts == halts + 1 > sent.halts


def test_a_rejected_command_is_known_as_such(world, record):
    world.advance(0.03)  # the start dwell ends between two telemetry messages
    world.request_task(TASK)
    world.advance(0.19)
    world.boards["rm_sis_a"].latched = True
    sent = {}
    world.watchers.append(lambda: sent.update({each.command.id: each for each in record.commands.new}))
    world.advance(0.02)
    first = next(iter(sent.values()))
    assert (type(first.command), first.rejected) == (FollowPath, True)


def test_goals_outlive_their_commands_and_the_plant(world, record):
    world.request_task(TASK)
    world.advance(20)
    world.crash(PLANT)
    world.advance(1)
    goals = record.commands.goals["ra1"]
    assert [type(goal) for goal in goals] == [MoveJoints] * 3


# Tasks.


def test_a_task_is_followed_from_its_queue_to_its_end(world, record):
    world.request_task(f"{TASK} #one")
    world.request_task(f"{TASK} #two")
    world.advance(0.1)
    assert record.tasks.running == {"sis_a": "one"}
    assert list(record.tasks.queues["sis_a"]) == ["two"]
    world.advance(40)
    assert record.tasks.open == {}
    assert [(task.id, task.state) for task in record.tasks.ended.values()] == [
        ("one", TaskState.DONE),
        ("two", TaskState.DONE),
    ]


def test_who_asks_twice_gets_an_answer_that_is_no_change(world, record):
    changes = []
    world.watchers.append(lambda: changes.extend(record.tasks.changes if record.step.stepped else ()))
    for _ in range(2):
        world.request_task(f"{TASK} #one")
        world.advance(0.01)
    told = [(change.message.state, change.answer) for change in changes]
    assert told[:2] == [(TaskState.QUEUED, False), (TaskState.RUNNING, False)]
    assert (TaskState.RUNNING, True) in told


def change(id: str, state: TaskState, request: str | None = None) -> TaskChanged:
    return TaskChanged(task=id, text=TASK, cell="sis_a", state=state, request=request)


def test_ended_tasks_are_forgotten_in_the_end():
    tasks = Tasks(["sis_a"])
    for number in range(KEPT + 5):
        for state in (TaskState.QUEUED, TaskState.RUNNING, TaskState.DONE):
            tasks.take(change(f"t{number}", state), 0.0, is_repeated=False)
    assert len(tasks.ended) == KEPT
    assert tasks.known("t4") is None
    assert tasks.known(f"t{KEPT}").state is TaskState.DONE


def test_a_plant_that_crashed_has_no_cell_whose_tasks_wait(world, record):
    world.crash("ra_1")
    world.advance(0.5)
    world.request_task(TASK)
    world.advance(0.5)
    assert record.states.idle == [record.cells["sis_a"]]
    world.crash(PLANT)
    world.advance(0.5)
    assert record.states.idle == []


def test_a_plant_that_crashed_has_its_task_at_work_and_none_of_its_commands(world, record):
    world.request_task(TASK)
    world.advance(1)
    world.crash(PLANT)
    world.advance(0.1)
    assert [*record.tasks.running] == ["sis_a"]
    assert record.commands.open == {}


# Cells, trees and refusals.


def test_cells_are_followed_by_their_states(world, record):
    seen = []
    world.watchers.append(lambda: seen.extend(record.states.transitions if record.step.stepped else ()))
    world.request_task(TASK)
    world.advance(1)
    verb(world, Verb.HOLD)
    verb(world, Verb.RESUME)
    states = [after for _, _, after in dict.fromkeys(seen)]
    assert states == [CellState.EXECUTE, CellState.HOLDING, CellState.HELD, CellState.EXECUTE][: len(states)]
    assert record.cells["sis_a"].again == 1


def test_the_commands_of_each_step_of_a_tree_are_counted(world, record):
    world.request_task(TASK)
    world.advance(1)
    verb(world, Verb.HOLD)
    verb(world, Verb.RESUME, wait_s=0.1)
    assert [(leaf.name, count) for (leaf, _), count in record.cells["sis_a"].sends.items()] == [
        ("drive path 0B", 2)
    ]


@pytest.mark.parametrize(
    ("text", "changes"),
    [("nonsense", False), (f"{TASK} #one", False), ("sis_a 0B 6 #one", False), ("sis_a 0B 6", True)],
)
def test_a_step_that_only_refuses_is_compared_with_the_one_before(world, record, text, changes):
    world.request_task(f"{TASK} #one")
    world.advance(0.03)
    differences = []
    world.watchers.append(lambda: differences.extend(record.differences))
    queued = len(record.tasks.open)
    world.request_task(text)
    world.advance(0.01)
    assert differences == []
    assert (len(record.tasks.open) > queued) is changes


def test_a_refusal_that_changes_something_is_found_out(world, record):
    differences = []
    world.watchers.append(lambda: differences.extend(record.differences))
    world.advance(0.03)
    cell = world.plant.cells["sis_a"]
    cell.queue.paused = True
    world.request_task("nonsense")
    world.advance(0.01)
    assert differences == ["the queue of sis_a changed"]


# Boards.


def test_what_a_board_carries_out_is_compared_with_what_reached_it(world, record):
    executed = []
    world.watchers.append(lambda: executed.extend(record.boards.executed if world.moment.executed else ()))
    world.request_task(TASK)
    world.advance(20)
    numbers = [(before, (goal.epoch, goal.seq)) for board, goal, before, *_ in executed if board == "ra_1"]
    assert [before for before, _ in numbers] == [None, *(now for _, now in numbers[:-1])]
    assert all(each.delivered for each in executed)
    assert record.boards.by_name["ra_1"].inbox == []


def test_a_retained_command_does_not_count_as_delivered(world, record):
    board = record.boards.by_name["ra_1"]
    payload = b'{"efector":1,"seq":9,"epoca":2000}'
    world.publish(Publication(topic="ra_1/efector", payload=payload, retain=True))
    world.stall("ra_1", 1.0)
    world.crash("ra_1")
    world.advance(0.5)
    assert [delivery.retain for delivery in board.inbox] == [True]
    world.advance(1.0)
    assert board.inbox == []


def test_positions_are_those_that_boards_told_lately(world, record):
    board = record.boards.by_name["rm_sis_a"]
    world.request_task(TASK)
    world.advance(2.5)
    told = record.robots["rm_sis_a"].node
    assert told not in (0, 8)
    assert board.has_reported(None, told, record.lateness.reports_from_s(world.now))
    assert not board.has_reported(None, 8, 0.0)
    assert board.has_reported(None, 0, 0.0)
    world.advance(10)
    assert not board.has_reported(None, 0, record.lateness.reports_from_s(world.now))


def test_a_slow_line_may_bring_old_positions(world, record):
    assert record.lateness.reports_from_s(world.now) == world.now - STALE_S
    world.to_plant.troubles.append(lambda report: [0.5])
    world.advance(0.5)
    world.to_plant.troubles.clear()
    world.advance(5.0)
    assert record.lateness.reports_from_s(world.now) == 0.0
    world.advance(6.0)
    assert record.lateness.reports_from_s(world.now) == world.now - STALE_S


def test_a_stalled_bridge_may_bring_old_positions(world, record):
    world.stall(BRIDGE, 1.0)
    world.advance(0.9)
    assert record.lateness.reports_from_s(world.now) == 0.0


def test_scopes_are_the_plant_a_cell_or_a_robot():
    scopes = Scopes(shipped())
    assert scopes.robots(" RA1 ") == ("ra1",)
    assert scopes.robots("sis_b") == ("ra2", "rm_sis_b")
    assert len(scopes.robots("")) == len(scopes.robots("plant")) == 6
    assert scopes.robots("t-1000-1") == ()
    assert scopes.cells("ra3") == ("sis_c",)
    assert scopes.cells("") == ("sis_a", "sis_b", "sis_c")


def test_what_was_said_before_the_record_began_is_known(world):
    world.advance(1)
    record = Record(world)
    known = record.robots["ra1"]
    assert known.obstacles(world.now, world.plant.epoch) == frozenset()
    assert record.boards.by_name["ra_1"].has_reported(
        known.q, None, record.lateness.reports_from_s(world.now)
    )
    assert replace(said(), robot="ra1").robot == known.robot.name


@pytest.mark.parametrize("refused_after_s", [0.01, 0.6])
def test_a_refusal_that_is_heard_after_the_end_of_a_halted_move_is_not_held_against_a_robot(refused_after_s):
    world = World(shipped("sis_a", evidence=Evidence.STATE, has_stop=False))
    record = Record(world)
    world.watchers.append(record.look)
    stop = Stop(id="", robot="rm_sis_a", mode=StopMode.LATCH)
    world.broker.clients[BRIDGE].inbox.append(FromPlant(at=world.now, message=stop, sender="/stranger"))
    world.advance(0.5)
    world.to_bridge.troubles.append(lambda each: (refused_after_s,))
    world.request_task(TASK)
    assert world.advance(5.0, until=lambda: any(each.robot == "rm_sis_a" for each in record.commands.new))
    world.stall(PLANT, 3.0)
    world.advance(3.5)
    assert record.robots["rm_sis_a"].barred is world.plant.dispatcher.beliefs["rm_sis_a"].barred
    assert record.robots["rm_sis_a"].barred is (refused_after_s < 0.1)


@pytest.mark.parametrize("by_hand", [(False, True), (True, False), (True,)])
@pytest.mark.parametrize("boots_again", [False, True])
def test_whom_an_operator_put_right_is_known_by_the_request_that_was_granted(by_hand, boots_again):
    world = World(shipped("sis_a", assume_homed=True))
    record = Record(world)
    world.watchers.append(record.look)
    world.advance(1.0)
    world.crash("ra_1")
    world.advance(0.5)
    assert record.robots["ra1"].displaced
    world.stall(PLANT, 1.0)
    for each in by_hand:
        world.request_verb(Verb.HOME, "ra1", by_hand=each)
    if boots_again:
        world.crash("ra_1")
    world.advance(1.01)
    assert record.robots["ra1"].displaced is world.plant.dispatcher.beliefs["ra1"].displaced
    assert record.robots["ra1"].displaced is boots_again, "the routine, too, ends at once where it stands"


def test_a_value_is_new_until_it_was_asked_for(record):
    asked = [record.checked.is_new("status", value) for value in (None, 1, 1, 2, 1)]
    assert asked == [True, True, False, True, True]
    assert record.checked.is_new("another thing", 1)
