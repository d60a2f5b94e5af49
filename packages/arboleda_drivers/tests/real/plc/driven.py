"""A driver of a PLC with the belt of the example, at whatever a test of real peers plays; what it says."""

from __future__ import annotations

import queue
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, TypeVar

from tests.packages import ROOT
from tests.patience import PATIENCE_S

from arboleda.drivers import Driver, MotionState, Report
from arboleda.kinds.declared import Device
from arboleda.plant_file.loader import load

EXAMPLE = ROOT / "examples/plc_conveyor"
LONGEST_S = 5.0  # that a plant file may wait for an answer
D = TypeVar("D", bound=Driver)


class Heard:
    """Reports of a driver."""

    def __init__(self) -> None:
        self._reports: queue.Queue[Report] = queue.Queue()
        self.all: list[Report] = []

    def __call__(self, report: Report) -> None:
        self.all.append(report)
        self._reports.put(report)

    def until(self, fits: Callable[[Report], bool]) -> Report:
        """The first report from now on that fits; queue.Empty where none comes."""
        until = time.monotonic() + PATIENCE_S
        while not fits(report := self._reports.get(timeout=max(0.0, until - time.monotonic()))):
            pass
        return report


def belt_of(file: str) -> Device:
    (robot,) = load(EXAMPLE / file).robots.values()
    assert isinstance(robot, Device)
    return robot


def mapping(belt: Device, **changes: Any) -> Any:
    """The mapping of the example, without what a test does not play, and patient."""
    assert belt.driver is not None
    settings: Any = belt.driver.settings
    return replace(settings, **{"alive": None, "heartbeat": None, "timeout_s": LONGEST_S} | changes)


@contextmanager
def driven(made: D, belt: Device) -> Iterator[tuple[D, Heard]]:
    """The driver, started with the belt."""
    heard = Heard()
    try:
        made.start([belt], heard, time.monotonic)
        yield made, heard
    finally:
        made.stop()


def order(belt: Device, verb: str = "load", id: str = "c1", **values: Any) -> Any:
    return belt.kind.command(id=id, robot="belt", verb=verb, values=values)


def is_heard(report: Report) -> bool:
    return report.state is MotionState.STOPPED


def is_lost(report: Report) -> bool:
    return report.state is MotionState.NO_LINK
