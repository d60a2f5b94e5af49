"""Looks for mistakes in recipes and plant files by `arboleda check`, then by `arboleda prove`: calm runs and
single faults.

`python -m tools.tests.mutants.planted_proof`, in the project's folder, says of each of them who finds it, and
after how many runs; with names of plants, only of theirs. `--jobs N` processes share them.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from multiprocessing import Pool
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

from arboleda.model.errors import ConfigError
from arboleda.plant_check import checks
from arboleda.plant_file import loader
from arboleda_proofs.campaigns.plants import Plant
from arboleda_proofs.campaigns.proof.calm import Calm, calm_runs
from arboleda_proofs.campaigns.proof.outcome import Outcome
from arboleda_proofs.campaigns.proof.proof import Proof
from arboleda_proofs.campaigns.proof.scenario import scenarios
from arboleda_proofs.campaigns.workers import collect_rarely

from .proof_bug import PLANTS, ProofBug
from .proof_bugs import PROOF_BUGS

MOST = 600  # runs with a fault: under a minute of one core
CHECK, CALM, FAULTS = "check", "calm run", "single faults"


@dataclass(frozen=True, kw_only=True)
class Sighting:
    """Sighting of a bug: by whom, what is said of it that is not said without it, and after how many runs."""

    by: str  # CHECK, CALM or FAULTS
    words: str
    runs: int = 0


def written(folder: Path, plant: str, bug: ProofBug | None = None) -> Path:
    """The plant file of a plant, with a bug or without, written to a folder with all that it uses."""
    home = PLANTS[plant]
    files = {str(each.relative_to(home)): each.read_text() for each in home.rglob("*") if _is_read(each)}
    for name, text in (bug.edited(files) if bug else files).items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder / "plant.yaml"


def sighted(folder: Path, bug: ProofBug, most: int = MOST) -> Sighting | None:
    """The first finding in a plant with a bug that it has not without; None after `most` runs."""
    file = written(folder, bug.plant, bug)
    for by, look in LOOKS.items():
        for each in look(file, most):
            if each.words.replace(str(folder), "") not in without_bug(bug.plant, by, most):
                return each
    return None


@cache
def without_bug(plant: str, by: str, most: int) -> frozenset[str]:
    """All that is found of a plant as it is by one of those who look."""
    with TemporaryDirectory() as folder:
        sightings = LOOKS[by](written(Path(folder), plant), most)
        return frozenset(each.words.replace(folder, "") for each in sightings)


def _by_check(plant: Path, most: int) -> Iterator[Sighting]:
    try:
        model = loader.load(plant)
    except ConfigError as error:
        yield Sighting(by=CHECK, words=str(error))
        return
    yield from (Sighting(by=CHECK, words=each) for each in checks.warnings(model))


def _by_calm_runs(plant: Path, most: int) -> Iterator[Sighting]:
    model = Plant(declared=loader.load(plant)).model
    for each in calm_runs(model, scenarios(model)):
        yield from (Sighting(by=CALM, words=words) for words in _of_calm(each))


def _by_faults(plant: Path, most: int) -> Iterator[Sighting]:
    model = Plant(declared=loader.load(plant)).model
    calm = tuple(each for each in calm_runs(model, scenarios(model)) if each.is_sound)
    yield from _of_faults(Proof(model=model, calm=calm), most)


def _of_calm(calm: Calm) -> Iterator[str]:
    name, outcome = calm.scenario.name, calm.run.outcome
    if not calm.is_sound:
        yield f"{name}: {outcome.broken or outcome.words} {calm.finding}"
    if calm.again:
        yield f"{name}: once more {calm.again}"


def _of_faults(proof: Proof, most: int) -> Iterator[Sighting]:
    runs = 0
    for number, portion in enumerate(proof.portions):
        if runs >= most:
            return
        outcomes = proof.run(number).each
        runs += len(outcomes)
        recipe = proof.calm[portion.scenario].scenario.recipe
        for fault, outcome in zip(proof.faults(portion), outcomes, strict=True):
            for words in _of_outcome(outcome):
                yield Sighting(by=FAULTS, words=f"{recipe} {fault.kind} {fault.target}: {words}", runs=runs)


def _of_outcome(outcome: Outcome) -> Iterator[str]:
    if outcome.broken:
        yield f"breaks {outcome.broken[0]}"
    elif outcome.takes_too_much:
        yield "six acts do not mend it"
    elif outcome.goes_unnoticed:
        yield from (f"nobody notices {each}" for each in outcome.untrue)


LOOKS = {CHECK: _by_check, CALM: _by_calm_runs, FAULTS: _by_faults}


def _is_read(file: Path) -> bool:
    return file.suffix in (".yaml", ".py", ".urdf", ".xml")


def _row(bug: ProofBug) -> tuple[ProofBug, Sighting | None, float]:
    collect_rarely()
    began = process_time()
    with TemporaryDirectory() as folder:
        return bug, sighted(Path(folder), bug), process_time() - began


def main() -> None:
    """Say of each bug who finds it, and how many are found."""
    words = sys.argv[1:]
    jobs = int(words.pop(words.index("--jobs") + 1)) if "--jobs" in words else None
    names = {each for each in words if each != "--jobs"}
    bugs = [each for each in PROOF_BUGS if not names or each.plant in names]
    count = 0
    with Pool(jobs) as pool:
        for bug, sighting, seconds in pool.imap(_row, bugs):
            count += sighting is not None
            by = f"{sighting.by} ({sighting.runs}): {sighting.words[:150]}" if sighting else "NOT FOUND"
            print(f"{bug.plant}: {bug.about}  {by}  {seconds:.0f} s", flush=True)
    print(f"{count} of {len(bugs)} are found")


if __name__ == "__main__":
    main()
