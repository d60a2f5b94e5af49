"""Tasks by named values and answers of people, over the real types of arboleda_interfaces."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from action_msgs.msg import GoalStatus
from arboleda_interfaces.srv import CellCommand, SubmitTask

PLANT = """\
name: lab
uses: [recipes.py]
kinds:
  heater:
    facts: {celsius: [20, 40, 60]}
    verbs:
      heat:
        effect: process
        with: {celsius: [20, 40, 60]}
        sets: {celsius: $celsius}
        takes_s: 0.2
        at_most_s: 20
cells:
  bench:
    devices:
      heater: {kind: heater}
  desk:
    devices:
      ana: {kind: person}
"""
RECIPES = '''\
from arboleda.recipes import Choice, Number, recipe, work


@recipe("warm")
def warm(cell, celsius: Choice[20, 40, 60], times: Number(1, 3)):
    """Warm it so many times."""
    return cell.repeat(cell.device("heater").heat(celsius=celsius), times)


@recipe("ask")
def ask(cell):
    """Ask whether there are parts again."""
    asked = cell.device("ana").ask("Is the pallet full?", ["yes", "no parts left"])
    return work(asked, cell.choose(asked, {"yes": [], "no parts left": cell.fail("there are no parts left")}))
'''


@pytest.fixture(scope="module", autouse=True)
def plant(link: Callable[[], Any], tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """A bench and a person, with virtual boards."""
    from arboleda.plant_file.loader import load
    from arboleda.runtime.build import Options, build

    folder: Path = tmp_path_factory.mktemp("lab")
    (folder / "plant.yaml").write_text(PLANT, "utf-8")
    (folder / "recipes.py").write_text(RECIPES, "utf-8")
    options = Options(link=link(), state_dir=folder / "state")
    app = build(load(folder / "plant.yaml"), {"broker", "devices", "bridge", "orchestrator"}, options)
    app.start()
    yield app
    app.stop()


@pytest.fixture
def command(client: Any) -> Callable[..., tuple[bool, str]]:
    def go(verb: str, scope: str) -> tuple[bool, str]:
        answer = client.call(CellCommand, "plant/cell_command", verb=verb, scope=scope)
        return answer.success, answer.message

    return go


def test_a_goal_names_the_values_of_its_recipe(execute: Callable[..., Any]) -> None:
    goal = execute(cell="bench", recipe="warm times=2 celsius=40", id="named")
    status, result = goal.end()
    assert (status, result.outcome) == (GoalStatus.STATUS_SUCCEEDED, "done"), result.sentence


def test_a_task_is_submitted_by_named_values(client: Any) -> None:
    answer = client.call(SubmitTask, "plant/submit_task", cell="bench", recipe="warm celsius=60 times=1")
    assert (answer.accepted, answer.task.text) == (True, "bench 60 1"), answer.task.sentence


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ("celsius=50 times=1", "'50'"),
        ("celsus=40 times=1", "celsus"),
        ("celsius=40", "the task has 3 words; write <cell> <celsius> <times>"),
        ("celsius=40 celsius=20 times=1", "celsius is named twice"),
    ],
)
def test_a_value_that_is_wrong_is_refused_with_a_sentence(
    execute: Callable[..., Any], values: str, why: str
) -> None:
    status, result = execute(cell="bench", recipe=f"warm {values}").end()
    assert (status, result.outcome) == (GoalStatus.STATUS_ABORTED, "refused")
    assert why in result.sentence


@pytest.mark.parametrize(("answer", "outcome"), [("yes", "done"), ("no parts left", "failed")])
def test_a_person_answers_by_a_service(
    client: Any, execute: Callable[..., Any], command: Callable[..., Any], answer: str, outcome: str
) -> None:
    goal = execute(text=f"desk ask #{answer.replace(' ', '_')}")
    unknown = "'perhaps' is no answer to what ana is asked; answers: yes, no parts left"
    client.until(lambda: command("answer", "ana perhaps") == (False, unknown), "ana is not asked")
    assert command("answer", f"ana {answer}") == (True, "")
    _, result = goal.end()
    assert result.outcome == outcome
    success, why = command("answer", "ana yes")
    assert not success and "ana" in why
