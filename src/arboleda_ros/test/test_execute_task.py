"""The contract of `plant/execute_task`, with a real plant and virtual robots."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest
from action_msgs.msg import GoalStatus
from arboleda_interfaces.action import ExecuteTask
from rclpy.action import ActionClient
from std_msgs.msg import String, UInt8
from std_srvs.srv import Trigger

from arboleda.model.errors import TextError
from arboleda.model.text import parse
from arboleda.plant_file.loader import load

SUCCEEDED, CANCELED, ABORTED = (
    GoalStatus.STATUS_SUCCEEDED,
    GoalStatus.STATUS_CANCELED,
    GoalStatus.STATUS_ABORTED,
)
Execute = Callable[..., Any]


@pytest.fixture(scope="module", autouse=True)
def plant(start: Callable[[], Any]) -> Any:
    return start()


def refusal(text: str) -> str:
    """The sentence with which the plant's own parser refuses a text."""
    with pytest.raises(TextError) as refused:
        parse(text, load(None))
    return str(refused.value)


def test_a_goal_is_accepted_told_of_each_step_and_done(execute: Execute) -> None:
    goal = execute(text="sis_a 0B 7")
    status, result = goal.end()
    assert (status, result.outcome, result.reason, result.sentence) == (SUCCEEDED, "done", "", "")
    steps = [step for step, _ in goal.feedback]
    assert steps[0] == "system start" and steps[-1] == "move to home"
    assert {"drive path 0B", "move to pick-up", "grip", "move to station 7"} <= set(steps)
    progress = [share for _, share in goal.feedback]
    assert (
        progress == sorted(progress)
        and progress[0] == 0.0
        and progress[-1] == pytest.approx(10 / 11, abs=0.01)
    )


def test_fields_do_as_well_as_a_text(execute: Execute) -> None:
    goal = execute(cell="ra2", recipe="palletizing", id="from-fields")
    assert goal.end()[1].outcome == "done"
    assert "effector off" in [step for step, _ in goal.feedback]


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"text": "sis_a 0B 99"}, "sis_a 0B 99"),
        ({"text": ""}, ""),
        ({"cell": "sis_x", "path": "0B", "station": "7"}, "sis_x 0B 7"),
        ({"cell": "sis_a", "recipe": "sorting"}, "sis_a sorting"),
    ],
    ids=["station", "empty", "cell", "recipe"],
)
def test_a_bad_text_ends_refused_with_the_sentence_of_the_plant(
    execute: Execute, fields: dict[str, str], text: str
) -> None:
    goal = execute(**fields)
    status, result = goal.end()
    assert (status, result.outcome, result.sentence) == (ABORTED, "refused", refusal(text))
    assert goal.feedback == []


def test_cells_work_at_the_same_time(execute: Execute) -> None:
    one, other = execute(text="sis_a 0B 7"), execute(text="sis_b 2A 1")
    one.executing()
    other.executing()
    assert one.handle.status == other.handle.status == GoalStatus.STATUS_EXECUTING
    assert [goal.end()[1].outcome for goal in (one, other)] == ["done", "done"]


def test_a_running_task_is_cancelled_and_recovered_from(execute: Execute) -> None:
    goal = execute(text="sis_a 0C 2")
    goal.at("move to station 2")
    assert goal.cancel()
    status, result = goal.end()
    assert (status, result.outcome, result.reason) == (CANCELED, "cancelled", "cancelled")
    assert result.sentence == "cancelled by the client"
    assert any(step.startswith("recovery: ") for step, _ in goal.feedback)
    assert execute(text="sis_a 0A 0").end()[1].outcome == "done"


def test_a_task_that_waits_is_cancelled_at_once(execute: Execute) -> None:
    first, second = execute(text="sis_c 0A 0"), execute(text="sis_c 0A 1")
    first.executing()
    assert second.cancel()
    assert (second.end()[0], second.end()[1].outcome, second.feedback) == (CANCELED, "cancelled", [])
    assert first.end()[1].outcome == "done"


def test_an_ended_task_cannot_be_cancelled(execute: Execute) -> None:
    goal = execute(text="sis_b palletizing")
    assert goal.end()[1].outcome == "done"
    assert not goal.cancel()


def test_what_an_operator_cancels_is_aborted_for_the_client(execute: Execute, client: Any) -> None:
    goal = execute(text="sis_a 1C 3")
    goal.executing()
    assert client.call(Trigger, "plant/cancel").success
    status, result = goal.end()
    assert (status, result.outcome, result.sentence) == (ABORTED, "cancelled", "cancelled by the operator")


def test_goals_of_one_id_are_one_task(execute: Execute, client: Any) -> None:
    starts = client.hear(UInt8, "system/start", latched=False)
    goals = [execute(text="sis_b 0B 4 #lot-1"), execute(cell="SIS_B", path="0b", station="4", id="lot-1")]
    assert [goal.end()[1].outcome for goal in goals] == ["done", "done"]
    late = execute(text="sis_b 0B 4 #lot-1")
    assert late.end()[1].outcome == "done" and late.feedback == []
    assert len(starts) == 1
    other = execute(text="sis_b 0B 5 #lot-1").end()[1]
    assert other.outcome == "refused" and "'sis_b 0B 4'" in other.sentence


def test_a_task_goes_on_without_its_client(client: Any, execute: Execute) -> None:
    changes = client.hear(String, "task_status")
    gone = type(client)("gone")
    server = ActionClient(gone.node, ExecuteTask, "plant/execute_task")
    gone.until(server.server_is_ready, "there is no action server")
    gone.answer(server.send_goal_async(ExecuteTask.Goal(text="sis_c 1B 6 #orphan")))
    gone.vanish()

    def states() -> list[str]:
        known = [json.loads(message.data) for message in changes]
        return [change["state"] for change in known if change["id"] == "orphan"]

    client.until(lambda: "done" in states(), "the task did not go on")
    assert execute(text="sis_c 1B 6 #orphan").end()[1].outcome == "done"
