"""The plant as a server of OPC UA, for clients of asyncua and node-opcua; nobody can change anything."""

from __future__ import annotations

import asyncio
import json
import logging
import os
import signal
import socket
import subprocess
import time
from collections.abc import Awaitable, Callable, Coroutine, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from asyncua import Client, Node, ua
from packages.arboleda_drivers.tests.real.opcua.test_opcua_node import PACKAGES
from packages.arboleda_trees.tests.real.test_groot2 import children
from tests.patience import PATIENCE_S
from tests.shared import need_tool

from arboleda.model.plant_model import OpcUaView
from arboleda.oee.figures import Oee
from arboleda.runtime.build import Options, build
from arboleda.testing import shipped
from arboleda_fleet.opcua_view.part import OpcUaViewOptions, OpcUaViewPart

pytestmark = [pytest.mark.system, pytest.mark.requires("asyncua")]

CLIENT = Path(__file__).with_name("opcua_node_client.js")
CELL = "acme/lima/plant/line"
STATE = f"{CELL}/Status/StateCurrent"
OEE = Oee(
    cell="line",
    since_s=0.0,
    until_s=1.0,
    planned_s=1.0,
    worked_s=1.0,
    done=1,
    failed=0,
    timed=1,
    availability=0.5,
    performance=1.0,
    quality=1.0,
    oee=0.5,
    missing=None,
)


def snapshot(state: str, **changes: Any) -> dict[str, Any]:
    """One of a cell with a device, in that state."""
    device = {"name": "belt", "role": "belt", "kind": "belt", "holds": None, "position": None, "asked": False}
    row = {"name": "belt", "online": True, "state": 1, "holding": None, "question": None}
    cell = {
        "name": "line",
        "state": state,
        "task": {"id": "t1", "text": "line 200"},
        "step": "belt load",
        "queue": [],
        "paused": False,
        "waiting_for": None,
        "not_ready": None,
        "blocked_by": None,
        "held_by": "the part fell" if state == "held" else None,
        "teaching": None,
        "devices": [device],
        "places": [{"name": "tray", "parts": 3}],
    }
    return {"cells": [cell | changes], "robots": [row], "tasks": []}


@pytest.fixture
def others() -> frozenset[int]:
    """Processes that this one had before the part: the database of other tests is one."""
    return frozenset(children())


@pytest.fixture
def part(free_port: int, others: frozenset[int]) -> Iterator[OpcUaViewPart]:
    """The part, and its server running, with an idle cell."""
    options = OpcUaViewOptions(host="127.0.0.1", port=free_port, plant="plant", folders=("acme", "lima"))
    made = OpcUaViewPart(options, lambda: [OEE])
    made.start()
    made.saw(snapshot("idle"))
    try:
        yield made
    finally:
        made.stop()


async def nothing(_: Client) -> None:
    """Only wait until it is there."""


def client(port: int) -> Client:
    return Client(f"opc.tcp://127.0.0.1:{port}/")


def seen(port: int, act: Callable[[Client], Coroutine[Any, Any, Any]]) -> Any:
    """The result of a client, once the server listens and shows the cell."""

    async def run() -> Any:
        give_up = time.monotonic() + PATIENCE_S
        while True:
            try:
                async with client(port) as one:
                    await until(one, STATE, lambda value: value is not None)
                    return await act(one)
            except OSError:
                assert time.monotonic() < give_up
                await asyncio.sleep(0.05)

    return asyncio.run(run())


def node(one: Client, path: str) -> Node:
    return one.get_node(f"ns=2;s={path}")


async def read(one: Client, path: str) -> Any:
    """The value of a variable; None where it is not there yet."""
    found = await node(one, path).read_data_value(raise_on_bad_status=False)
    return None if found.Value is None else found.Value.Value


async def until(one: Client, path: str, fits: Callable[[Any], bool]) -> Any:
    give_up = time.monotonic() + PATIENCE_S
    while not fits(value := await read(one, path)):
        assert time.monotonic() < give_up, value
        await asyncio.sleep(0.02)
    return value


def test_a_client_browses_down_to_the_cell_and_hears_of_changes(part: OpcUaViewPart, free_port: int) -> None:
    class Heard:
        def __init__(self) -> None:
            self.values: asyncio.Queue[Any] = asyncio.Queue()

        def datachange_notification(self, node: object, value: object, data: object) -> None:
            self.values.put_nowait(value)

    async def act(one: Client) -> None:
        at: Node = one.nodes.objects
        for name in [*CELL.split("/"), "Status", "StateCurrent"]:
            at = await at.get_child(f"2:{name}")
        heard = Heard()
        watched = await one.create_subscription(20, heard)
        await watched.subscribe_data_change(at)
        assert await heard.values.get() == 4
        part.saw(snapshot("held"))
        assert await asyncio.wait_for(heard.values.get(), PATIENCE_S) == 11
        assert await until(one, f"{CELL}/Admin/Alarm/Trigger", bool)
        assert await read(one, f"{CELL}/Admin/Alarm/Message") == "the part fell"
        assert await until(one, f"{CELL}/Places/tray/Parts", lambda value: value is not None) == 3
        part.saw(snapshot("idle", places=[]))
        await until(one, f"{CELL}/Places/tray/Parts", lambda value: value is None)

    seen(free_port, act)
    assert part.notes == [f"OPC UA: opc.tcp://127.0.0.1:{free_port}, read only"]


def value(one: Client, path: str, attribute: ua.AttributeIds, given: Any) -> Awaitable[Any]:
    return node(one, path).write_attribute(attribute, ua.DataValue(given))


def call(one: Client, on: str, method: str, *given: Any) -> Awaitable[Any]:
    return one.get_node(on).call_method(ua.NodeId.from_string(method), *given)


TRIES: dict[str, Callable[[Client], Awaitable[Any]]] = {
    "the value of a variable": lambda one: value(
        one, STATE, ua.AttributeIds.Value, ua.Variant(6, ua.VariantType.Int32)
    ),
    "the name of a variable": lambda one: value(
        one, STATE, ua.AttributeIds.DisplayName, ua.Variant(ua.LocalizedText("x"))
    ),
    "the rights of a variable": lambda one: value(
        one, STATE, ua.AttributeIds.AccessLevel, ua.Variant(3, ua.VariantType.Byte)
    ),
    "the value of a node that every server has": lambda one: one.get_node("i=2255").write_value(["x"]),
    "a new variable": lambda one: one.nodes.objects.add_variable("ns=2;s=x", "x", 1),
    "a new method": lambda one: one.nodes.objects.add_method(
        ua.NodeId("m", 2), ua.QualifiedName("m", 2), lambda parent: [], [], []
    ),
    "a variable less": lambda one: one.delete_nodes([node(one, STATE)]),
    "a new reference": lambda one: one.nodes.objects.add_reference(node(one, STATE), ua.ObjectIds.Organizes),
    "GetMonitoredItems": lambda one: call(one, "i=2253", "i=11492", ua.Variant(1, ua.VariantType.UInt32)),
    "ResendData": lambda one: call(one, "i=2253", "i=12873", ua.Variant(1, ua.VariantType.UInt32)),
    "RequestServerStateChange": lambda one: call(one, "i=2253", "i=12886"),
    "ConditionRefresh": lambda one: call(one, "i=2782", "i=3875", ua.Variant(1, ua.VariantType.UInt32)),
    "a registration": lambda one: one.uaclient.register_server(
        ua.RegisteredServer(
            ServerUri="urn:x", ServerNames=[ua.LocalizedText("x")], DiscoveryUrls=["opc.tcp://x:1"]
        )
    ),
}


def test_nobody_can_change_anything(part: OpcUaViewPart, free_port: int) -> None:
    async def act(one: Client) -> None:
        for what, attempt in TRIES.items():
            try:
                await attempt(one)
            except ua.UaStatusCodeError as error:
                assert error.code == ua.StatusCodes.BadUserAccessDenied, f"{what}: {error}"
            else:
                pytest.fail(f"{what} was taken")
        assert await read(one, STATE) == 4
        assert await node(one, STATE).read_attribute(ua.AttributeIds.UserAccessLevel) is not None
        methods = await node(one, CELL).get_children(nodeclassmask=ua.NodeClass.Method)
        assert methods == []
        admin = client(free_port)
        admin.set_user("admin")
        admin.set_password("admin")
        with pytest.raises(ua.UaStatusCodeError):
            await admin.connect()

    seen(free_port, act)


def test_node_opcua_browses_watches_and_is_refused(
    part: OpcUaViewPart, free_port: int, tmp_path: Path
) -> None:
    program = need_tool("node")
    if not (PACKAGES / "node-opcua-client").is_dir():
        pytest.skip("node-opcua is not installed: make test-tools")

    seen(free_port, nothing)
    url, path, tag = f"opc.tcp://127.0.0.1:{free_port}", f"ns=2;s={CELL}", f"ns=2;s={STATE}"
    given = [program, str(CLIENT), str(PACKAGES), str(tmp_path), url, path, tag]
    done = subprocess.run(given, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    said = json.loads(next(line for line in done.stdout.splitlines() if line.startswith("{")))
    found = said["found"]
    assert (found["Status/StateCurrent"], found["Status/UnitModeCurrent"]) == (4, 1)
    assert (found["Task/Text"], found["Task/Step"]) == ("line 200", "belt load")
    assert (found["Devices/belt/Online"], found["Devices/belt/State"]) == (True, "moving")
    assert found["Oee/OEE"] == 0.5
    assert (said["write"], said["call"]) == ("BadUserAccessDenied", "BadUserAccessDenied")
    assert said["watched"] == 4


def test_bytes_that_are_none_of_opc_ua_end_a_connection_and_nothing_else(
    part: OpcUaViewPart, free_port: int
) -> None:
    seen(free_port, nothing)
    for noise in (b"GET / HTTP/1.1\r\n\r\n", os.urandom(4096), b"OPNF\xff\xff\xff\x7f" + bytes(64), b"MSGF"):
        with socket.create_connection(("127.0.0.1", free_port)) as one:
            one.sendall(noise)
    seen(free_port, nothing)


def test_a_process_that_dies_takes_nothing_with_it(
    part: OpcUaViewPart, others: frozenset[int], free_port: int, caplog: pytest.LogCaptureFixture
) -> None:
    seen(free_port, nothing)
    for pid in set(children()) - others:
        os.kill(pid, signal.SIGKILL)
    give_up, number = time.monotonic() + PATIENCE_S, 0
    while "what shows the plant over OPC UA has ended; the plant goes on without it" not in caplog.text:
        assert time.monotonic() < give_up
        part.saw(snapshot("execute", step=f"step {(number := number + 1)}"))
        time.sleep(0.02)


def test_a_port_that_is_taken_does_not_keep_a_plant_from_its_start(
    free_port: int, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.ERROR)
    model = replace(shipped("sis_a"), opcua_view=OpcUaView(port=free_port))
    with socket.create_server(("127.0.0.1", free_port)):
        app = build(model, {"orchestrator"}, Options(state_dir=tmp_path / "state"))
        app.start()
        try:
            assert f"OPC UA: opc.tcp://127.0.0.1:{free_port}, read only" in app.notes
            give_up = time.monotonic() + PATIENCE_S
            while f"cannot listen on 127.0.0.1, port {free_port}" not in caplog.text:
                assert time.monotonic() < give_up
                time.sleep(0.02)
        finally:
            app.stop()


def test_a_plant_shows_itself_where_its_file_says_so(free_port: int, tmp_path: Path) -> None:
    model = replace(shipped("sis_a"), opcua_view=OpcUaView(port=free_port, isa95=("acme",)))
    app = build(model, {"orchestrator"}, Options(state_dir=tmp_path / "state"))
    app.start()
    try:

        async def run() -> Any:
            give_up = time.monotonic() + PATIENCE_S
            while True:
                try:
                    async with client(free_port) as one:
                        at = f"acme/{model.name}/sis_a/Status/UnitModeCurrent"
                        return await until(one, at, lambda value: value is not None)
                except OSError:
                    assert time.monotonic() < give_up
                    await asyncio.sleep(0.05)

        assert asyncio.run(run()) == 1
    finally:
        app.stop()
