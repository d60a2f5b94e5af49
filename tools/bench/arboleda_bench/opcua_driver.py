"""A command to a PLC over the driver opcua until its end is reported, against a bare client of asyncua.

The PLC takes an order and echoes it as done before its method returns, in a server of asyncua in a thread of
this process. Ours is `send` of the driver until its report of done, with its loop, its subscription and the
mapping between; the floor calls the same method and reads the same variables with asyncua's `Client` itself.
In turns, over one server. The second row is a fact that changes by itself: both then wait for a subscription.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.kinds.declared import Device
from arboleda.plant_file.loader import load
from arboleda_drivers.opcua.adapter import OpcUa
from arboleda_drivers.opcua.machine import OpcUaDevice
from arboleda_drivers.opcua.server import OpcUaServer
from arboleda_drivers.opcua.settings import Settings
from arboleda_drivers.opcua.virtual.program import BeltProgram

from .plc_driver import PATIENCE_S, Driven, figures
from .result import Result
from .scene import Scene

EXAMPLE = Path(__file__).parents[3] / "examples/plc_conveyor/opcua.yaml"
PUBLISH_S = 0.01


class Echo:
    """A PLC that has done each order as soon as it gets it."""

    variables = BeltProgram.variables
    methods = BeltProgram.methods

    def __init__(self) -> None:
        self.shown: dict[str, object] = dict.fromkeys(self.variables, 0)

    def show(self) -> Mapping[str, object]:
        return self.shown

    def call(self, method: str, given: Sequence[object]) -> str | None:
        self.shown = self.shown | dict.fromkeys(("accepted", "done"), given[-1])
        return None

    def beat(self, value: object) -> None:
        """Take a beat of a client, without watching for missing ones."""

    def is_mute(self) -> bool:
        return False

    def change(self) -> int:
        """Set another speed, and return it."""
        speed = (int(str(self.shown["mm_s"])) + 1) % 60000
        self.shown = self.shown | {"mm_s": speed}
        return speed


def run(scene: Scene) -> Result:
    try:
        import asyncua  # noqa: F401
    except ImportError as error:
        raise ArboledaError("asyncua is not installed: pip install 'arboleda[opcua]'") from error
    times = 100 if scene.quick else 1000
    scene.say("starting")
    (belt,) = load(EXAMPLE).robots.values()
    assert isinstance(belt, Device) and belt.driver is not None and isinstance(belt.driver.settings, Settings)
    echo = Echo()
    server = OpcUaServer(echo)
    url = f"opc.tcp://127.0.0.1:{server.start()}"
    given = belt.driver.settings
    settings = replace(given, url=url, publish_s=PUBLISH_S, alive=None, heartbeat=None, boot=None)
    ours, floor = Driven(belt, OpcUa(settings)), Bare(belt, settings)
    try:
        found = figures(scene, times, (ours, floor), echo.change)
    finally:
        ours.close()
        floor.close()
        server.stop()
    where = "over one server of asyncua in this process"
    note = f"{times} of each in turns, {where}; both are told of changes {PUBLISH_S * 1000:g} ms apart"
    return Result(figures=found, notes=(note,))


class Bare:
    """Bare client: the code that one writes with asyncua alone: call, read, compare; subscribe and wait."""

    def __init__(self, belt: Device, settings: Settings) -> None:
        self._nodes = OpcUaDevice(belt, settings).places
        self._loop = asyncio.new_event_loop()
        self._values: asyncio.Queue[object] = asyncio.Queue()
        self._number = 30000
        self._loop.run_until_complete(self._open(settings))

    def order(self) -> float:
        self._number += 1
        began = time.perf_counter()
        self._loop.run_until_complete(self._order())
        return time.perf_counter() - began

    def until_speed(self, speed: int) -> None:
        self._loop.run_until_complete(self._until(speed))

    def close(self) -> None:
        self._loop.run_until_complete(self._client.disconnect())
        self._loop.close()

    def datachange_notification(self, node: object, value: object, data: object) -> None:
        self._values.put_nowait(value)

    async def _open(self, settings: Settings) -> None:
        from asyncua import Client

        self._client = Client(settings.url)
        await self._client.connect()
        self._read = [self._client.get_node(node) for node in self._nodes]
        subscription: Any = await self._client.create_subscription(1000 * PUBLISH_S, self)
        await subscription.subscribe_data_change(self._client.get_node("ns=2;s=mm_s"))

    async def _order(self) -> None:
        from asyncua import ua

        number = ua.Variant(self._number, ua.VariantType.UInt16)
        await self._client.get_node("ns=2;s=Device").call_method(ua.NodeId.from_string("ns=2;s=Load"), number)
        done = self._nodes.index("ns=2;s=done")
        while (await self._client.read_values(self._read))[done] != self._number:
            pass

    async def _until(self, speed: int) -> None:
        while await asyncio.wait_for(self._values.get(), PATIENCE_S) != speed:
            pass
