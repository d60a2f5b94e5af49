"""The recorded traces of `wire_vectors/stepper`, to the microsecond."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from arboleda.sim.stepper import Stepper

VECTORS = sorted((Path(__file__).parents[3] / "wire_vectors" / "stepper").glob("*.json"))
COMMANDS = {
    "setAcceleration": Stepper.set_acceleration,
    "setMaxSpeed": Stepper.set_max_speed,
    "moveTo": Stepper.move_to,
    "stop": Stepper.stop,
    "setCurrentPosition": Stepper.set_current_position,
}


def first_poll(time_us: int, scenario: dict) -> int:
    """The time of the first poll that is not earlier than `time_us`."""
    start, length = scenario["gap_us"] or (0, 0)
    if start <= time_us < start + length:
        time_us = start + length
    return -(-time_us // scenario["poll_us"]) * scenario["poll_us"]


def trace(scenario: dict) -> list[list[int]]:
    """The scenario's rows as the stepper makes them, jumping from one poll that matters to the next."""
    stepper, boot = Stepper(), scenario["boot_us"]
    commands, rows, poll = list(scenario["commands"]), [], 0
    while True:
        while commands and commands[0][0] <= poll:
            _, name, *argument = commands.pop(0)
            COMMANDS[name](stepper, *argument)
        if stepper.run(boot + poll):
            rows.append([poll, stepper.position])
        step = stepper.next_step_us(boot + poll + 1)
        times = [command[0] for command in commands[:1]] + ([step - boot] if step is not None else [])
        if not times:
            return rows
        poll = first_poll(max(min(times), poll + 1), scenario)


def test_all_vectors_are_here():
    assert len(VECTORS) == 17


@pytest.mark.sampled(2)
@pytest.mark.parametrize("path", VECTORS, ids=lambda path: path.stem)
def test_steps_when_the_reference_steps(path):
    scenario = json.loads(path.read_text(encoding="utf-8"))
    assert trace(scenario) == scenario["rows"]


def test_clock_wrap_changes_nothing():
    path = next(path for path in VECTORS if path.stem == "micros_wrap_d1000")
    scenario = json.loads(path.read_text(encoding="utf-8"))
    assert trace(scenario) == trace({**scenario, "boot_us": 10_000_000})
