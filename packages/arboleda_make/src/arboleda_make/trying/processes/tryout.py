"""Tryout of a draft: one task simulated, with a fault or without, and a record of it to look at."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from arboleda.model import text
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.plant_file.urdf import robot_urdf
from arboleda.views import view
from arboleda_proofs.campaigns import flight
from arboleda_proofs.campaigns.plants import Plant
from arboleda_proofs.campaigns.proof.calm import Calm, calm_run
from arboleda_proofs.campaigns.proof.forks import run_on
from arboleda_proofs.campaigns.proof.instants import Instant
from arboleda_proofs.campaigns.proof.outcome import Run, plain
from arboleda_proofs.campaigns.proof.scenario import Scenario, alone
from arboleda_proofs.campaigns.proof.single_faults import OTHER_FORMS, single_faults
from arboleda_proofs.campaigns.proof.stage import ASKED_AT_S, Stage
from arboleda_proofs.simulator.faults import KINDS, Fault
from arboleda_proofs.simulator.faults.titles import title

from .process import errand, write

RECORD, LAYOUT, RESULT = "tried.mcap", "layout.json", "result.json"
MOST_INSTANTS = 400  # to choose from


def main() -> None:
    """Run the errand of this process."""
    with errand() as given:
        model, files = given.plant()
        found = tried(model, files, given.wanted, given.folder)
        write(given.folder / LAYOUT, _layout(alone(model, found["cell"])))
        write(given.folder / RESULT, found)


def tried(model: PlantModel, files: PlantFiles, wanted: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Outcome of the `task` that is wanted, with `answers` and `faults`; its record is in `folder`."""
    order = text.parse(wanted["task"], model)
    answers = tuple(sorted(dict(wanted.get("answers", {})).items()))
    scenario = Scenario(cell=order.cell, recipe=order.recipe, task=wanted["task"], answers=answers)
    faults = [Fault(**each) for each in wanted.get("faults", ())]
    calm = calm_run(model, scenario)
    with flight.recorded(folder / RECORD, Plant(declared=model, files=files)) as flown:
        stage = Stage(model, scenario, keep=True, make_plant=flown.make_plant)
        run = _played(stage, calm, faults)
    cell = model.cell(order.cell)
    return {
        "task": scenario.name,
        "cell": cell.name,
        "outcome": plain(run.outcome),
        "why": "" if stage.last_change is None else str(stage.last_change.sentence),
        "faults": [_fault(each) for each in faults],
        "seconds": run.seconds,
        "instants": [{"at": each.at, "name": each.name} for each in calm.instants[:MOST_INSTANTS]],
        "possible": [*_possible(model, cell, calm.instants)],
    }


def _played(stage: Stage, calm: Calm, faults: Sequence[Fault]) -> Run:
    if not faults:
        return stage.play(ASKED_AT_S, lambda: None, expected={}, commands=None, lasts_s=calm.lasts_s)
    return run_on(stage, calm, *faults)


def _possible(model: PlantModel, cell: Cell, instants: Sequence[Instant]) -> Iterator[dict[str, Any]]:
    """The faults to choose from, one form of each kind on each target; they begin whenever one says."""
    first = [each for each in instants if each.level == 0][:1]
    for each in first:
        for part in single_faults(model, cell, each)[:OTHER_FORMS]:
            yield from map(_fault, part)


def _fault(fault: Fault) -> dict[str, Any]:
    """A fault as plain data, with its name and what it is in words."""
    return {
        "kind": fault.kind,
        "at": fault.at,
        "seconds": fault.seconds,
        "target": fault.target,
        "amount": fault.amount,
        "word": fault.word,
        "title": title(fault.kind, fault.word),
        "about": KINDS[fault.kind].sentence,
    }


def _layout(model: PlantModel) -> dict[str, Any]:
    """All that a page on the record needs to know of the plant."""
    layout = view.layout(model)
    robots = [each["name"] for each in layout["places"]["robots"]]
    return {"layout": layout, "urdf": {name: robot_urdf(model, name) for name in robots}}
