"""Lesson 14: break a plant that runs, read what it says, and bring it back by its own advice."""

from __future__ import annotations

import time
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

from real_start import running

from arboleda.client import Conflict, Plant
from arboleda.client.answers.plant import Advice
from arboleda_class.lessons import spoken

LOOK_S = 0.1
TEXT = "bench bake shelf_1 2"
TAKE_OUT = "take_out"


def await_holding(plant: Plant) -> None:
    """Wait until the arm is told to bring the part into the oven."""
    while plant.snapshot().cells[0].step != "visit oven":
        time.sleep(LOOK_S)


def bring_back(plant: Plant) -> None:
    """Do what the plant advises, one act after the other, until the cell is at rest."""
    while (cell := plant.snapshot().cells[0]).state != "idle" or cell.advice:
        advice = next((each for each in cell.advice if not each.refusal), None)
        if advice is not None:
            print(f"  the cell is {cell.state}: {advice.said}")
            with suppress(Conflict):  # it is under way already
                act(plant, advice)
        time.sleep(1.0)


def act(plant: Plant, advice: Advice) -> None:
    """Do one thing that is advised. Where a person has to look, the oven is empty."""
    if advice.do == TAKE_OUT:
        cell, place = advice.scope.split()
        plant.operate("unload", cell, place=place)
    else:
        plant.operate(advice.do, advice.scope, by_hand=advice.by_hand)


def main() -> None:
    with TemporaryDirectory() as state, running("workshop.yaml", Path(state)) as plant:
        print(f"submit {TEXT!r}")
        task = plant.submit(TEXT)
        await_holding(plant)
        fault = plant.provoke("reboot", "loader")
        print(f"provoked at {fault.robot}: {fault.about}")
        ended = plant.wait(task.id)
        print(f"  {ended.state}: {ended.sentence}")
        bring_back(plant)
        again = plant.wait(plant.submit(TEXT).id)
        print(f"the same again: {again.state}")


if __name__ == "__main__":
    spoken(main)
