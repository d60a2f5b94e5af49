"""Trees that compare what a device says of a number, and kinds whose answers are numbers."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.kinds.lab import Bench

from arboleda.model.errors import ArboledaError
from arboleda.model.messages import TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load

PLANT = """
name: bakery
uses: [bake.xml]
kinds:
  oven:
    facts: {{celsius: number, lid: [open, closed]}}
    verbs:
      feel: {{effect: query, answers: {answers}}}
      close: {{effect: motion, sets: {{lid: closed}}}}
cells:
  bench:
    devices: {{oven: {{kind: oven}}}}
"""


def plant(folder: Path, leaf: str, answers: str = "int") -> PlantModel:
    tree = f'<BehaviorTree ID="Bake"><Sequence>{leaf}<oven_close/></Sequence></BehaviorTree>'
    (folder / "bake.xml").write_text(f'<root BTCPP_format="4">{tree}</root>', encoding="utf-8")
    (folder / "plant.yaml").write_text(PLANT.format(answers=answers), encoding="utf-8")
    return load(folder / "plant.yaml")


@pytest.mark.parametrize(("celsius", "state"), [(60.0, TaskState.DONE), (59.9, TaskState.FAILED)])
@pytest.mark.parametrize("within", ["says", "becomes"])
def test_a_leaf_compares_a_fact(tmp_path: Path, within: str, celsius: float, state: TaskState) -> None:
    more = ' at_most_s="2"' if within == "becomes" else ""
    here = Bench(plant(tmp_path, f'<oven_{within} celsius=">= 60 and &lt; 80"{more}/>'))
    here.machines["oven"].facts["celsius"] = celsius
    here.wait(1.0)
    here.submit("bench bake")
    assert here.outcome().state is state


@pytest.mark.parametrize(
    ("leaf", "sentence"),
    [
        ('<oven_says celsius="> 80 and &lt; 60"/>', "celsius is never > 80 and < 60; a oven says a number"),
        ('<oven_says lid="> 3"/>', "lid of oven_says is '> 3'; there are open, closed"),
        ('<oven_says celsius="hot"/>', "celsius of oven_says must be a number, is 'hot'"),
    ],
)
def test_a_comparison_that_no_fact_can_meet_is_refused(tmp_path: Path, leaf: str, sentence: str) -> None:
    with pytest.raises(ArboledaError) as caught:
        plant(tmp_path, leaf)
    assert sentence in str(caught.value)


@pytest.mark.parametrize("answers", ["text", "bool", "{from: 1}", "7"])
def test_answers_are_a_list_or_a_type_of_numbers(tmp_path: Path, answers: str) -> None:
    with pytest.raises(ArboledaError, match=r"must be a list of words or numbers, or int or number for any"):
        plant(tmp_path, "<AlwaysSuccess/>", answers)


def test_a_script_compares_an_answer(tmp_path: Path) -> None:
    leaf = '<oven_feel answer="{felt}"/><ScriptCondition code="felt &gt; 3"/>'
    here = Bench(plant(tmp_path, leaf))
    here.machines["oven"].answer = lambda goal: 4
    here.submit("bench bake")
    assert here.outcome().state is TaskState.DONE
