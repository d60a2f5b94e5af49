"""What a loop drives in its tests: a machine that answers each event with itself, and a clock that stands."""

from __future__ import annotations

import pytest

from arboleda.runtime.loop import Loop, StepInFlight


class Echo:
    """Answers each event with itself; `alarm` is its next deadline, which it answers once."""

    def __init__(self) -> None:
        self.steps: list[tuple[float, tuple]] = []
        self.alarm: float | None = None

    @property
    def next_deadline(self) -> float | None:
        return self.alarm

    def step(self, now, events):
        self.steps.append((now, tuple(events)))
        rings = self.alarm is not None and now >= self.alarm
        if rings:
            self.alarm = None
        if "crash" in events:
            raise ZeroDivisionError("by design")
        return [*events, *(["ring"] if rings else [])]


class Clock:
    """Stands still until it is moved; counts who looks."""

    def __init__(self) -> None:
        self.now = 10.0
        self.looks = 0

    def __call__(self) -> float:
        self.looks += 1
        return self.now


@pytest.fixture
def machine():
    return Echo()


@pytest.fixture
def clock():
    return Clock()


def read(loop: Loop, found: list) -> None:
    try:
        found.append(loop.read_handed_on(lambda machine: len(machine.steps), within_s=1.0))
    except StepInFlight:
        found.append("under way")
