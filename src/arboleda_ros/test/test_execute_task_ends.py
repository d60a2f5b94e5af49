"""Ends of goals when things go another way; the plant's part is typed by hand."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from action_msgs.msg import GoalInfo, GoalStatus
from action_msgs.srv import CancelGoal
from unique_identifier_msgs.msg import UUID

from arboleda.model.messages import (
    OperatorAnswer,
    OperatorRequest,
    Reason,
    TaskChanged,
    TaskRequest,
    TaskState,
    Verb,
)
from arboleda.plant_file.loader import load

Execute = Callable[..., Any]
SOON_S = 30.0  # what waits for nothing takes no longer, however busy the machine is


class Plant:
    """The plant's port on ROS 2, and somebody who speaks for the plant."""

    def __init__(self, link: Any, client: Any) -> None:
        self.link = link
        self.events: list[Any] = []
        self._client = client
        self._port = link.orchestrator(load(None), self.events.append, time.monotonic)
        link.start()

    def event_of(self, kind: type) -> Any:
        """The next thing that the plant was asked for."""
        event = self._client.until(lambda: self.events, f"no {kind.__name__} came") and self.events.pop(0)
        assert isinstance(event, kind)
        return event

    def says(self, state: TaskState, *, task: str = "t-1", request: str | None = None, **more: Any) -> None:
        change = TaskChanged(task=task, text="sis_a 0B 7", cell="sis_a", state=state, request=request, **more)
        self._port.send(change)

    def takes(self, task: str = "t-1") -> None:
        """Take the task that was asked for into the queue."""
        self.says(TaskState.QUEUED, task=task, request=self.event_of(TaskRequest).request)

    def answers(self, event: OperatorRequest, refusal: str | None = None) -> None:
        self._port.send(
            OperatorAnswer(verb=event.verb, scope=event.scope, refusal=refusal, request=event.request)
        )


@pytest.fixture
def plant(link: Callable[[], Any], client: Any) -> Iterator[Plant]:
    made = Plant(link(), client)
    yield made
    made.link.close()
    feedback = "plant/execute_task/_action/feedback"
    client.until(lambda: not client.node.count_publishers(feedback), "the action is still in the graph")


def status(client: Any, goal: Any, wanted: int) -> None:
    client.until(lambda: goal.handle.status == wanted, f"the goal never came to {wanted}")


def test_a_goal_waits_as_its_task_does_and_executes_once_it_runs(
    plant: Plant, client: Any, execute: Execute
) -> None:
    goal = execute(text="sis_a 0B 7")
    plant.takes()
    status(client, goal, GoalStatus.STATUS_ACCEPTED)
    plant.says(TaskState.RUNNING)
    status(client, goal, GoalStatus.STATUS_EXECUTING)
    plant.says(TaskState.DONE)
    assert goal.end()[0] == GoalStatus.STATUS_SUCCEEDED


def test_a_failed_task_aborts_its_goal_with_reason_and_sentence(plant: Plant, execute: Execute) -> None:
    goal = execute(text="sis_a 0B 7")
    plant.takes()
    plant.says(TaskState.RUNNING)
    plant.says(TaskState.FAILED, reason=Reason.NO_PIECE, sentence="ra1: no piece at pick-up")
    ended, result = goal.end()
    assert ended == GoalStatus.STATUS_ABORTED
    assert (result.outcome, result.reason, result.sentence) == (
        "failed",
        "no_piece",
        "ra1: no piece at pick-up",
    )


def test_a_cancel_before_the_plant_has_answered_is_kept_for_it(plant: Plant, execute: Execute) -> None:
    goal = execute(text="sis_a 0B 7")
    request = plant.event_of(TaskRequest).request
    assert goal.cancel() and plant.events == []
    plant.says(TaskState.QUEUED, request=request)
    event = plant.event_of(OperatorRequest)
    assert (event.verb, event.scope, event.client) == (Verb.CANCEL, "t-1", True)
    plant.says(TaskState.CANCELLED, reason=Reason.CANCELLED, sentence="cancelled by the client")
    ended, result = goal.end()
    assert (ended, result.outcome) == (GoalStatus.STATUS_CANCELED, "cancelled")


def test_a_cancel_of_a_goal_that_is_not_there_asks_the_plant_for_nothing(plant: Plant, client: Any) -> None:
    stranger = GoalInfo(goal_id=UUID(uuid=[7] * 16))
    answer = client.call(CancelGoal, "plant/execute_task/_action/cancel_goal", goal_info=stranger)
    assert answer.return_code == CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID
    assert plant.events == []


def test_a_cancel_that_the_plant_refuses_leaves_the_goal_as_it_is(
    plant: Plant, client: Any, execute: Execute
) -> None:
    goal = execute(text="sis_a 0B 7")
    plant.takes()
    plant.says(TaskState.RUNNING)
    status(client, goal, GoalStatus.STATUS_EXECUTING)
    asking = goal.handle.cancel_goal_async()
    plant.answers(plant.event_of(OperatorRequest), refusal="sis_a is holding; wait until it stands still")
    assert client.answer(asking).goals_canceling == []
    assert goal.handle.status == GoalStatus.STATUS_EXECUTING
    plant.says(TaskState.DONE)
    assert goal.end()[1].outcome == "done"


def test_a_task_that_fails_while_it_is_cancelled_is_aborted(
    plant: Plant, client: Any, execute: Execute
) -> None:
    goal = execute(text="sis_a 0B 7")
    plant.takes()
    plant.says(TaskState.RUNNING)
    asking = goal.handle.cancel_goal_async()
    plant.answers(plant.event_of(OperatorRequest))
    assert client.answer(asking).goals_canceling
    plant.says(TaskState.FAILED, reason=Reason.STOPPED, sentence="sis_a was stopped by the operator")
    ended, result = goal.end()
    assert (ended, result.outcome, result.reason) == (GoalStatus.STATUS_ABORTED, "failed", "stopped")


def test_goals_that_are_open_when_the_plant_ends_are_aborted(
    plant: Plant, client: Any, execute: Execute
) -> None:
    goals = [execute(text=f"sis_a 0B {station}") for station in (1, 2, 3)]
    plant.takes("t-1")
    plant.takes("t-2")
    plant.says(TaskState.RUNNING, task="t-1")
    status(client, goals[0], GoalStatus.STATUS_EXECUTING)
    began = time.monotonic()
    plant.link.close()
    assert time.monotonic() - began < SOON_S, "it waits for no goal"
    for goal in goals:
        ended, result = goal.end()
        assert (ended, result.outcome, result.reason) == (GoalStatus.STATUS_ABORTED, "failed", "interrupted")
        assert result.sentence == "the plant has ended before this task did"


def test_a_plant_that_is_stopped_ends_what_runs_and_what_waits(
    start: Callable[[], Any], execute: Execute
) -> None:
    plant = start()
    running, waiting = execute(text="sis_a 0B 7"), execute(text="sis_a 0A 1")
    running.executing()
    plant.stop()
    assert running.end()[1].sentence == "the plant has ended before this task did"
    assert waiting.end()[1].sentence == "the plant has ended before this task did"
    assert {goal.end()[0] for goal in (running, waiting)} == {GoalStatus.STATUS_ABORTED}
