"""The driver opcua with a server that was not made with its library: node-opcua, told by variables."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import IO, Any

import pytest
from tests.lengths import sample
from tests.shared import need_tool

from arboleda.drivers import Stop, StopMode
from arboleda.kinds.declared import Device
from arboleda_drivers.opcua.adapter import OpcUa
from arboleda_drivers.opcua.keys import Sequence, Verb
from arboleda_drivers.opcua.nodes import Order, Variable, Write
from arboleda_drivers.opcua.settings import Settings

from ..plc.driven import belt_of, driven, is_heard, is_lost, order
from .test_opcua import certificate

pytestmark = [pytest.mark.system, pytest.mark.requires("node", "asyncua")]

PACKAGES = Path(sys.prefix, "npm/node_modules")
PEER = Path(__file__).with_name("opcua_node_peer.js")
LIMIT = 5  # values that one request may have
POLICIES = ("basic256sha256", "aes128_sha256_rsaoaep", "aes256_sha256_rsapss")


def at(name: str) -> str:
    return f"nsu=urn:peer:belt;s={name}"


VERB = {number: Write(node=at("Verb"), value=number, type="byte") for number in (1, 2, 3, 9)}
VERBS = {
    "load": Verb(write=(VERB[1],)),
    "advance": Verb(
        write=(
            VERB[2],
            Write(node=at("To"), value="$to", type="int16", words={"entry": 1, "exit": 2}),
            Write(node=at("Speed"), value="$speed_mm_s", type="float"),
        )
    ),
    "gate": Verb(
        write=(VERB[3], Write(node=at("To"), value="$to", type="int16", words={"closed": 0, "open": 1}))
    ),
    "scan": Verb(write=(VERB[9],), answer=Variable(node=at("Verb"), words={"good": 1, "bad": 9})),
}
SEQUENCE = Sequence(
    type="int32",
    write=at("Request"),
    busy=at("Busy"),
    done=at("Done"),
    error=Variable(node=at("Error"), words={"jam": 7}),
)


@dataclass(frozen=True, kw_only=True)
class Peer:
    """The server's port and input, and the files of its certificate and of the client's."""

    port: int
    input: IO[str]
    files: dict[str, Path]

    def settings(self, **changes: Any) -> Settings:
        given = {
            "url": f"opc.tcp://127.0.0.1:{self.port}",
            "security": "none",
            "secrets": "PLC",
            "timeout_s": 5.0,
            "sequence": SEQUENCE,
            "facts": {
                "part_at": Variable(node=at("PartAt"), words={"none": 0, "entry": 1, "exit": 2}),
                "gate": Variable(node=at("Gate"), words={"closed": 0, "open": 1}),
                "mm_s": Variable(node=at("MmS")),
            },
            "verbs": VERBS,
            "halt": Order(write=(Write(node=at("Halt"), value=True, type="bool"),)),
            "heartbeat": at("Beat"),
            "heartbeat_type": "int32",
        }
        return Settings(**given | changes)


@contextmanager
def served(folder: Path, *, login: bool) -> Iterator[Peer]:
    node = need_tool("node")
    if not (PACKAGES / "node-opcua-server").is_dir():
        pytest.skip("node-opcua-server is not installed: make test-tools")
    server, ours = certificate(folder, "server"), certificate(folder, "cell")
    options = {
        "folder": str(folder / "pki"),
        "certificate": str(server[0]),
        "key": str(server[1]),
        "limit": LIMIT,
        "namespaces": 2,
        "login": login,
    }
    process = subprocess.Popen(
        [node, str(PEER), str(PACKAGES), json.dumps(options)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    assert process.stdin is not None and process.stdout is not None
    try:
        ready = next(line for line in process.stdout if line.startswith("ready "))
        files = {"CERT": ours[0], "KEY": ours[1], "SERVER_CERT": server[0]}
        yield Peer(port=int(ready.split()[1]), input=process.stdin, files=files)
    finally:
        process.kill()
        process.communicate()


@pytest.fixture(scope="module")
def belt() -> Device:
    return belt_of("opcua.yaml")


@pytest.fixture(scope="module")
def peer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Peer]:
    """A server without a login, for all tests."""
    with served(tmp_path_factory.mktemp("open"), login=False) as server:
        yield server


@pytest.fixture(scope="module")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Peer]:
    """One with a login."""
    with served(tmp_path_factory.mktemp("guarded"), login=True) as server:
        yield server


def test_verbs_are_written_and_known_as_done_where_one_request_may_have_few_values(
    belt: Device, peer: Peer
) -> None:
    with driven(OpcUa(peer.settings()), belt) as (driver, heard):
        heard.until(is_heard)
        for id, verb, values, fact in (
            ("c1", "load", {}, ("part_at", "entry")),
            ("c2", "gate", {"to": "open"}, ("gate", "open")),
            ("c3", "advance", {"to": "exit", "speed_mm_s": 200}, ("part_at", "exit")),
        ):
            driver.send(belt.kind.command(id=id, robot="belt", verb=verb, values=values))
            report = heard.until(lambda report, id=id: report.done == id)
            assert (report.accepted, report.fact(fact[0])) == (id, fact[1])
        assert report.fact("mm_s") == 200


def test_a_halt_is_written_while_an_order_is_at_work(belt: Device, peer: Peer) -> None:
    peer.input.write("hold\n")
    peer.input.flush()
    with driven(OpcUa(peer.settings()), belt) as (driver, heard):
        before = heard.until(is_heard).fact("part_at")
        driver.send(order(belt, "load"))
        heard.until(lambda report: report.accepted == "c1" and not is_heard(report))
        driver.send(Stop(id="s", robot="belt", mode=StopMode.HALT))
        peer.input.write("go on\n")
        peer.input.flush()
        report = heard.until(is_heard)
        assert (report.done, report.fact("part_at")) == (None, before)


def test_what_does_not_fit_the_server_is_said_with_its_node(belt: Device, peer: Peer) -> None:
    wrong = Verb(write=(replace(VERB[1], type="int32"),))
    with driven(OpcUa(peer.settings(verbs=VERBS | {"load": wrong})), belt) as (driver, heard):
        heard.until(is_heard)
        for _ in range(2):  # the link stays
            driver.send(order(belt, "load"))
            report = heard.until(lambda report: report.rejected is not None or is_lost(report))
            assert report.refusal == "nsu=urn:peer:belt;s=Verb: BadTypeMismatch"
    for changes, words in (
        ({"heartbeat_type": "uint16"}, "the heartbeat is refused: nsu=urn:peer:belt;s=Beat: BadTypeMismatch"),
        (
            {"boot": "nsu=urn:nobody;s=Boot"},
            "the server has no namespace urn:nobody; there are http://opcfoundation.org/UA/",
        ),
    ):
        with driven(OpcUa(peer.settings(**changes)), belt) as (_, heard):
            assert words in str(heard.until(is_lost).lost)


@pytest.mark.parametrize("policy", sample(POLICIES, every=len(POLICIES)))
def test_a_user_is_known_by_each_policy(
    belt: Device, guarded: Peer, monkeypatch: pytest.MonkeyPatch, policy: str
) -> None:
    for name, value in {"USER": "cell", "PASSWORD": "secret", **guarded.files}.items():
        monkeypatch.setenv(f"PLC_{name}", str(value))
    at_peer = guarded.settings(security="sign_and_encrypt", policy=policy)
    with driven(OpcUa(at_peer), belt) as (driver, heard):
        heard.until(is_heard)
        driver.send(order(belt, "load"))
        assert heard.until(lambda report: report.done is not None).done == "c1"


def test_a_wrong_password_is_refused(belt: Device, guarded: Peer, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in {"USER": "cell", "PASSWORD": "wrong-word", **guarded.files}.items():
        monkeypatch.setenv(f"PLC_{name}", str(value))
    with driven(OpcUa(guarded.settings(security="sign_and_encrypt")), belt) as (_, heard):
        lost = str(heard.until(is_lost).lost)
        assert "Bad" in lost and "wrong-word" not in lost
