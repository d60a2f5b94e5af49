"""Plants of one lamp or one press, in files; their recipe is proved, by the command or step by step."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from arboleda.cli.main import main
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda_proofs.campaigns.plants import Plant
from arboleda_proofs.campaigns.proof.calm import Calm, calm_run
from arboleda_proofs.campaigns.proof.pairs import PairProof
from arboleda_proofs.campaigns.proof.proof import Proof
from arboleda_proofs.campaigns.proof.scenario import scenarios

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
PRESS = """
name: small
uses: [small.py]
kinds:
  press:
    facts: {ram: [up, down]}
    verbs:
      press: {effect: motion, sets: {ram: down}, takes_s: 2}
      lift: {effect: motion, sets: {ram: up}, takes_s: 1}
cells:
  bench: {devices: {press: {kind: press}}}
"""
GOOD = """
from arboleda.recipes import recipe, work


@recipe("shine", ends_with={"lamp.lit": True})
def shine(cell):
    return work(cell.device("lamp").light(on=True))
"""
Prove = Callable[..., str]


@pytest.fixture
def plant(tmp_path: Path) -> Path:
    """The plant's file, beside that of its recipe."""
    (tmp_path / "small.yaml").write_text(PLANT)
    (tmp_path / "small.py").write_text(GOOD)
    return tmp_path / "small.yaml"


@pytest.fixture
def prove(plant: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Prove:
    """Runs the command in this process, and returns what it says; `ends`: its exit status.

    What it found is in `summary`, unless the words have `--json`.
    """

    def run(*words: object, ends: int = 0) -> str:
        state = ["--state", str(plant.parent / "state"), "--jobs", "1", "--budget", "all"]
        state += [] if "--json" in words else ["--json", str(plant.parent / "out.json")]
        monkeypatch.setattr("sys.argv", ["arboleda", "prove", str(plant), *state, *map(str, words)])
        with pytest.raises(SystemExit) as ended:
            main()
        said = capsys.readouterr()
        assert int(ended.value.code or 0) == ends, said
        return said.out or said.err

    return run


def summary(plant: Path) -> dict[str, Any]:
    """The findings of the command."""
    found: dict[str, Any] = json.loads((plant.parent / "out.json").read_text())
    return found


def model_of(plant: Path) -> PlantModel:
    return Plant(declared=loader.load(plant)).model


def calm_of(plant: Path) -> tuple[PlantModel, Calm]:
    """The plant, and how its first scenario goes without a fault."""
    model = model_of(plant)
    return model, calm_run(model, next(scenarios(model)))


def pairs_of(plant: Path, *kinds: str) -> PairProof:
    model, calm = calm_of(plant)
    return PairProof(proof=Proof(model=model, calm=(calm,), kinds=kinds))


def portions(pairs: PairProof) -> Iterator[int]:
    """The portions in which there is something."""
    return (number for number in pairs.numbers() if pairs.count(number))
