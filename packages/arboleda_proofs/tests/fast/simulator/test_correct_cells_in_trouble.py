"""Cells of other fields, each with the trouble in which one like it was once called broken."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from tests.lengths import sample

from arboleda.model.messages import Verb
from arboleda.plant_file.loader import load
from arboleda.recipes import Kit, parallel, recipe, work
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.judged_world import JudgedWorld
from arboleda_proofs.simulator.run import Simulation

IDLE = '<root BTCPP_format="4"><BehaviorTree ID="Idle"><AlwaysSuccess/></BehaviorTree></root>'
DRUM = """<root BTCPP_format="4"><BehaviorTree ID="Turn"><Sequence>
  <Repeat num_cycles="2"><Sequence><drum_open/><drum_shut/></Sequence></Repeat>
  <ForceSuccess><Timeout msec="1500"><Repeat num_cycles="-1">
    <Sequence><drum_open/><drum_shut/></Sequence>
  </Repeat></Timeout></ForceSuccess>
  <Sleep msec="1000"/>
  <RetryUntilSuccessful num_attempts="2"><Sequence><drum_shut/><drum_open/></Sequence></RetryUntilSuccessful>
</Sequence></BehaviorTree></root>"""
ROASTERY = """kinds:
  drum:
    facts: {flap: [shut, open]}
    verbs:
      open: {effect: motion, sets: {flap: open}, takes_s: 1}
      shut: {effect: motion, sets: {flap: shut}, takes_s: 1}
cells: {mill: {devices: {drum: {kind: drum}}}}
"""
ORCHARD = """cells:
  row:
    devices: {arm: {kind: arm, model: scara, evidence: joints}}
    targets:
      home: {arm: {deg: [0, 0], mm: 0}}
      tree: {arm: {deg: [30, 40], mm: 50}}
      crate: {arm: {deg: [-30, -40], mm: 50, approach_mm: 20}}
"""
BAKERY = """kinds:
  oven:
    facts: {door: [shut, open]}
    verbs:
      open: {effect: motion, sets: {door: open}, takes_s: 1}
      shut: {effect: motion, sets: {door: shut}, takes_s: 1}
      bake: {effect: process, needs: {door: shut}, takes_s: 6, at_most_s: 20, on_stop: finish}
cells: {house: {devices: {oven: {kind: oven}}}}
"""
WASHER = """kinds:
  washer:
    facts: {door: [open, shut]}
    verbs:
      open: {effect: motion, sets: {door: open}, takes_s: 1}
      shut: {effect: motion, sets: {door: shut}, takes_s: 1}
cells:
  hall:
    devices:
      left:  {kind: arm, model: scara, base: {origin_m: [-0.4, 0]}}
      right: {kind: arm, model: scara, base: {origin_m: [0.4, 0], yaw_deg: 180}}
      washer: {kind: washer}
    targets:
      home: {left: {deg: [0, 0], mm: 0}, right: {deg: [0, 0], mm: 0}}
      drum: {left: {deg: [-60, -40], mm: 50}, right: {deg: [-60, -40], mm: 50}}
zones:
  inside: {poses: [hall drum], free_while: {washer: {door: open}}}
"""


@recipe("pick")
def pick(cell: Kit):  # type: ignore[no-untyped-def]
    """An apple is picked."""
    arm = cell.device("arm")
    return work(arm.visit("tree", arm.grip()), arm.visit("crate", arm.let_go()), arm.home())


@recipe("bake")
def bake(cell: Kit):  # type: ignore[no-untyped-def]
    """Bread is baked, whatever is stopped meanwhile."""
    oven = cell.device("oven")
    return work(oven.shut(), oven.bake(), oven.open())


@recipe("wash")
def wash(cell: Kit):  # type: ignore[no-untyped-def]
    """Both arms want to reach into the drum, and the washer wants to shut its door."""
    left, right, washer = cell.devices("left", "right", "washer")
    return parallel(left.visit("drum"), right.visit("drum"), work(washer.shut(), washer.open()))


@dataclass(frozen=True, kw_only=True)
class Case:
    """A plant of a field, and what goes wrong in it so often per minute."""

    plant: str
    recipes: tuple[Any, ...] = ()
    weather: Mapping[str, float]


CASES = {
    "a motion in a loop is halted": Case(
        plant=ROASTERY, weather={"operator_hold": 8.0, "operator_cancel": 4.0, "ends_late": 2.0}
    ),
    "an arm at joints is heard late": Case(
        plant=ORCHARD,
        recipes=(pick,),
        weather={"delay": 4.0, "reorder": 4.0, "duplicate": 4.0, "reboot": 1.0},
    ),
    "work that finishes is stopped": Case(
        plant=BAKERY, recipes=(bake,), weather={"operator_stop": 4.0, "ends_late": 2.0}
    ),
    "a person is stopped, and their oven is cleared": Case(
        plant=BAKERY.replace("{oven: {kind: oven}}", "{oven: {kind: oven}, ana: {kind: person}}"),
        recipes=(bake,),
        weather={"operator_stop": 6.0, "operator_clear": 12.0, "operator_reset": 3.0},
    ),
    "nobody is in the zone": Case(
        plant=WASHER, recipes=(wash,), weather={"operator_stop": 3.0, "never_ends": 1.0, "reboot": 1.0}
    ),
}


@pytest.mark.sampled(5)
@pytest.mark.parametrize("seed", sample(range(1, 9), every=8))
@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_nothing_is_said_against_a_correct_cell(tmp_path: Path, case: Case, seed: int) -> None:
    (tmp_path / "turn.xml").write_text(DRUM if "drum: {kind: drum}" in case.plant else IDLE)
    (tmp_path / "plant.yaml").write_text(f"name: field\nuses: [turn.xml]\n{case.plant}")
    model = load(tmp_path / "plant.yaml")
    if case.recipes:
        model = replace(model, cells=tuple(replace(cell, recipes=case.recipes) for cell in model.cells))
    climate = Climate.from_file(model, seed, {"rates": case.weather})
    assert Simulation(model, seed, climate.faults).run(cycles=3).broken is None


STORE = """name: mixed
uses: [idle.xml]
paths: {0B: [0, 3, 4, 7]}
stations: {0: {deg: [20, 10], mm: 50}}
cells:
  store:
    arm: {name: ra1, model: scara, link: mqtt, evidence: ids}
    mobile: {name: rm1, link: mqtt, evidence: ids}
    home: {deg: [0, 0], mm: 0}
    pickup: {deg: [45, 10], mm: 0}
  house: {devices: {oven: {kind: oven}}}
kinds:
  oven: {verbs: {bake: {effect: process, takes_s: 1}}}
"""


def test_a_rack_is_unloaded_beside_a_cell_that_has_none(tmp_path: Path) -> None:
    (tmp_path / "idle.xml").write_text(IDLE)
    (tmp_path / "plant.yaml").write_text(STORE)
    watched = JudgedWorld(load(tmp_path / "plant.yaml"))
    world = watched.world
    world.advance(1.0)
    world.request_task("store 0B 0")
    world.advance(40.0)
    assert any(world.plant.cells["store"].context.places.counts.values())
    for scope in ("house", "oven", "rm1", "house 0", ""):
        world.request_verb(Verb.UNLOAD, scope)
        world.advance(1.0)
    assert not any(world.plant.cells["store"].context.places.counts.values())
