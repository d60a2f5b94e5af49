"""A scale that answers a number: `check`, simulated devices and `prove` get to each range of a recipe."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.facts import Value
from arboleda.model.plant_model import PlantModel
from arboleda.plant_check import advance_check
from arboleda.plant_file import loader
from arboleda.sim.machine import MachineBody
from arboleda.wire.payloads import VerbGoal
from arboleda_proofs.campaigns.proof.calm import calm_runs
from arboleda_proofs.campaigns.proof.scenario import scenarios
from arboleda_proofs.simulator.branch_numbers import numbers
from arboleda_proofs.simulator.people import answer_anything
from arboleda_proofs.testing import Sim

PLANT = """
name: sorter
uses: [{file}]
kinds:
  scale: {{verbs: {{weigh: {{effect: query, answers: number, takes_s: 1}}}}}}
  gate:
    facts: {{at: [middle, left, right]}}
    verbs: {{turn: {{effect: motion, with: {{to: [middle, left, right]}}, sets: {{at: $to}}, takes_s: 1}}}}
cells:
  line:
    devices: {{scale: {{kind: scale}}, gate: {{kind: gate}}}}
"""
PYTHON = """
from arboleda.recipes import recipe, work


@recipe("sort")
def sort(cell):
    scale, gate = cell.devices("scale", "gate")
    weight_g = scale.weigh()
    ways = {
        "> 120": gate.turn(to="left"),
        ">= 100 and <= 120": gate.turn(to="right"),
        "otherwise": cell.fail("too light"),
    }
    return work(weight_g, cell.choose(weight_g, ways))
"""
XML = """
<root BTCPP_format="4"><BehaviorTree ID="Sort"><Sequence>
  <scale_weigh answer="{weight_g}"/>
  <ScriptCondition code="weight_g &gt;= 100"/>
  <gate_turn to="left" _skipIf="weight_g &lt;= 120"/>
  <gate_turn to="right" _skipIf="weight_g &gt; 120"/>
</Sequence></BehaviorTree></root>
"""
FILES = {"recipes.py": PYTHON, "sort.xml": XML}


def plant(folder: Path, name: str, text: str) -> PlantModel:
    (folder / name).write_text(text, encoding="utf-8")
    file = folder / "plant.yaml"
    file.write_text(PLANT.format(file=name), encoding="utf-8")
    return loader.load(file)


@pytest.fixture(params=FILES)
def sorter(request: pytest.FixtureRequest, tmp_path: Path) -> PlantModel:
    return plant(tmp_path, request.param, FILES[request.param])


def test_answers_are_in_each_range_and_at_each_limit(sorter: PlantModel) -> None:
    assert numbers(sorter) == {("scale", "weigh"): (0.0, 99.0, 100.0, 110.0, 120.0, 121.0)}


def test_a_simulated_scale_gives_all_of_them(sorter: PlantModel) -> None:
    sim = Sim()
    sim.plant(sorter)
    answer_anything(sim.world, 1)
    body = sim.world.boards["scale"].body
    assert isinstance(body, MachineBody)
    goal = VerbGoal(verb="weigh", values=(), seq=1, epoch=1, heard=0)
    assert {body.answer(goal) for _ in range(100)} == {0.0, 99.0, 100.0, 110.0, 120.0, 121.0}


def test_each_way_is_proved(sorter: PlantModel) -> None:
    found = list(calm_runs(sorter, scenarios(sorter)))
    turns = {each.scenario.answers: [call for call in each.commands if "turn" in call] for each in found}
    ways = [(answers, " ".join(calls)) for answers, calls in turns.items()]
    assert ways == [((), ""), (said(100.0), "gate: doing turn right"), (said(121.0), "gate: doing turn left")]


def said(grams: Value) -> tuple[tuple[str, Value], ...]:
    return (("scale", grams),)


def test_what_is_wrong_behind_one_range_is_found_in_advance(tmp_path: Path) -> None:
    ends = (
        '<SubTree ID="Sort"><MetadataFields><Metadata ends_with="gate.at: left"/></MetadataFields></SubTree>'
    )
    model_of_tree = f"</BehaviorTree><TreeNodesModel>{ends}</TreeNodesModel></root>"
    text = XML.replace("</BehaviorTree></root>", model_of_tree)
    assert "gate" in " ".join(advance_check.warnings(plant(tmp_path, "sort.xml", text)))


def test_a_test_prepares_a_number(sorter: PlantModel) -> None:
    sim = Sim()
    sim.plant(sorter)
    sim.answers("scale", "weigh", 120.5)
    sim.submit("line sort")
    sim.rest()
    assert sim.robot("gate").facts["at"] == "left"
