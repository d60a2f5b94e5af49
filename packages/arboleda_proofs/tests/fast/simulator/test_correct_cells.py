"""Cells of other fields that are correct: nothing is said against them, whatever befalls them."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from arboleda.kinds import Kind, Number, process
from arboleda.kinds.declared import Device
from arboleda.model.messages import Verb
from arboleda.model.plant_model import Cell, Evidence, Link, PlantModel
from arboleda.plant_file.loader import load
from arboleda.recipes import Choice, Kit, recipe, work
from arboleda.recipes import Number as Blows
from arboleda.rig import plant_process
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld
from arboleda_proofs.simulator.run import Simulation

Weather = str | Mapping[str, float]
IDLE = '<root BTCPP_format="4"><BehaviorTree ID="Idle"><AlwaysSuccess/></BehaviorTree></root>'


def cell_of(folder: Path, text: str, *recipes: Any) -> PlantModel:
    """The plant of a file, with these recipes in each of its cells."""
    (folder / "idle.xml").write_text(IDLE)
    (folder / "plant.yaml").write_text(f"{text}uses: [idle.xml]\n")
    model = load(folder / "plant.yaml")
    return replace(model, cells=tuple(replace(cell, recipes=recipes) for cell in model.cells))


def broken(
    model: PlantModel, weather: Weather = "none", *, seed: int = 1, cycles: int = 3
) -> BrokenInvariant | None:
    """The broken invariant: at a level of faults, or where these kinds come so often per minute."""
    if isinstance(weather, str):
        climate = Climate.draw(model, seed, weather)
    else:
        climate = Climate.from_file(model, seed, {"rates": weather})
    return Simulation(model, seed, climate.faults).run(cycles=cycles).broken


PRESS = Kind(verbs={"strike": process(parameters={"blows": Number(3, 40)}, takes_s=1)}).declared


@recipe("strike")
def strike(cell: Kit, blows: Blows[3, 40]):  # type: ignore[no-untyped-def,valid-type]
    """The press strikes so often."""
    return cell.device("press").strike(blows=blows)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("kind", ["second_orchestrator", "foreign_command", "foreign_old"])
def test_others_tell_a_device_only_numbers_within_its_limits(kind: str) -> None:
    press = Device(name="press", mqtt="press", link=Link.MQTT, evidence=Evidence.IDS, timeout_s=5, kind=PRESS)
    forge = Cell(name="forge", queue_limit=5, members=(("press", press),), recipes=(strike,))
    assert broken(PlantModel(name="smithy", cells=(forge,)), {kind: 20.0}) is None


KILNS = """name: pottery
kinds:
  fan:
    facts: {turns: bool}
    verbs: {turn: {effect: switch, with: {on: bool}, sets: {turns: $on}}}
shared: {fan: {kind: fan, evidence: state}}
cells:
  raku:  {devices: {fan: {shared: fan}, light: {kind: fan, name: light_1}}}
  glaze: {devices: {fan: {shared: fan}, light: {kind: fan, name: light_2}}}
"""


@recipe("air")
def air(cell: Kit, on: Choice[0, 1]):  # type: ignore[no-untyped-def,valid-type]
    """The fan of both cells is switched, and is free while the cell waits."""
    return work(cell.device("fan").turn(on=bool(on)), cell.wait(0.1))


ONE_KILN = KILNS[: KILNS.index("  glaze")]


@pytest.mark.long
@pytest.mark.parametrize("fault", ["gives_up", "refuses"])
def test_nobody_knows_that_a_device_at_state_did_not_switch(tmp_path: Path, fault: str) -> None:
    assert broken(cell_of(tmp_path, ONE_KILN, air), {fault: 6.0}, cycles=20) is None


@pytest.mark.long
def test_a_task_does_not_answer_for_what_another_cell_has_switched_since(tmp_path: Path) -> None:
    assert broken(cell_of(tmp_path, KILNS, air), {"slow_disk": 5.0}, cycles=40) is None


@pytest.mark.parametrize("hears", [True, False])
def test_what_nobody_reports_settles_from_when_it_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, hears: bool
) -> None:
    if not hears:
        monkeypatch.setattr(plant_process, "late_departure", lambda *_: None)
    watched = JudgedWorld(cell_of(tmp_path, ONE_KILN, air))
    watched.world.disk.slow.append(0.5)
    watched.world.request_task("raku air 1")
    with nullcontext() if hears else pytest.raises(BrokenInvariant, match="taken for done"):
        watched.world.advance(10.0)


def test_a_device_at_state_that_did_not_switch_is_found_where_nothing_goes_wrong(tmp_path: Path) -> None:
    watched = JudgedWorld(cell_of(tmp_path, KILNS, air))
    watched.world.boards["fan"].body.does = lambda goal: False
    watched.world.request_task("raku air 1")
    with pytest.raises(BrokenInvariant, match="turns of fan is not True") as found:
        watched.world.advance(10.0)
    assert found.value.invariant == "what_a_task_left_is_so"


SLUICE = """name: sluice
kinds:
  gate:
    facts: {at: [low, high]}
    verbs:
      up: {effect: motion, sets: {at: high}, takes_s: 1}
      lower: {effect: motion, sets: {at: low}, takes_s: 1}
cells:
  lock: {devices: {gate: {kind: gate, evidence: facts}}}
"""


@recipe("pass")
def let_pass(cell: Kit):  # type: ignore[no-untyped-def]
    """The gate goes up and down, which it need not do where it is there already."""
    gate = cell.device("gate")
    return work(gate.lower(), cell.repeat(work(gate.up(), gate.lower()), 2))


@pytest.mark.long
@pytest.mark.parametrize("weather", ["none", {"duplicate": 4.0, "reorder": 4.0, "ends_late": 2.0}])
def test_what_a_device_says_of_its_facts_proves_its_motions(tmp_path: Path, weather: Weather) -> None:
    assert broken(cell_of(tmp_path, SLUICE, let_pass), weather, cycles=6) is None


TANKS = """name: brewery
timing: {dwell_s: 0}
kinds:
  valve:
    facts: {open: bool}
    verbs: {turn: {effect: switch, with: {on: bool}, sets: {open: $on}, takes_s: 0.7}}
cells:
  cellar: {devices: {valve: {kind: valve, evidence: state}}}
"""


@recipe("fill")
def fill(cell: Kit):  # type: ignore[no-untyped-def]
    """The valve is opened and closed."""
    valve = cell.device("valve")
    return work(valve.turn(on=True), valve.turn(on=False))


def test_a_switch_of_which_nothing_is_said_counts_after_the_time_that_it_takes(tmp_path: Path) -> None:
    assert broken(cell_of(tmp_path, TANKS, fill)) is None


SHOPS = """name: tailors
kinds:
  iron: {verbs: {press: {effect: process, takes_s: 2}}}
shared: {eva: {kind: person}}
cells:
  coats: {devices: {eva: {shared: eva}, iron: {kind: iron, name: iron_1}}}
  hats:  {devices: {eva: {shared: eva}, iron: {kind: iron, name: iron_2}}}
"""


@recipe("fit")
def fit(cell: Kit):  # type: ignore[no-untyped-def]
    """Somebody is asked whether it fits, and what fits is pressed."""
    eva, iron = cell.devices("eva", "iron")
    seen = eva.ask("Does it fit?", ["yes", "no"], at_most_s=30)
    return work(seen, cell.choose(seen, {"yes": iron.press(), "no": []}))


def test_a_shared_person_is_stopped_with_another_cell(tmp_path: Path) -> None:
    watched = JudgedWorld(cell_of(tmp_path, SHOPS, fit))
    world = watched.world
    world.advance(1.0)
    world.request_verb(Verb.STOP, "coats")
    world.request_task("hats fit")
    world.advance(3.0)
    assert "eva is stopped" in str(world.plant.cells["hats"].not_ready)
    for verb in (Verb.CLEAR, Verb.RESET, Verb.RESUME):
        world.request_verb(verb, "coats")
        world.advance(3.0)
    assert world.plant.cells["hats"].task is not None


BENCHES = """name: bindery
timing: {dwell_s: 0}
kinds:
  clamp:
    facts: {shut: bool}
    verbs: {clamp: {effect: switch, with: {on: bool}, sets: {shut: $on}, takes_s: 0.4, holds: part}}
cells:
  ids:   {devices: {clamp: {kind: clamp, name: clamp_1}}}
  facts: {devices: {clamp: {kind: clamp, name: clamp_2, evidence: facts}}}
  state: {devices: {clamp: {kind: clamp, name: clamp_3, evidence: state}}}
"""


@recipe("bind")
def bind(cell: Kit):  # type: ignore[no-untyped-def]
    """The clamp is shut and opened, and the next task shuts it at once."""
    clamp = cell.device("clamp")
    return work(clamp.clamp(on=True), clamp.clamp(on=False))


@pytest.mark.long
def test_a_task_may_grip_in_the_step_in_which_the_one_before_has_let_go(tmp_path: Path) -> None:
    assert broken(cell_of(tmp_path, BENCHES, bind), cycles=8) is None


WASH = """<root BTCPP_format="4"><BehaviorTree ID="Wash"><Sequence>
  <ForceSuccess>
    <RetryUntilSuccessful num_attempts="2"><tap_turn on="true"/></RetryUntilSuccessful>
  </ForceSuccess>
  <Sleep msec="500"/>
</Sequence></BehaviorTree></root>"""
LAUNDRY = """name: laundry
kinds:
  tap:
    facts: {open: bool}
    verbs: {turn: {effect: switch, with: {on: bool}, sets: {open: $on}, takes_s: 1}}
cells:
  room: {devices: {tap: {kind: tap}}}
uses: [wash.xml]
"""


def test_a_step_may_be_tried_again_in_the_instant_in_which_it_failed(tmp_path: Path) -> None:
    (tmp_path / "wash.xml").write_text(WASH)
    (tmp_path / "plant.yaml").write_text(LAUNDRY)
    watched = JudgedWorld(load(tmp_path / "plant.yaml"))
    watched.world.request_task("room wash")
    watched.world.advance(0.7)
    watched.begin(Fault(kind="driver_alarm", at=0.0, target="tap", seconds=0.5))
    watched.world.advance(5.0)
    assert watched.world.plant.cells["room"].task is None


NURSERY = """name: nursery
cells:
  bench:
    devices:
      arm: {kind: arm, model: scara}
      jaw: {kind: gripper, tool_of: arm}
      press: {kind: press}
    targets:
      home: {arm: {deg: [0, 0], mm: 0}}
      tray: {arm: {deg: [30, 40], mm: 50}}
      bed:  {arm: {deg: [-30, -40], mm: 50}}
    places: {tray: {holds: 3, supply: true}, bed: {of: press}}
kinds:
  press:
    facts: {down: bool}
    verbs: {push: {effect: process, works_on: part, takes_s: 1}}
"""


@recipe("pot", ends_with={"bed": 1})
def pot(cell: Kit):  # type: ignore[no-untyped-def]
    """A pot is brought to the bed, where somebody takes it away."""
    arm, jaw = cell.devices("arm", "jaw")
    fetch = arm.visit("tray", jaw.close(width_mm=20, force_n=9))
    return work(jaw.open(), fetch, arm.visit("bed", jaw.open()), arm.home())


@recipe("rest")
def rest(cell: Kit):  # type: ignore[no-untyped-def]
    """The cell waits."""
    return cell.wait(2.0)


def test_what_a_person_puts_down_meanwhile_is_none_of_the_task(tmp_path: Path) -> None:
    watched = JudgedWorld(cell_of(tmp_path, NURSERY, rest))
    watched.world.request_task("bench rest")
    watched.world.advance(1.0)
    watched.world.request_verb(Verb.LOAD, "bench", arguments=(("place", "bed"),))
    watched.world.advance(5.0)
    assert watched.world.plant.cells["bench"].task is None


def test_nobody_knows_of_which_parts_a_person_speaks_in_the_middle_of_a_grip(tmp_path: Path) -> None:
    watched = JudgedWorld(cell_of(tmp_path, NURSERY, pot))
    watched.world.request_task("bench pot")
    assert watched.world.advance(
        30.0, lambda: getattr(watched.world.obeyed.get("jaw"), "verb", None) == "close"
    )
    watched.world.advance(0.2)
    watched.world.request_verb(Verb.UNLOAD, "bench")
    watched.world.advance(20.0)
    assert watched.world.plant.cells["bench"].task is None


LONG_WAYS = """
name: long_ways
cells:
  line:
    devices: {arm: {kind: arm, model: scara, evidence: EVIDENCE}}
    targets:
      home: {arm: {deg: [0, 0], mm: 0}}
      far:  {arm: {deg: [120, 90], mm: 50}}
"""


@recipe("turn")
def turn(cell: Kit):  # type: ignore[no-untyped-def]
    """The arm has no time for its way, and goes home as soon as it is halted."""
    arm = cell.device("arm")
    return work(cell.fallback(cell.timeout(arm.go("far"), 0.4), arm.home()), cell.wait(1.0))


@pytest.mark.sampled(3)
@pytest.mark.parametrize("evidence", ["ids", "joints", "state"])
def test_a_move_after_a_timeout_waits_until_the_arm_has_come_to_rest(tmp_path: Path, evidence: str) -> None:
    model = cell_of(tmp_path, LONG_WAYS.replace("EVIDENCE", evidence), turn)
    result = Simulation(model, 1, lambda minute: []).run(cycles=2)
    assert result.broken is None and set(result.outcomes) == {"done"}
