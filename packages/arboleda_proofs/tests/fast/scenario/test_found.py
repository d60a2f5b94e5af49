"""Findings of the simulator: each bug, of the plant or of its judge, with the seed and the few faults that
showed it. `found/` has them: a plant as much of it as was needed, or an example, or one of the packaged ones.
"""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

import pytest
import yaml
from tests.lengths import sample
from tests.scenario.test_found_by_simulation import boards_that_know_no_visto as boards_that_know_no_visto
from tests.scenario.test_found_by_simulation import in_one_centre
from tests.scenario.test_found_by_simulation import rig as rig

from arboleda.kinds.arm import SetEffector
from arboleda.model.cell_states import CellState
from arboleda.model.messages import TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load
from arboleda.rig import faults
from arboleda.testing import Rig, shipped
from arboleda.wire.board import Board, Message
from arboleda_drawn.plants import loaded
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.run import Result, Simulation
from arboleda_proofs.simulator.shrink import explicit
from arboleda_proofs.testing import Witness

EXAMPLES = Path(__file__).parents[5] / "examples"
FOUND: dict[str, dict[str, Any]] = {
    what: found
    for path in sorted(Path(__file__).with_name("found").glob("*.yaml"))
    for what, found in yaml.safe_load(path.read_text("utf-8")).items()
}


def model_of(found: dict[str, Any]) -> PlantModel:
    """Its own plant, or that of its example; of the packaged ones odd seeds have the shipped plant."""
    if "plant" in found:
        return loaded(found["plant"], found.get("beside", {})).model
    if "example" in found:
        return load(EXAMPLES / found["example"] / "plant.yaml")
    if found["seed"] % 2:
        return shipped()
    with as_file(files("arboleda") / "plants" / "shared.yaml") as path:
        return load(path)


def simulated(found: dict[str, Any]) -> Result:
    befall = explicit([Fault(**row) for row in found.get("faults", ())])
    return Simulation(model_of(found), found["seed"], befall).run(seconds=found["seconds"])


@pytest.mark.sampled(20)
@pytest.mark.parametrize("found", FOUND.values(), ids=FOUND)
def test_every_invariant_holds_where_it_once_broke(found: dict[str, Any]) -> None:
    result = simulated(found)
    assert result.broken is None, str(result.broken)
    if "plant" in found:
        assert len(result.faults) == len(found.get("faults", ())), "each of them happened"
        assert result.outcomes.get("done", 0) > 0


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("evidence", "least_s", "patience_s", "drives_s"),
    [
        ("ids", 0.1, 0.05, 0.05),
        ("state", 0.3, 0.3, 0.05),
        ("joints", 0.5, 0.05, 10),
        ("joints", 0.8, 0.05, 0.05),
    ],
)
def test_the_least_times_that_check_takes_are_enough_where_nothing_goes_wrong(
    evidence: str, least_s: float, patience_s: float, drives_s: float
) -> None:
    file = f"""
        name: hasty
        timing: {{deadline_factor: 1, deadline_floor_s: {least_s}, stop_timeout_s: {patience_s}}}
        cells:
          cell_1:
            arm: {{name: arm_1, model: scara, link: mqtt, evidence: {evidence}, timeout_s: 0.05}}
            mobile: {{name: mobile_1, link: mqtt, evidence: {evidence}, timeout_s: {drives_s}}}
            home: {{deg: [0, 0], mm: 0}}
            pickup: {{deg: [0, 0.3], mm: 0}}
            paths: {{c5: [5], 4z: [5, 4]}}
            stations: {{0: {{deg: [0, 0.3], mm: 0}}, 1: {{deg: [50, 10], mm: 20}}}}
    """
    for seed in sample(range(1, 5), every=4):
        result = Simulation(loaded(yaml.safe_load(file)).model, seed, explicit(())).run(seconds=30.0)
        assert result.broken is None, str(result.broken)
        assert result.outcomes.keys() == {"done"}


@pytest.mark.long
def test_a_new_plant_is_told_nothing_but_the_last_words_before_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def hear_plant(board: Board, at: float, epoch: int) -> list[Message]:
        """Says already what the board says only later in the same step."""
        return [replace(each, piece=False) if each.piece else each for each in told(board, at, epoch)]

    told = Board.hear_plant
    monkeypatch.setattr(Board, "hear_plant", hear_plant)
    what = "a bridge that stalled seemed to tell a new plant words that its board took back in the same step"
    result = simulated(FOUND[what])
    assert str(result.broken).startswith(
        "telemetry_is_reported: arm_back is reported with what it has not said"
    )


def test_a_recovery_keeps_the_zones_that_it_takes_on_its_way_back() -> None:
    rig = Rig(in_one_centre())
    witness = Witness(rig)
    rig.wait(0.5)
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to station 7")
    rig.lost = faults.nth("ra_1/efector", 1)
    rig.submit("sis_b palletizing")
    rig.wait(60.0)
    assert rig.outcomes()["t-1000-1"].state is TaskState.FAILED
    assert rig.outcomes()["t-1000-2"].state is TaskState.DONE
    assert witness.collisions == []


@pytest.mark.usefixtures("boards_that_know_no_visto")
def test_no_task_starts_on_an_arm_that_may_hold_a_part(rig: Rig) -> None:
    """Effector on comes 3 s late while reports are lost: given up, it shows on the way home."""
    witness = Witness(rig)
    rig.submit("sis_a palletizing")
    rig.submit("sis_a palletizing")
    rig.wait_for("sis_a", "move to pick-up")
    rig.to_bridge.troubles.append(
        lambda message: (3.0,) if isinstance(message, SetEffector) and message.on else (0.0,)
    )
    rig.wait_for("sis_a", "effector on/switch")
    rig.to_plant.troubles.append(lambda message: ())
    rig.wait(1.6)
    rig.to_plant.troubles.clear()
    rig.wait(10.0)
    assert rig.outcomes()["t-1000-2"].state is TaskState.QUEUED
    assert rig.plant.cells["sis_a"].state is CellState.HELD
    assert witness.false_successes == []
