"""A test with the `sim` fixture that fails as a recorded task did."""

from __future__ import annotations

import math

from arboleda.model.plant_model import PlantModel
from arboleda.recorder.cause import Cause
from arboleda.recorder.incident import Incident
from arboleda.recorder.troubles import ALARM, BOOT, BRIDGE, Trouble

BEGIN_S = 2.0  # by then the simulated boards are heard
SECONDS = 120.0
OF_PARTS = {"no_part": "no_part", "not_gripped": "no_grip"}


def case_of(incident: Incident, cause: Cause, model: PlantModel, plant_file: str) -> str:
    """The file of the test: the same task, and at the same times after it what befell the devices."""
    lines = [f"    sim.run({BEGIN_S:g})", f'    task = sim.submit("{_text(incident)}")']
    lines += _faults(incident, cause, model)
    end = incident.ended_at or math.inf
    acts = [(at - incident.asked_at, word) for at, word in incident.acts if incident.asked_at <= at <= end]
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


def _faults(incident: Incident, cause: Cause, model: PlantModel) -> list[str]:
    """What befell the devices of the cell, as faults of the simulator."""
    cell = next((each for each in model.cells if each.name == incident.cell), None)
    mine = {robot.name: robot.mqtt for robot in cell.robots} if cell is not None else {}
    end = incident.failed_at or math.inf
    found = [
        _fault(trouble, mine[trouble.robot], trouble.at - incident.asked_at)
        for trouble in incident.troubles
        if trouble.robot in mine and incident.asked_at <= trouble.at <= end
    ]
    if cause.robot in mine and cause.kind in OF_PARTS:
        found.append(f'    sim.fault("{OF_PARTS[cause.kind]}", "{mine[cause.robot]}")')
    failed_after = end - incident.asked_at
    if cause.robot in mine and cause.kind == "part_lost":
        found.append(f'    sim.fault("lost_part", "{mine[cause.robot]}", at={failed_after - 0.2:.3f})')
    if cause.robot in mine and cause.kind == "unheard":
        sent = incident.evidence.last
        at = max(0.0, (sent.at if sent else end) - incident.asked_at - 0.05)
        found.append(f'    sim.fault("partition", "{mine[cause.robot]}", at={at:.3f}, word="down, lost")')
    if cause.robot in mine and cause.kind == "switch":
        found.append(f'    sim.fault("stuck_effector", "{mine[cause.robot]}")')
    return list(dict.fromkeys(found))


def _fault(trouble: Trouble, board: str, after: float) -> str:
    at = f"at={max(0.0, after):.3f}"
    lasts = "" if trouble.seconds == math.inf else f", seconds={trouble.seconds:.3f}"
    if trouble.kind == BRIDGE:
        return f'    sim.fault("bridge_restart", {at}{lasts})'
    if trouble.kind == ALARM:
        return f'    sim.fault("driver_alarm", "{board}", {at}{lasts})'
    if trouble.kind == BOOT or trouble.cut:
        told_s = (trouble.lost_at or trouble.ends) - trouble.at if trouble.cut else 60.0
        return f'    sim.fault("brown_out", "{board}", {at}{lasts}, amount={told_s:.3f})'
    return f'    sim.fault("mute", "{board}", {at}{lasts})'
