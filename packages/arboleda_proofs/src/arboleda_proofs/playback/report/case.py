"""A test with the `sim` fixture that fails as a recorded task did."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from arboleda.model.plant_model import PlantModel
from arboleda_proofs.playback.cause import Cause
from arboleda_proofs.playback.incident import Incident
from arboleda_proofs.simulator.faults import KINDS, Fault
from arboleda_proofs.simulator.faults.kind import NONE

from ..case.faults import faults_behind, faults_of

BEGIN_S = 2.0  # by then the simulated boards are heard
SECONDS = 120.0


def case_of(incident: Incident, cause: Cause, model: PlantModel, plant_file: str) -> str:
    """The file of the test: the same task, and the same troubles of devices at the same times after it."""
    lines = [f"    sim.run({BEGIN_S:g})", f'    task = sim.submit("{_text(incident)}")']
    lines += _faults(incident, cause, model)
    end = incident.ended_at or math.inf
    acts = [(at - incident.began_at, word) for at, word in incident.acts if incident.began_at <= at <= end]
    passed = 0.0
    for after, word in acts:
        verb, _, scope = word.partition(" ")
        lines += [f"    sim.run({max(0.0, after - passed):.3f})", f'    sim.operate("{verb}", "{scope}")']
        passed = after
    lines.append(f"    sim.run(until=lambda: task.ended, at_most={SECONDS:g})")
    lines.append('    assert task.state == "done", task')
    head = f'"""{incident.text}: failed; {cause.sentence}."""\n\n\n'
    name = "".join(letter if letter.isalnum() else "_" for letter in incident.cell)
    plant = f'    sim.plant("{plant_file}")\n' if plant_file else ""
    return f"{head}def test_what_failed_in_{name}(sim):\n{plant}" + "\n".join(lines) + "\n"


def _text(incident: Incident) -> str:
    return incident.text.replace("\\", "").replace('"', "")


def _faults(incident: Incident, cause: Cause, model: PlantModel) -> Iterator[str]:
    """The faults of the cell's devices, and those that are the cause of the failure, as lines of the test."""
    end = incident.failed_at or math.inf
    mine = [each for each in incident.troubles if _concerns(incident, each.robot, model)]
    began = [each for each in mine if incident.began_at <= each.at <= end]
    for fault in _once(faults_of(began, model), faults_behind(incident, cause, model)):
        yield _line(fault, max(0.0, fault.at - incident.began_at))


def _concerns(incident: Incident, robot: str, model: PlantModel) -> bool:
    cells = [cell for cell in model.cells if cell.name == incident.cell]
    return any(each.name == robot for cell in cells for each in cell.robots)


def _once(*found: Iterable[Fault]) -> list[Fault]:
    return list(dict.fromkeys(fault for faults in found for fault in faults))


def _line(fault: Fault, after: float) -> str:
    words = [f'"{fault.kind}"', f'"{fault.target}"', f"at={after:.3f}"]
    if 0 < fault.seconds < math.inf:
        words.append(f"seconds={fault.seconds:.3f}")
    if KINDS[fault.kind].amount != NONE:
        words.append(f"amount={fault.amount:.3f}")
    if fault.word:
        words.append(f'word="{fault.word}"')
    return f"    sim.fault({', '.join(words)})"
