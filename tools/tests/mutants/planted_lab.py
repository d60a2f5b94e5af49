"""Looks for the bugs of the laboratory: by `arboleda check`, then by `arboleda simulate`, seed by seed.

`python -m tools.tests.mutants.planted_lab`, in the project's folder, says of each of them who finds it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from multiprocessing import Pool
from pathlib import Path
from tempfile import TemporaryDirectory

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_check import checks
from arboleda.plant_file import loader
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.run import Result, Simulation

from .lab_bug import PLANT, RECIPES, LabBug
from .lab_bugs import LAB_BUGS

LAB = Path(__file__).parent / "lab"
LEVELS, SEEDS, CYCLES = ("none", "normal"), range(1, 21), 4


@dataclass(frozen=True, kw_only=True)
class Sighting:
    """Sighting of a bug: by whom, and what was said."""

    by: str  # check, or the level of faults and the seed
    said: str


def written(folder: Path, bug: LabBug | None = None) -> Path:
    """The plant file of the laboratory with a bug, written to a folder."""
    files = {name: (LAB / name).read_text() for name in (RECIPES, PLANT)}
    for name, text in (bug.edited(files) if bug else files).items():
        (folder / name).write_text(text)
    return folder / PLANT


def sighted(plant: Path, seeds: Iterable[int] = SEEDS) -> Sighting | None:
    """The first finding in a plant: of `check`, or of a seed without faults, or with them."""
    try:
        model = loader.load(plant)
    except ConfigError as error:
        return Sighting(by="check", said=str(error))
    if warnings := checks.warnings(model):
        return Sighting(by="check", said=warnings[0])
    sightings = (found for level in LEVELS for found in _simulated(model, level, seeds))
    return next(sightings, None)


def _simulated(model: PlantModel, level: str, seeds: Iterable[int]) -> Iterator[Sighting]:
    for seed in seeds:
        said = _said_of(_run(model, level, seed))
        if said:
            yield Sighting(by=f"{level}, seed {seed}", said=said)


def _run(model: PlantModel, level: str, seed: int) -> Result:
    return Simulation(model, seed, Climate.draw(model, seed, level).faults).run(cycles=CYCLES)


def _said_of(result: Result) -> str:
    if result.broken is not None:
        return f"{result.broken.invariant}: {result.broken}"
    finding = next(iter(result.findings), None)
    return "" if finding is None else f"{finding.kind.value}: {finding.step}: {finding.sentence}"


def _row(number: int) -> tuple[str, Sighting | None]:
    with TemporaryDirectory() as folder:
        return LAB_BUGS[number].about, sighted(written(Path(folder), LAB_BUGS[number]))


def main() -> None:
    """Say of each bug who finds it, and how many are found."""
    found = 0
    with Pool() as pool:
        for about, sighting in pool.imap_unordered(_row, range(len(LAB_BUGS))):
            found += sighting is not None
            print(f"{about}  {'NOT FOUND' if sighting is None else sighting.by}", flush=True)
    print(f"{found} of {len(LAB_BUGS)} are found")


if __name__ == "__main__":
    main()
