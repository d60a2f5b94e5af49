"""Common part of the benchmarks of PLC drivers: the belt of the example, and a driver as a plant uses it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Protocol

from arboleda.drivers import Driver, VerbCommand
from arboleda.kinds.declared import Device

from .reports import Reports
from .result import Aim, Figure, percentile
from .scene import Scene

AIM = Aim(most=1.5)
PATIENCE_S = 5.0


class Client(Protocol):
    """A client that gives orders and hears of the belt's speed."""

    def order(self) -> float:
        """The seconds from an order until it was known to be done."""

    def until_speed(self, speed: int) -> None: ...


class Driven:
    """The driver, as a plant uses it."""

    def __init__(self, belt: Device, driver: Driver) -> None:
        self._belt, self._driver, self._number = belt, driver, 0
        self._reports = Reports(PATIENCE_S)
        self._driver.start([belt], self._reports.hear, time.monotonic)
        self._reports.until(lambda report: report.fact("mm_s") is not None)

    def order(self) -> float:
        self._number += 1
        id = f"c{self._number}"
        command = self._belt.kind.command(id=id, robot=self._belt.name, verb="load", values={})
        assert isinstance(command, VerbCommand)
        began = time.perf_counter()
        self._driver.send(command)
        self._reports.until(lambda report: report.done == id)
        return time.perf_counter() - began

    def until_speed(self, speed: int) -> None:
        self._reports.until(lambda report: report.fact("mm_s") == speed)

    def close(self) -> None:
        self._driver.stop()


def figures(scene: Scene, times: int, clients: Sequence[Client], change: Callable[[], int]) -> list[Figure]:
    """The figures of orders and of changes of speed, made by `change`; ours and the floor take turns."""
    found = []
    for name, measure in (
        ("an order until it is done", lambda each: each.order()),
        ("a changed fact until it is known", lambda each: _known(each, change)),
    ):
        scene.say(name)
        pairs = [[1000 * measure(each) for each in clients] for _ in range(times)]
        found += [_figure(f"{name}, p{percent}", pairs, percent) for percent in (50, 99)]
    return found


def _figure(name: str, pairs: Sequence[Sequence[float]], percent: int) -> Figure:
    ours, floor = (percentile([pair[at] for pair in pairs], percent) for at in range(2))
    return Figure(name=name, unit="ms", ours=ours, floor=floor, aim=AIM if percent == 50 else None)


def _known(client: Client, change: Callable[[], int]) -> float:
    speed = change()
    began = time.perf_counter()
    client.until_speed(speed)
    return time.perf_counter() - began
