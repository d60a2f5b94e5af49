"""A plant whose broker is attacked: its boards stay online, a stop gets through, its memory stays small."""

from __future__ import annotations

import json
import os
import re
import socket
import struct
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest

from arboleda.cli.client import PlantClient
from arboleda.client import Conflict
from arboleda.model.messages import Verb

from ..patience import PATIENCE_S
from .test_verbs import eventually

pytestmark = pytest.mark.system

BOARDS = ("ra_1", "ra_2", "ra_3", "rm_sis_a", "rm_sis_b", "rm_sis_c")
HOST = "127.0.0.3"  # with users the port is the usual one, which another broker of this machine may have
GROWTH_BYTES = 100_000_000


def text(value: str) -> bytes:
    return struct.pack("!H", len(value)) + value.encode()


def connect(user: str, client_id: str) -> bytes:
    body = text("MQTT") + b"\x04\xc2\0\0" + text(client_id) + text(user) + text("secret")
    return bytes((0x10, len(body))) + body


class Attackers:
    """Connections to a broker, as many as are asked for, which do not wait for anything."""

    def __init__(self, port: int, opened: ExitStack) -> None:
        self._port = port
        self._opened = opened

    def dial(self, first: bytes = b"", user: str = "", client_id: str = "") -> socket.socket:
        talk = self._opened.enter_context(socket.create_connection((HOST, self._port), PATIENCE_S))
        talk.sendall((connect(user, client_id) if user else b"") + first)
        talk.settimeout(0.1)
        return talk

    def huge_packets(self) -> None:
        talks = [self.dial(b"\x10\x80\x80\x80\x7f") for _ in range(3)]
        talks += [self.dial(b"\x30\x80\x80\x80\x7f", "ana", f"huge {n}") for n in range(3)]
        block = b"x" * 1_000_000
        for talk in talks:
            with suppress(OSError):
                for _ in range(256):
                    talk.sendall(block)

    def strangers(self) -> None:
        for _ in range(200):
            self.dial()

    def idle_users(self) -> None:
        for n in range(100):
            self.dial(b"", "ana", f"idle {n}")

    def foreign_client_ids(self) -> None:
        for board in BOARDS:
            self.dial(b"", "ana", board)

    def subscriptions(self) -> None:
        for n in range(10):
            many = b"".join(text(f"+/{k}") + b"\1" for k in range(400))
            head = b"\x82" + bytes(((len(many) + 2) & 127 | 128, (len(many) + 2) >> 7)) + b"\0\1"
            with suppress(OSError):
                self.dial(b"", "ana", f"wild {n}").sendall((head + many) * 20)

    def pings(self) -> None:
        for n in range(10):
            with suppress(OSError):
                self.dial(b"", "ana", f"ping {n}").sendall(b"\xc0\0" * 100_000)


ATTACKS = (
    Attackers.huge_packets,
    Attackers.strangers,
    Attackers.idle_users,
    Attackers.foreign_client_ids,
    Attackers.subscriptions,
    Attackers.pings,
)


@pytest.fixture
def users(tmp_path: Path) -> Path:
    file = tmp_path / "users.txt"
    file.write_text("ana:secret\n" + "".join(f"{board}:secret-{board}\n" for board in BOARDS))
    return file


def resident_bytes(pid: int) -> int:
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@contextmanager
def attacked(port: int, attack: Callable[[Attackers], None]) -> Iterator[None]:
    with ExitStack() as opened:
        attack(Attackers(port, opened))
        yield


def test_a_plant_whose_broker_is_attacked_is_stopped_and_works_on(
    arboleda: Callable[..., Any], users: Path, tmp_path: Path
) -> None:
    opened = ("--broker-host", HOST, "--broker-users", str(users), "--boards", "virtual")
    up = arboleda("up", "--no-ros", "--rate", "20", *opened)
    up.wait_for("HTTP API")
    found = re.search(rf"MQTT broker: {HOST}:(\d+)", up.output)
    assert found
    pid = json.loads((tmp_path / "state" / "plant.json").read_text())["pid"]

    client = PlantClient(tmp_path / "state")

    def done(verb: Verb) -> bool:
        with suppress(Conflict):
            return bool(client.operate(verb))
        return False

    def online() -> bool:
        return all(robot["online"] for robot in client.status()["robots"])

    eventually(online, "the boards never came")
    before = resident_bytes(pid)
    for attack in ATTACKS:
        with attacked(int(found[1]), attack):
            assert done(Verb.STOP), attack.__name__
            eventually(lambda: done(Verb.CLEAR), f"no clear during {attack.__name__}")
            eventually(lambda: done(Verb.RESET), f"no reset during {attack.__name__}")
            assert online(), attack.__name__
            assert resident_bytes(pid) - before < GROWTH_BYTES, attack.__name__
            client.operate(Verb.RESUME)
            client.submit("sis_a 0B 7")
            up.wait_for("done      sis_a 0B 7", times=1 + ATTACKS.index(attack))
    assert "Traceback" not in up.output
    assert up.interrupt() == 0, up.output
