"""Goal of `plant/execute_task`, and a server that leaves the work to the plant."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

from action_msgs.msg import GoalStatus
from arboleda_interfaces.action import ExecuteTask
from rclpy.action import ActionServer
from rclpy.action.server import ServerGoalHandle

from arboleda.model.messages import TaskChanged, TaskState


@dataclass(kw_only=True)
class Goal:
    """Goal that has not ended; `task` is None until the plant has answered."""

    handle: ServerGoalHandle
    task: str | None = None
    cancelling: bool = False  # asked for before there was a task to cancel
    step: str = ""
    progress: float = 0.0

    def begin(self) -> None:
        """Note that its task runs; a second call does nothing."""
        if self.handle.status == GoalStatus.STATUS_ACCEPTED:
            self.handle.execute()

    def feed_back(self, step: str | None, progress: float | None) -> None:
        """Send news to the client; without a progress the last one stays."""
        feedback = (str(step or ""), self.progress if progress is None else progress)
        if feedback != (self.step, self.progress):
            self.step, self.progress = feedback
            self.handle.publish_feedback(ExecuteTask.Feedback(step=self.step, progress=self.progress))


class GoalServer(ActionServer):
    """Action server whose goals are executed elsewhere; `execute()` itself only marks a goal as executing."""

    def end(self, goal: Goal, change: TaskChanged) -> None:
        """End a goal in the way its task ended; on the executor's thread."""
        goal.begin()  # no goal ends that was never executing
        self.notify_execute(goal.handle, partial(_ended, change))

    def notify_execute(self, goal_handle: ServerGoalHandle, execute_callback: Any) -> None:
        """Run the callback, where there is one: it ends the goal and returns the result."""
        if execute_callback is not None:
            super().notify_execute(goal_handle, execute_callback)  # type: ignore[no-untyped-call]


def _ended(change: TaskChanged, handle: ServerGoalHandle) -> ExecuteTask.Result:
    """End the goal as its task did; `canceled` only if a client asked for it."""
    if change.state is TaskState.DONE:
        handle.succeed()
    elif change.state is TaskState.CANCELLED and handle.is_cancel_requested:
        handle.canceled()
    else:
        handle.abort()
    reason = change.reason.value if change.reason else ""
    return ExecuteTask.Result(outcome=change.state.value, reason=reason, sentence=str(change.sentence))
