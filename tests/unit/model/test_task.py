"""The states of a task."""

from __future__ import annotations

import pytest

from arboleda.model.errors import IllegalTransition
from arboleda.model.messages import TaskState
from arboleda.model.task import Order, Task

ENDS = (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED)


@pytest.mark.parametrize("state", TaskState, ids=lambda state: state.value)
@pytest.mark.parametrize("end", ENDS, ids=lambda end: end.value)
def test_a_task_that_has_ended_stays_as_it_is(end: TaskState, state: TaskState) -> None:
    task = Task("t-1", Order(text="sis_a 0B 7", cell="sis_a", recipe="storage"))
    task.become(TaskState.RUNNING, 1.0)
    task.become(end, 2.0)
    with pytest.raises(IllegalTransition, match=f"task t-1 cannot go from {end.value} to {state.value}"):
        task.become(state, 3.0)
    assert (task.state, task.ended_at) == (end, 2.0)
