"""`arboleda prove` on a lamp: what it finds, what it keeps, and the tests that it writes."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda.campaigns.plants import Plant
from arboleda.campaigns.proof.calm import calm_run
from arboleda.campaigns.proof.forks import CAN_FORK, run_all
from arboleda.campaigns.proof.proof import Proof
from arboleda.campaigns.proof.scenario import scenarios
from arboleda.cli.main import main
from arboleda.plant_file import loader

PLANT = """
name: small
uses: [small.py]
kinds:
  lamp:
    facts: {lit: bool}
    verbs:
      light: {effect: switch, with: {on: bool}, sets: {lit: $on}}
      test: {effect: query, answers: [good, bad], takes_s: 1}
cells:
  bench: {devices: {lamp: {kind: lamp}}}
"""
GOOD = """
from arboleda.recipes import recipe, work


@recipe("shine", ends_with={"lamp.lit": True})
def shine(cell):
    return work(cell.device("lamp").light(on=True))
"""
Prove = Callable[..., int]


@pytest.fixture
def plant(tmp_path: Path) -> Path:
    (tmp_path / "small.yaml").write_text(PLANT)
    (tmp_path / "small.py").write_text(GOOD)
    return tmp_path / "small.yaml"


@pytest.fixture
def prove(plant: Path, monkeypatch: pytest.MonkeyPatch) -> Prove:
    """Runs the command in this process; returns its exit status."""

    def run(*words: str) -> int:
        state = ["--state", str(plant.parent / "state"), "--jobs", "1", "--budget", "all"]
        monkeypatch.setattr("sys.argv", ["arboleda", "prove", str(plant), *state, *words])
        with pytest.raises(SystemExit) as ended:
            main()
        return int(ended.value.code or 0)

    return run


def summary(plant: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((plant.parent / "out.json").read_text())
    return found


@pytest.mark.skipif(not CAN_FORK, reason="this system cannot fork")
def test_forks_do_the_same_as_runs_from_the_beginning(plant: Path) -> None:
    model = Plant(declared=loader.load(plant)).model
    calm = calm_run(model, next(scenarios(model)))
    proof = Proof(model=model, calm=(calm,), kinds=("brown_out", "partition", "crash_in_step"))
    faults = proof.faults(proof.portions[3])
    forked = run_all(proof.model, calm, faults, lambda: None, forks=True)
    assert faults and forked == run_all(proof.model, calm, faults, lambda: None, forks=False)


def test_any_number_of_processes_gives_the_same(plant: Path, prove: Prove) -> None:
    out = str(plant.parent / "out.json")
    digests = []
    for jobs in ("1", "2"):
        prove("--fault", "reboot", "--anew", "--jobs", jobs, "--json", out)
        digests.append(summary(plant)["digests"])
    assert digests[0] == digests[1]
    assert len(digests[0]) == 10
