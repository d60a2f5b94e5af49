"""Proofs of tasks that take what another cell puts: people bring a part before they ask for one."""

from __future__ import annotations

from pathlib import Path

from tests.unit.plant_file.test_common_outputs import PLANT, rack

from arboleda_proofs.campaigns.proof.calm import Calm, calm_runs, run_findings
from arboleda_proofs.campaigns.proof.scenario import scenarios

ELSEWHERE = PLANT.replace("rack: {arm: {deg: [-60, 20]", "rack: {arm: {deg: [-30, 20]", 1)


def cleaned(folder: Path, plant: str) -> Calm:
    model = rack(folder, plant)
    (calm,) = calm_runs(model, scenarios(model, ["clean"]))
    return calm


def test_a_task_gets_a_part_where_another_cell_puts_some(tmp_path: Path) -> None:
    calm = cleaned(tmp_path, PLANT)
    assert calm.scenario.name == "wash clean (a part is brought to rack)"
    assert calm.is_sound
    assert not list(run_findings(calm)), "also when it is asked for once more"


def test_a_task_gets_none_where_no_other_cell_puts_any(tmp_path: Path) -> None:
    calm = cleaned(tmp_path, ELSEWHERE)
    assert calm.scenario.brought == ()
    assert "no part is known to be at rack" in next(run_findings(calm)).sentence
