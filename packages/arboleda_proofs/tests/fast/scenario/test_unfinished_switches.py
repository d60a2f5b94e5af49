"""A switch that has failed, and is carried out all the same: the zone stays with its device until then."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda_proofs.testing import Sim

PLANT = """
name: ovens
uses: [recipes.py]
kinds:
  oven:
    facts: {{tray: [up, down]}}
    verbs:
      lower: {{effect: {effect}, sets: {{tray: down}}, takes_s: 2}}
      lift: {{effect: switch, sets: {{tray: up}}, takes_s: 1}}
cells:
  hall:
    devices:
      oven: {{kind: oven, stop: {stop}}}
      arm: {{kind: arm, model: scara, base: {{origin_m: [0, 0]}}}}
    targets:
      home: {{arm: {{deg: [0, 0], mm: 0}}}}
      inside: {{arm: {{deg: [60, 60], mm: 80, approach_mm: 40}}}}
zones: {{hatch: {{poses: [hall inside], free_while: {{oven: {{tray: up}}}}}}}}
"""
RECIPES = """
from arboleda.recipes import recipe

@recipe("shut")
def shut(cell):
    return cell.device("oven").lower()

@recipe("open")
def open_it(cell):
    return cell.device("oven").lift()
"""


def holder(sim: Sim) -> str | None:
    (zone,) = sim.snapshot()["zones"]
    return zone["robot"]


@pytest.fixture
def oven(sim: Sim, tmp_path: Path, request: pytest.FixtureRequest) -> Sim:
    """The plant while its oven is told to lower the tray."""
    (tmp_path / "plant.yaml").write_text(PLANT.format(stop=request.param, effect="switch"))
    (tmp_path / "recipes.py").write_text(RECIPES)
    sim.plant(tmp_path / "plant.yaml")
    sim.run(1)
    sim.submit("hall shut")
    sim.run(until=lambda: sim.cell("hall").step == "oven lower")
    sim.run(0.5)
    return sim


@pytest.mark.parametrize("oven", ["supported", "none"], indirect=True)
def test_an_alarm_does_not_end_a_switch(oven: Sim) -> None:
    oven.fault("driver_alarm", "oven", seconds=0.5)
    oven.run(1.0)
    assert not oven.cell("hall").task and holder(oven) == "oven"
    oven.run(5)  # the tray goes down, and no invariant is broken
    assert oven.robot("oven").facts == {"tray": "down"} and holder(oven) == "oven"


@pytest.mark.parametrize("oven", ["supported", "none"], indirect=True)
def test_a_zone_comes_free_once_a_switch_has_taken_the_place_of_one_that_failed(oven: Sim) -> None:
    oven.fault("driver_alarm", "oven", seconds=0.2)
    oven.run(0.5)
    oven.operate("resume", "hall")
    task = oven.submit("hall open")
    oven.run(until=lambda: task.ended)
    oven.run(0.2)
    assert task.state == "done" and holder(oven) is None


@pytest.mark.parametrize("oven", ["supported"], indirect=True)
def test_a_zone_comes_free_where_the_device_has_forgotten_its_switch(oven: Sim) -> None:
    oven.fault("driver_alarm", "oven", seconds=0.2)
    oven.run(0.5)
    oven.fault("reboot", "oven")
    oven.run(0.5)
    assert holder(oven) == "oven"
    oven.run(10)
    assert oven.robot("oven").facts == {"tray": "up"} and holder(oven) is None


def test_a_report_from_before_a_lost_link_frees_no_zone_that_a_motion_leads_into(
    sim: Sim, tmp_path: Path
) -> None:
    (tmp_path / "plant.yaml").write_text(PLANT.format(stop="supported", effect="motion"))
    (tmp_path / "recipes.py").write_text(RECIPES)
    sim.plant(tmp_path / "plant.yaml")
    sim.run(1)
    sim.fault("delay", "oven", word="up", seconds=6, amount=2.0)  # what boards say comes two seconds late
    sim.submit("hall shut")
    sim.run(until=lambda: sim.cell("hall").step == "oven lower")
    sim.run(until=lambda: not sim.robot("oven").online)
    sim.run(until=lambda: sim.robot("oven").online)
    assert holder(sim) == "oven"
