"""The core's ramp takes every step when the reference does."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import pytest

from arboleda.sim.stepper import Stepper

from . import core
from .scenarios import scenarios

BUILD = Path(__file__).parents[1] / "build"


def recorded() -> list[str]:
    """The trace that the vectors ask for."""
    return [
        line
        for scenario in scenarios()
        for line in (scenario["name"], *(f"{at_us} {position}" for at_us, position in scenario["rows"]))
    ]


def test_the_host_steps_when_the_reference_steps() -> None:
    assert len(recorded()) > 10_000
    assert (BUILD / "ramp.txt").read_text().splitlines() == recorded()


def test_rv32imc_steps_when_the_reference_steps() -> None:
    assert (BUILD / "ramp-rv32.txt").read_text().splitlines() == recorded()


def order(chance: Random, stepper: Stepper, ours: int) -> None:
    """One random call on both."""
    calls: dict[str, tuple[Callable[[Any], None], float]] = {
        "speed": (stepper.set_max_speed, chance.uniform(1, 5000)),
        "acceleration": (stepper.set_acceleration, chance.uniform(1, 20000)),
        "move": (stepper.move_to, chance.randint(-3000, 3000)),
        "here": (stepper.set_current_position, chance.randint(-50, 50)),
    }
    what = chance.choices(["speed", "acceleration", "move", "stop", "here"], (3, 3, 6, 2, 1))[0]
    if what == "stop":
        stepper.stop()
        core.library().arboleda_stop(ours)
        return
    theirs, value = calls[what]
    theirs(value)
    getattr(core.library(), f"arboleda_{what}")(ours, value)


@pytest.mark.parametrize("seed", range(60))
def test_any_calls_at_any_time_give_the_steps_of_the_virtual_board(seed: int) -> None:
    chance, stepper, ours = Random(seed), Stepper(), core.library().arboleda_stepper()
    now_us = chance.choice((1_000_000, 2**32 - 300_000))
    for _ in range(40):
        order(chance, stepper, ours)
        until_us = now_us + chance.randint(0, 150_000)
        while (step_us := core.library().arboleda_step(ours, now_us, until_us)) >= 0:
            assert stepper.next_step_us(now_us) == step_us
            assert stepper.run(step_us)
            now_us = step_us
        assert (stepper.next_step_us(now_us) or until_us + 1) > until_us
        assert core.library().arboleda_position(ours) == stepper.position
        now_us = until_us + 1
