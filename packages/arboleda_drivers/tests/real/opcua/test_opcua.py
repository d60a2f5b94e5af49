"""The driver opcua against a plain server of asyncua in a process of its own, which knows nothing of it."""

from __future__ import annotations

import asyncio
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import IO, Any, ClassVar

import asyncua
import pytest
from asyncua import ua
from tests.patience import PATIENCE_S
from tests.shared import need_tool

from arboleda.drivers import NotSent, Stop, StopMode
from arboleda.kinds.declared import Device
from arboleda_drivers.opcua.adapter import OpcUa
from arboleda_drivers.opcua.keys import Sequence, Verb
from arboleda_drivers.opcua.nodes import Order, Write
from arboleda_drivers.opcua.settings import Settings

from ..plc.driven import Heard, belt_of, driven, is_heard, is_lost, mapping, order
from ..plc.pulled import pulled, sent_over_a_pulled_cable

pytestmark = [pytest.mark.system, pytest.mark.requires("asyncua")]

PEER = Path(__file__).parent / "opcua_peer.py"
SPOILT = ("null", "list", "bad", "uncertain")


@pytest.fixture(scope="module")
def belt() -> Device:
    return belt_of("opcua.yaml")


def settings(belt: Device, port: int, **changes: Any) -> Settings:
    """The mapping of the example at this port, as impatient as it is."""
    return mapping(belt, url=f"opc.tcp://127.0.0.1:{port}", **{"timeout_s": 0.5} | changes)  # type: ignore[no-any-return]


@dataclass(frozen=True, kw_only=True)
class Peer:
    """The server, and its input."""

    port: int
    told: IO[str]

    def tell(self, line: str) -> None:
        self.told.write(f"{line}\n")
        self.told.flush()


@contextmanager
def peer(shelf: Path, port: int = 0, *files: Path) -> Iterator[Peer]:
    command = [sys.executable, str(PEER), str(port), str(shelf), *map(str, files)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdin is not None and process.stdout is not None
    try:
        ready, listening = process.stdout.readline().split()
        assert ready == "ready"
        yield Peer(port=int(listening), told=process.stdin)
    finally:
        process.kill()
        process.communicate()


@pytest.fixture(scope="module")
def shelf(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("opcua") / "nodes"


@pytest.fixture(scope="module")
def plain(shelf: Path) -> Iterator[Peer]:
    """A server without a login, for all tests that leave it as it was."""
    with peer(shelf) as server:
        yield server


def test_a_plain_server_is_called_and_believed(belt: Device, free_port: int, shelf: Path) -> None:
    with driven(OpcUa(settings(belt, free_port)), belt) as (driver, heard):
        assert f"127.0.0.1:{free_port} is not there" in str(heard.until(is_lost).lost)
        with pytest.raises(NotSent, match="is not connected"):
            driver.send(order(belt, "load"))
        with peer(shelf, free_port):
            heard.until(is_heard)
            driver.send(order(belt, "load"))
            report = heard.until(lambda report: report.done is not None)
            assert (report.done, report.fact("part_at")) == ("c1", "entry")
        heard.until(is_lost)  # it has gone with its sessions; another one is found again
        with peer(shelf, free_port):
            assert heard.until(is_heard).done is None


def test_what_was_called_over_a_pulled_cable_does_not_arrive_once_that_is_back(
    belt: Device, shelf: Path
) -> None:
    with (
        peer(shelf) as server,
        pulled(server.port) as cable,
        driven(OpcUa(settings(belt, cable.port)), belt) as (driver, heard),
    ):
        sent_over_a_pulled_cable(cable, driver, heard, order(belt, "load"))
        assert heard.all[-1].fact("part_at") == "none"


def test_a_call_that_is_refused_is_rejected(belt: Device, plain: Peer) -> None:
    with driven(OpcUa(settings(belt, plain.port)), belt) as (driver, heard):
        heard.until(is_heard)
        driver.send(order(belt, "scan"))
        report = heard.until(lambda report: report.rejected is not None)
        assert (report.rejected, report.refusal) == ("c1", "BadInvalidState")
        assert heard.until(lambda report: is_heard(report) or is_lost(report)).lost is None


def test_a_halt_that_is_refused_loses_the_link(belt: Device, plain: Peer) -> None:
    with driven(OpcUa(settings(belt, plain.port)), belt) as (driver, heard):
        heard.until(is_heard)
        driver.send(Stop(id="s", robot="belt", mode=StopMode.HALT))
        assert str(heard.until(is_lost).lost) == "ns=2;s=Halt was refused: BadUserAccessDenied"
        heard.until(is_heard)


def test_a_method_that_does_not_return_holds_up_no_sender(belt: Device, plain: Peer) -> None:
    """A halt leaves while the method runs; the link is then lost: who knows what became of the call?"""
    with driven(OpcUa(settings(belt, plain.port)), belt) as (driver, heard):
        heard.until(is_heard)
        driver.send(order(belt, "advance", to="exit", speed_mm_s=200))  # a method that takes an hour
        driver.send(Stop(id="s", robot="belt", mode=StopMode.CLEAR))
        heard.until(is_lost)


def test_no_value_of_another_type_proves_anything(belt: Device, plain: Peer) -> None:
    with driven(OpcUa(settings(belt, plain.port)), belt) as (_, heard):
        plain.tell("none")
        for value in SPOILT:
            heard.until(lambda report: is_heard(report) and report.fact("part_at") == "none")
            plain.tell(value)
            report = heard.until(lambda report: is_lost(report) or report.fact("part_at") != "none")
            assert "ns=2;s=part_at is " in str(report.lost), value
            plain.tell("none")


def test_sessions_that_the_server_ends_are_made_anew(belt: Device, plain: Peer) -> None:
    with driven(OpcUa(settings(belt, plain.port)), belt) as (_, heard):
        heard.until(is_heard)
        plain.tell("sessions")
        assert "Session" in str(heard.until(is_lost).lost)
        heard.until(is_heard)


def test_a_server_with_a_login_is_used_while_its_certificate_is_believed(
    belt: Device, shelf: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    server, ours = certificate(tmp_path, "server"), certificate(tmp_path, "cell")
    files = {"CERT": ours[0], "KEY": ours[1], "SERVER_CERT": server[0]}
    for name, value in {"USER": "cell", "PASSWORD": "secret", **files}.items():
        monkeypatch.setenv(f"PLC_{name}", str(value))
    with peer(shelf, 0, *server) as there:
        at = settings(belt, there.port, security="sign", secrets="PLC")
        with driven(OpcUa(at), belt) as (driver, heard):
            heard.until(is_heard)
            driver.send(order(belt, "load"))
            assert heard.until(lambda report: report.done is not None).done == "c1"
        monkeypatch.setenv("PLC_SERVER_CERT", str(ours[0]))
        with driven(OpcUa(at), belt) as (_, heard):
            heard.until(is_lost)


class Played:
    """A client without a server, which answers at once; something changes all the time."""

    refusals: ClassVar[list[float]] = []  # when a method refused

    def __init__(self, url: str, timeout: float) -> None:
        self.uaclient = self
        self.protocol = None  # it has no connection
        self._changes: Any = None  # until somebody subscribes

    def get_node(self, node: ua.NodeId) -> Any:
        return SimpleNamespace(nodeid=node, call_method=self.call_method)

    async def connect(self) -> None:
        """It is there at once."""

    async def create_subscription(self, period_ms: float, changes: Any) -> Played:
        self._changes = changes
        return self

    async def subscribe_data_change(self, nodes: list[Any]) -> None:
        """All changes are told, whether they are asked for or not."""

    async def read_attributes(self, nodes: list[Any], attribute: Any) -> list[Any]:
        if self._changes is not None:
            self._changes.datachange_notification(None, None, None)
        await asyncio.sleep(0)
        return [ua.DataValue(ua.Variant(0, ua.VariantType.UInt16))] * len(nodes)

    async def call_method(self, *_: Any) -> None:
        """It takes a while, in which everything else goes on, and refuses."""
        await asyncio.sleep(0.1)
        self.refusals.append(time.monotonic())
        raise ua.uaerrors.BadInvalidState

    async def disconnect(self) -> None:
        """Nobody has to be told."""

    def disconnect_socket(self) -> None:
        """There is none."""


class Stubborn(Played):
    """One that no cancellation ends."""

    async def connect(self) -> None:
        while True:
            with suppress(asyncio.CancelledError):
                await asyncio.sleep(60)


def test_a_method_that_refuses_late_is_heard_as_of_then(
    belt: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A refusal older than the last report is old news, and dropped."""
    monkeypatch.setattr(asyncua, "Client", Played)
    monkeypatch.setattr(Played, "refusals", [])
    with driven(OpcUa(settings(belt, 4840)), belt) as (driver, heard):
        heard.until(is_heard)
        driver.send(order(belt, "load"))
        report = heard.until(lambda report: report.rejected is not None)
        assert (report.rejected, report.refusal) == ("c1", "BadInvalidState")
        assert report.at >= Played.refusals[0]


class Slow(Played):
    """One that has taken the values of an order only after a stop; it keeps what was written."""

    written: ClassVar[list[str]] = []

    def __init__(self, url: str, timeout: float) -> None:
        super().__init__(url, timeout)
        self._stopped = asyncio.Event()

    async def write_attributes(self, nodes: list[Any], values: list[Any]) -> list[Any]:
        names = [node.to_string() for node in nodes]
        if "ns=2;s=Halt" in names:
            self._stopped.set()
        if "ns=2;s=Verb" in names:
            await self._stopped.wait()
        self.written += names
        return [ua.StatusCode()] * len(nodes)


def test_a_halt_between_values_and_number_keeps_the_number_from_being_written(
    belt: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(asyncua, "Client", Slow)
    monkeypatch.setattr(Slow, "written", [])
    verb = Verb(write=(Write(node="ns=2;s=Verb", value=1, type="byte"),))
    halt = Order(write=(Write(node="ns=2;s=Halt", value=True, type="bool"),))
    sequence = Sequence(accepted="ns=2;s=accepted", done="ns=2;s=done", write="ns=2;s=Request")
    mapped = settings(belt, 4840, verbs={"load": verb}, halt=halt, sequence=sequence)
    with driven(OpcUa(mapped), belt) as (driver, heard):
        heard.until(is_heard)
        driver.send(order(belt, "load"))
        driver.send(Stop(id="s", robot="belt", mode=StopMode.HALT))
        report = heard.until(lambda report: report.rejected is not None)
        assert (report.rejected, report.refusal) == ("c1", "stopped")
        assert Slow.written == ["ns=2;s=Halt", "ns=2;s=Verb"]
        driver.send(order(belt, "load"))
        heard.until(lambda report: "ns=2;s=Request" in Slow.written)
        assert Slow.written[2:] == ["ns=2;s=Verb", "ns=2;s=Request"]


def test_a_cancellation_that_gets_lost_does_not_hold_up_the_end(
    belt: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before Python 3.12 `asyncio.wait_for` loses one that comes just when it has its answer."""
    for client in [Played] * 50 + [Stubborn]:
        monkeypatch.setattr(asyncua, "Client", client)
        driver, heard = OpcUa(settings(belt, 4840)), Heard()
        driver.start([belt], heard, time.monotonic)
        if client is not Stubborn:
            heard.until(is_heard)
        ending = threading.Thread(target=driver.stop, daemon=True)
        ending.start()
        ending.join(PATIENCE_S)
        assert not ending.is_alive(), client.__name__


def certificate(folder: Path, name: str) -> tuple[Path, Path]:
    """A certificate and its key, made by openssl."""
    need_tool("openssl")
    made, key = folder / f"{name}.pem", folder / f"{name}.key.pem"
    extensions = (
        f"subjectAltName=URI:urn:{name},DNS:localhost",
        "keyUsage=digitalSignature,nonRepudiation,keyEncipherment,dataEncipherment",
        "extendedKeyUsage=serverAuth,clientAuth",
    )
    subjects = ["-subj", f"/CN={name}", *(each for row in extensions for each in ("-addext", row))]
    kind = ["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", *subjects]
    subprocess.run(
        ["openssl", *kind, "-keyout", str(key), "-out", str(made)], check=True, capture_output=True
    )
    return made, key
