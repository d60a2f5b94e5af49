"""The press behind a PLC, whatever that speaks: it is read again and again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from contract.bench import Bench, Device
from contract.press import Order, Press, Wire, plant

from arboleda.runtime.build import App, Options, build


class PlcWire(Protocol):
    """A PLC whose program is the test."""

    port: int

    def connect(self, told: Callable[[Order], None]) -> Wire: ...
    def hush(self) -> None: ...


class PolledPress(Press):
    """Its silence is that of its PLC."""

    def __init__(self, wire: PlcWire) -> None:
        super().__init__(wire.connect)
        self._plc = wire

    def hush(self) -> None:
        super().hush()
        self._plc.hush()


def bench(made: Callable[[], PlcWire], driver: str) -> Bench:
    """The press behind a PLC of that protocol; `driver` is its mapping, with a place for the port."""

    def opened(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
        wire = made()
        app = build(plant(folder, driver % wire.port), ("orchestrator",), Options(state_dir=state))
        return app, lambda app: PolledPress(wire)

    return Bench(open=opened, asks=True)
