"""Services and topics in the types of arboleda_interfaces, with a real plant and virtual robots."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest
from arboleda_interfaces.msg import CellState, TaskList
from arboleda_interfaces.srv import CellCommand, SubmitTask

from arboleda.model.messages import Verb


@pytest.fixture(scope="module", autouse=True)
def plant(start: Callable[[], Any]) -> Any:
    return start()


@pytest.fixture
def submit(client: Any) -> Callable[..., Any]:
    return lambda **fields: client.call(SubmitTask, "plant/submit_task", **fields)


@pytest.fixture
def command(client: Any) -> Callable[..., Any]:
    def go(verb: str, scope: str = "", **more: Any) -> tuple[bool, str]:
        answer = client.call(CellCommand, "plant/cell_command", verb=verb, scope=scope, **more)
        return answer.success, answer.message

    return go


def known(client: Any, messages: list[Any], id: str, state: str) -> Any:
    """The task in the last list, once it is in that state."""

    def found() -> Any:
        tasks = messages[-1].tasks if messages else []
        return next((task for task in tasks if (task.id, task.state) == (id, state)), None)

    return client.until(found, f"{id} was never {state}")


def test_a_task_is_submitted_and_listed_to_its_end(client: Any, submit: Any) -> None:
    messages = client.hear(TaskList, "plant/tasks")
    answer = submit(text="sis_a 0A 4 #listed")
    assert answer.accepted
    assert (answer.task.id, answer.task.text, answer.task.cell) == ("listed", "sis_a 0A 4", "sis_a")
    assert answer.task.state == "queued"
    assert known(client, messages, "listed", "done").sentence == ""
    assert messages[-1].stamp.sec > 0
    late = client.hear(TaskList, "plant/tasks")
    known(client, late, "listed", "done")


def test_a_task_is_submitted_by_its_fields(client: Any, submit: Any) -> None:
    answer = submit(cell="sis_b", path="1b", station="2", id="fields")
    assert (answer.accepted, answer.task.text, answer.task.id) == (True, "sis_b 1B 2", "fields")
    known(client, client.hear(TaskList, "plant/tasks"), "fields", "done")


def test_a_refused_task_says_why(submit: Any) -> None:
    answer = submit(cell="sis_b", path="1B", station="9")
    assert (answer.accepted, answer.task.state, answer.task.id) == (False, "refused", "")
    assert "'9' is not a station of sis_b" in answer.task.sentence


def test_a_cell_tells_its_state_and_progress_when_they_change(client: Any, submit: Any) -> None:
    messages = client.hear(CellState, "sis_c/state")
    client.until(lambda: messages and messages[-1].state == "idle", "sis_c is not idle")
    for id in ("one", "two"):
        submit(text=f"sis_c 0B 3 #{id}")
    client.until(lambda: [state.task for state in messages[-2:]] == ["two", ""], "sis_c did not finish")
    first = [state for state in messages if state.task == "one"]
    assert first[-1].queue == ["two"] and first[-1].waiting_for == "sis_c is busy"
    assert [state.progress for state in first] == sorted(state.progress for state in first)
    assert first[-1].progress > 0.8 and "move to pick-up" in [state.step for state in first]
    last = messages[-1]
    assert (last.cell, last.task, last.step, last.progress) == ("sis_c", "", "", 0.0)
    assert last.queue_running and last.queue == [] and last.waiting_for == ""
    assert all(one != other for one, other in pairwise(messages))


def test_a_cell_is_held_and_resumed(client: Any, submit: Any, command: Any) -> None:
    messages = client.hear(CellState, "sis_a/state")
    submit(text="sis_a 1B 5 #held")
    client.until(lambda: messages and messages[-1].step == "move to pick-up", "sis_a does not move")
    assert command("hold", "sis_a") == (True, "")
    client.until(lambda: messages[-1].state == "held", "sis_a was not held")
    assert not messages[-1].queue_running
    assert command(" Resume ", "sis_a") == (True, "")
    known(client, client.hear(TaskList, "plant/tasks"), "held", "done")


def test_a_task_is_cancelled_by_its_id(client: Any, submit: Any, command: Any) -> None:
    submit(text="sis_b 1B 5 #unwanted")
    assert command("cancel", "unwanted") == (True, "")
    known(client, client.hear(TaskList, "plant/tasks"), "unwanted", "cancelled")


@pytest.mark.parametrize(
    ("verb", "scope", "more", "why"),
    [
        ("dance", "", {}, f"'dance' is no verb; there are {', '.join(verb.value for verb in Verb)}"),
        ("", "sis_a", {}, "'' is no verb"),
        ("stop", "", {"by_hand": True}, "by_hand is for home and release only, not for stop"),
        ("retry", "sis_b", {}, "sis_b is idle"),
        ("hold", "sis_x", {}, "'sis_x' is neither a cell nor a robot"),
        ("override", "nowhere", {}, "nowhere"),
        ("home", "ra1", {"by_hand": True}, "ra1 says itself whether it is homed"),
    ],
)
def test_a_command_that_is_refused_says_why(
    command: Any, verb: str, scope: str, more: dict[str, Any], why: str
) -> None:
    success, message = command(verb, scope, **more)
    assert not success and why in message
