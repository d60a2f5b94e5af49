"""Action `plant/execute_task`: a goal follows its task to the end."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from arboleda_interfaces.action import ExecuteTask
from rclpy.action import CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node

from arboleda.model.messages import Reason, TaskChanged, TaskState
from arboleda.model.sentence import as_sentence
from arboleda_ros.plant_queries import Asker

from . import values
from .goals import Goal, GoalServer

LOG = logging.getLogger("arboleda.ros")
_OPEN = (TaskState.QUEUED, TaskState.RUNNING)


class ExecuteTaskAction:
    """Goals are told what the plant says of their tasks; nothing waits, nothing polls.

    Goals live on the executor's thread: `changed` and `show`, which the plant's thread calls, and `close`
    leave their news there. A goal whose client is gone goes on as its task does.
    """

    def __init__(self, node: Node, asker: Asker) -> None:
        self._node = node
        self._asker = asker
        self._goals: dict[str, Goal] = {}
        self._news: deque[Callable[[], None]] = deque()
        self._closed = False
        self._server = GoalServer(
            node,
            ExecuteTask,
            "plant/execute_task",
            _without_callback,
            goal_callback=lambda _request: GoalResponse.REJECT if self._closed else GoalResponse.ACCEPT,
            handle_accepted_callback=self._accepted,
            cancel_callback=self._cancel,
        )

    def changed(self, change: TaskChanged) -> None:
        """Take a change of a task."""
        if self._goals:
            self._tell(partial(self._follow, change))

    def show(self, view: Mapping[str, Any]) -> None:
        """Send feedback on the goals whose tasks the cells do now."""
        if self._goals:
            busy = [cell for cell in view["cells"] if cell["task"]]
            doing = {cell["task"]["id"]: (cell["step"], cell["progress"]) for cell in busy}
            self._tell(partial(self._feed_back, doing))

    def close(self) -> None:
        """End with the plant: new goals are refused, and open ones are aborted."""
        self._closed = True
        self._tell(self._give_up)

    def destroy(self) -> None:
        """Remove the action from the graph, where rclpy leaves it when its node is destroyed."""
        self._server.destroy()

    def _tell(self, news: Callable[[], None]) -> None:
        self._news.append(news)
        executor = self._node.executor
        if executor is not None:
            executor.create_task(self._hear)

    def _hear(self) -> None:
        while self._news:  # in order, which an executor does not promise for its tasks
            self._news.popleft()()

    def _accepted(self, handle: ServerGoalHandle) -> None:
        """Submit the task of a goal; a refusal becomes its result, as a rejected goal carries no sentence."""
        token = _token(handle)
        self._goals[token] = Goal(handle=handle)
        self._asker.submit_later(values.text_of(handle.request), token)

    def _cancel(self, handle: ServerGoalHandle) -> CancelResponse:
        goal = self._goals.get(_token(handle))
        if goal is None:
            return CancelResponse.REJECT
        if goal.task is None:
            goal.cancelling = True
            return CancelResponse.ACCEPT
        refusal = self._asker.cancellation_refusal(goal.task)
        if refusal is not None:
            LOG.info("a client's cancel of #%s was refused: %s", goal.task, refusal)
        return CancelResponse.ACCEPT if refusal is None else CancelResponse.REJECT

    def _follow(self, change: TaskChanged) -> None:
        goal = self._goals.get(change.request or "")
        if goal is not None:
            goal.task = change.task
        for token, goal in list(self._goals.items()):
            if goal.task == change.task:
                self._advance(token, goal, change)

    def _advance(self, token: str, goal: Goal, change: TaskChanged) -> None:
        if change.state not in _OPEN:
            self._end(token, change)
            return
        if change.state is TaskState.RUNNING:
            goal.begin()
        if goal.cancelling:
            goal.cancelling = False
            self._asker.cancel_later(change.task)

    def _feed_back(self, doing: Mapping[str, tuple[str | None, float | None]]) -> None:
        for goal in self._goals.values():
            if goal.task is not None and goal.task in doing:
                goal.feed_back(*doing[goal.task])

    def _end(self, token: str, change: TaskChanged) -> None:
        self._server.end(self._goals.pop(token), change)

    def _give_up(self) -> None:
        for token, goal in list(self._goals.items()):
            self._end(
                token,
                TaskChanged(
                    task=goal.task or "",
                    text=values.text_of(goal.handle.request),
                    cell=None,
                    state=TaskState.FAILED,
                    reason=Reason.INTERRUPTED,
                    sentence=as_sentence("the plant has ended before this task did"),
                ),
            )


def _without_callback(_handle: ServerGoalHandle) -> ExecuteTask.Result:
    raise AssertionError("goals are ended by what the plant says of their tasks")


def _token(handle: ServerGoalHandle) -> str:
    return bytes(handle.goal_id.uuid).hex()
