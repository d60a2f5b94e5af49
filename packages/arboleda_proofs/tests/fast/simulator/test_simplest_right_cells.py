"""The simplest right cells, each with what befell it when the judge once took it for wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from arboleda.model.advice import Advice, in_words
from arboleda.model.messages import Check, Verb
from arboleda.plant_file.loader import load
from arboleda.rig.hands import do
from arboleda.rig.world import World
from arboleda.trees.handling import Handling
from arboleda_proofs.campaigns.plants import Plant
from arboleda_proofs.campaigns.proof.calm import calm_runs
from arboleda_proofs.campaigns.proof.forks import run_one
from arboleda_proofs.campaigns.proof.outcome import End
from arboleda_proofs.campaigns.proof.proof import Proof
from arboleda_proofs.campaigns.proof.scenario import scenarios
from arboleda_proofs.simulator import people
from arboleda_proofs.simulator.faults.kind import Fault
from arboleda_proofs.simulator.judged_world import JudgedWorld
from arboleda_proofs.simulator.people import Attendant
from arboleda_proofs.simulator.run import Result, Simulation
from arboleda_proofs.simulator.scripted_people import script_from

PLACES = """
    targets:
      home: {arm: {deg: [0, 0], mm: 0}}
      in: {arm: {deg: [60, 20], mm: 50}}
      bin: {arm: {deg: [-60, 20], mm: 50}}
      mid: {arm: {deg: [-90, 20], mm: 50}}
    places: {in: {supply: true}, bin: {holds: 50, output: true}, mid: {}}"""
ONE = f"""
name: one
uses: [recipes.py]
cells:
  a:
    devices: {{arm: {{kind: arm, model: scara}}, jaw: {{kind: gripper, tool_of: arm}}}}{PLACES}
"""
THREE = """
name: three
uses: [recipes.py]
kinds:
  bed:
    facts: {full: bool}
    verbs: {clamp: {effect: switch, with: {on: bool}, sets: {full: $on}, holds: part}}
shared:
  arm: {kind: arm, model: scara}
  jaw: {kind: gripper, tool_of: arm}
cells:
"""
CELL = """
  %s:
    devices: {arm: {shared: arm}, jaw: {shared: jaw}, bed: {kind: bed, name: bed_%s}}
    zone_wait_s: 600"""
THREE += "".join(CELL % (cell, cell) + PLACES for cell in "abc")
CARRY = """
from arboleda.recipes import recipe, work

@recipe("carry", ends_with={"in": 0, "mid": 0})
def carry(cell):
    arm, jaw = cell.devices("arm", "jaw")
    arm.brings_back_to("bin")
    take, put = arm.visit("in", jaw.close(width_mm=30, force_n=20)), arm.visit("bin", jaw.open())
    return work(take, put, arm.home(), cell.wait(5))
"""
CLAMP = (
    """
name: clamp
uses: [recipes.py]
kinds:
  bed:
    facts: {full: bool}
    verbs: {clamp: {effect: switch, with: {on: bool}, sets: {full: $on}, holds: part}}
cells:
  a:
    devices: {arm: {kind: arm, model: scara}, bed: {kind: bed}}"""
    + PLACES
)
CLAMPED = """
from arboleda.recipes import recipe, work

@recipe("carry", ends_with={"bed.full": False})
def carry(cell):
    arm, bed = cell.devices("arm", "bed")
    take, put = arm.visit("in", arm.grip()), arm.visit("bin", arm.let_go())
    return work(take, put, arm.home(), bed.clamp(on=True), cell.wait(5), bed.clamp(on=False))
"""
PLUG = """
name: plug
uses: [recipes.py]
kinds:
  plug:
    facts: {power: [off, on]}
    verbs: {turn: {effect: switch, with: {to: [off, on]}, sets: {power: $to}, takes_s: 0.2, at_most_s: 3}}
cells:
  a:
    devices: {plug: {kind: plug, evidence: facts}}
"""
LIGHT = """
from arboleda.recipes import recipe, work

@recipe("light")
def light(cell):
    return work(cell.device("plug").turn(to="on"))
"""
EACH = 40  # of so many portions of a proof one is run
FAULTS = {
    "a gripper closes late, where the recovery has carried it": Fault(
        kind="board_stall", at=3.845405, seconds=3.266041, target="jaw"
    ),
    "a person fills the supply of a task that has taken from it": Fault(
        kind="operator_load", at=10.0, target="a", word="in"
    ),
    "a person brings a part to a place that the task leaves empty": Fault(
        kind="operator_load", at=10.0, target="a", word="mid"
    ),
}

BY_ARM = """
from arboleda.recipes import recipe, work

@recipe("carry")
def carry(cell):
    arm = cell.device("arm")
    return work(arm.visit("in", arm.grip()), arm.visit("bin", arm.let_go()), arm.home())
"""


def written(folder: Path, plant: str, recipes: str = CARRY) -> Any:
    (folder / "recipes.py").write_text(recipes, "utf-8")
    (folder / "plant.yaml").write_text(plant, "utf-8")
    return load(folder / "plant.yaml")


def run(model: Any, *faults: Fault) -> Result:
    script = script_from(model, {"people": [{"at": 2.0, "task": "a carry"}], "seconds": 25})
    plan = {0: faults}
    return Simulation(model, 1, lambda minute: plan.get(minute, ()), script=script).run()


@pytest.mark.sampled(3)
@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS)
def test_nothing_is_said_against_the_simplest_cell(tmp_path: Path, fault: Fault) -> None:
    assert run(written(tmp_path, ONE), fault).broken is None


def test_a_part_that_a_person_brought_is_none_that_the_recipe_has_left(tmp_path: Path) -> None:
    says_one = CARRY.replace('"mid": 0', '"mid": 1')
    broken = run(
        written(tmp_path, ONE, says_one), Fault(kind="operator_load", at=10.0, target="a", word="mid")
    )
    assert broken.broken is not None
    assert broken.broken.sentence == "t-1000-1 is called done, and mid is 0, not 1"


def test_what_each_cell_advises_of_a_device_that_they_share_is_done_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: list[Advice] = []
    monkeypatch.setattr(people, "do", lambda world, advice: (done.append(advice), do(world, advice)))
    watched = JudgedWorld(written(tmp_path, THREE))
    watched.world.advance(1.0)
    watched.world.crash("arm")  # each of the three cells advises to home it
    attendant = Attendant(watched.world, seed=0)
    watched.world.advance(30.0)
    assert [cell.not_ready for cell in watched.world.plant.cells.values()] == [None] * 3
    did = {cell: [str(in_words(each)) for each in acts] for cell, acts in attendant.acts.items()}
    assert len(done) == 1 and did == {cell: ["home arm"] for cell in "abc"}


def test_acts_that_only_other_cells_need_count_for_none_but_those(tmp_path: Path) -> None:
    watched = JudgedWorld(written(tmp_path, THREE))
    watched.world.advance(1.0)
    watched.world.request_verb(Verb.STOP, "a")
    watched.world.advance(1.0)
    attendant = Attendant(watched.world, seed=0)
    watched.world.advance(30.0)
    assert [cell.not_ready for cell in watched.world.plant.cells.values()] == [None] * 3
    counts = {cell: len(attendant.acts[cell]) for cell in "abc"}
    assert counts["a"] > counts["b"] == counts["c"]


def test_a_cell_that_waits_for_a_shared_arm_goes_on_as_it_is_seen_at_home_again(tmp_path: Path) -> None:
    watched = JudgedWorld(written(tmp_path, THREE))
    watched.world.advance(2.0)
    watched.world.request_task("a carry")
    watched.world.settle()
    watched.begin(
        Fault(kind="lying_telemetry", at=2.0, seconds=10.0, target="arm", word="q1_mov", amount=40.0)
    )
    watched.world.advance(11.0)
    assert watched.world.plant.zones.holder("arm") == "a"


def test_a_release_may_be_unchecked_where_another_holder_of_the_cell_has_booted(tmp_path: Path) -> None:
    model = written(tmp_path, CLAMP, CLAMPED)
    assert run(model, Fault(kind="forgets", at=10.0, target="bed")).broken is None


def test_a_holder_that_the_task_never_uses_excuses_no_unchecked_release(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begin = Handling.begin
    monkeypatch.setattr(Handling, "begin", lambda self: begin(self, unchecked=[Check.RELEASE]))
    silent = CLAMP.replace("bed: {kind: bed}", "bed: {kind: bed, evidence: state}")
    broken = run(written(tmp_path, silent, BY_ARM)).broken
    assert broken is not None and broken.invariant == "unchecked_is_as_said"


def test_a_task_may_open_a_shared_hand_in_the_step_in_which_an_operator_has_another_device_let_go(
    tmp_path: Path,
) -> None:
    model = written(tmp_path, THREE)
    opened_at = opening(JudgedWorld(model).world)
    watched = JudgedWorld(model)
    watched.world.at(opened_at, lambda _: watched.world.request_verb(Verb.RELEASE, "b"))
    assert opening(watched.world) == opened_at
    watched.world.advance(5.0)


def test_a_boot_that_no_report_tells_excuses_a_switch_that_is_already_said_to_be_so(tmp_path: Path) -> None:
    model = written(tmp_path, PLUG, LIGHT)
    people = [{"at": 1.0, "task": "a light"}, {"at": 2.0, "task": "a light"}]
    script = script_from(model, {"people": people, "seconds": 10})
    plan = {0: (Fault(kind="forgets", at=2.2, target="plug"),)}
    assert Simulation(model, 1, lambda minute: plan.get(minute, ()), script=script).run().broken is None


def opening(world: World) -> float:
    """The time at which a task has the shared hand let go."""
    opened: list[float] = []

    def look() -> None:
        if any(getattr(each, "verb", "") == "open" for each in world.moment.sent):
            opened.append(world.now)

    world.watchers.append(look)
    world.advance(2.0)
    world.request_task("a carry")
    assert world.advance(20.0, lambda: bool(opened))
    return opened[0]


@pytest.mark.parametrize(("kind", "place"), [("operator_unload", "bin"), ("operator_load", "in")])
def test_what_a_person_brings_or_takes_out_is_nothing_that_nobody_notices(
    tmp_path: Path, kind: str, place: str
) -> None:
    model = Plant(declared=written(tmp_path, ONE)).model
    (calm,) = calm_runs(model, scenarios(model))
    on_its_way_home = calm.run.mended_at - 0.1
    outcome = run_one(model, calm, Fault(kind=kind, at=on_its_way_home, target="a", word=place)).outcome
    assert (outcome.end, outcome.untrue) == (End.DONE, ())


@pytest.mark.long
@pytest.mark.parametrize(
    ("plant", "recipes"), [(ONE, CARRY), (THREE, CARRY), (CLAMP, CLAMPED)], ids=["one", "three", "clamp"]
)
def test_a_sample_of_all_single_faults_breaks_nothing(tmp_path: Path, plant: str, recipes: str) -> None:
    model = Plant(declared=written(tmp_path, plant, recipes)).model
    proof = Proof(model=model, calm=tuple(calm_runs(model, scenarios(model))))
    proved = [proof.run(number) for number in range(0, len(proof.portions), EACH)]
    assert [each.broken for portion in proved for each in portion.outcomes if each.broken] == []
