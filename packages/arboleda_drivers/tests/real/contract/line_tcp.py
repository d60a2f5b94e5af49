"""The press behind the driver of the example, `examples/own_driver`."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from arboleda.runtime.build import App
from arboleda.testing.drivers import Bench, Device

from .press import EXAMPLE, Order, Press, Words, app_of


def _open(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
    made: list[Callable[[Order], None]] = []
    server = controller().Line(lambda order: made[0](line_of(order)))
    app = app_of(folder, state, f"{{line_tcp: {{host: 127.0.0.1, port: {server.port}}}}}")

    def connect(told: Callable[[Order], None]) -> LineWire:
        made.append(told)
        return LineWire(server)

    return app, lambda app: Press(connect)


class LineWire:
    """The controller of the example, played by hand."""

    def __init__(self, server: Any) -> None:
        self._server = server

    def say(self, words: Words) -> None:
        said = {"state": words.state, "boot": words.boot, "facts": {"guard": words.guard}}
        ids = {name: getattr(words, name) for name in ("accepted", "done", "rejected", "failed", "answered")}
        self._server.say(said | {name: id for name, id in ids.items() if id is not None})

    def vanish(self) -> None:
        self._server.hang_up()

    def come_back(self) -> None:
        """It is always welcome."""

    def close(self) -> None:
        self._server.close()


def line_of(order: dict[str, Any]) -> Order:
    """An order as a line has it."""
    return Order(ref=order["id"], word=order.get("do") or order["stop"])


def controller() -> ModuleType:
    """The virtual controller of the example."""
    spec = importlib.util.spec_from_file_location("own_controller", EXAMPLE / "controller.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


BENCH = Bench(open=_open, asks=True)
