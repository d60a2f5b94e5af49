"""Trees for Groot2 over real ZeroMQ: a process of its own, which may be asked anything and may die."""

from __future__ import annotations

import logging
import os
import random
import signal
import socket
import struct
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgpack
import pytest
import zmq
from tests.patience import PATIENCE_S
from tests.ports import is_free, unused_port

from arboleda.model.errors import StartError
from arboleda.runtime.build import Options, build
from arboleda.testing import shipped
from arboleda_trees.groot2.part import Groot2Options, Groot2Part

MOST_BYTES = 1 << 16


def snapshot(*cells: tuple[str, str]) -> dict[str, Any]:
    """One of cells by name, each with a step that stands so."""
    return {"cells": [cell(name, status) for name, status in cells], "tasks": []}


def cell(name: str, status: str) -> dict[str, Any]:
    row = {"path": "root", "name": f"step of {name}", "kind": "command", "status": status}
    task = {"id": "t1", "text": f"{name} 0B 7", "state": "running", "answers": []}
    tree = [{**row, "parameters": {"q": [0.5]}}]
    return {"name": name, "state": "execute", "step": "a step", "task": task, "tree": tree}


class Viewer:
    """A client as Groot2 is one."""

    def __init__(self, port: int, **options: int) -> None:
        self.port = port
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.REQ)
        for name, value in options.items():
            self._socket.setsockopt(getattr(zmq, name), value)
        self._socket.setsockopt(zmq.LINGER, 0)
        self._socket.setsockopt(zmq.RCVTIMEO, int(PATIENCE_S * 1000))
        self._socket.connect(f"tcp://127.0.0.1:{self.port}")

    def send(self, *parts: bytes) -> None:
        self._socket.send_multipart(parts)

    def frames(self, *parts: bytes) -> list[bytes]:
        self.send(*parts)
        return self._socket.recv_multipart()

    def ask(self, type: str, *words: bytes) -> list[bytes]:
        return self.frames(struct.pack("<BBI", 2, ord(type), 1), *words)[1:]

    def until(self, status: int) -> None:
        """Wait for the first node to stand so."""
        give_up = time.monotonic() + PATIENCE_S
        while self.ask("S")[0][2] != status:
            assert time.monotonic() < give_up
            time.sleep(0.01)

    def close(self) -> None:
        self._socket.close()
        self._context.term()


@pytest.fixture
def started() -> Iterator[Callable[..., Groot2Part]]:
    parts = []

    def start(*cells: str, port: int | None) -> Groot2Part:
        part = Groot2Part(cells, Groot2Options(port=port))
        parts.append(part)
        part.start()
        return part

    yield start
    for part in parts:
        part.stop()


@pytest.fixture
def viewer() -> Iterator[Callable[..., Viewer]]:
    viewers = []

    def connected(port: int, **options: int) -> Viewer:
        viewers.append(Viewer(port, **options))
        return viewers[-1]

    yield connected
    for each in viewers:
        each.close()


@pytest.fixture
def port() -> int:
    """The first of four that are free in a row."""
    return unused_port(in_a_row=4)


def children() -> set[int]:
    """The processes that this one has started."""
    told = [path.read_text() for path in Path("/proc/self/task").glob("*/children")]
    return {int(pid) for line in told for pid in line.split()}


def test_each_cell_has_a_pair_of_ports_and_its_own_tree(
    started: Callable[..., Groot2Part], viewer: Callable[..., Viewer], port: int
) -> None:
    part = started("sis_a", "sis_b", port=port)
    first = viewer(port)
    second = viewer(port + 2, REQ_CORRELATE=1, REQ_RELAXED=1)  # it numbers its requests
    second.send(struct.pack("<BBI", 2, ord("B"), 1), b"")  # and does not wait for the answer to this one
    part.saw(snapshot(("sis_a", "RUNNING"), ("sis_b", "SUCCESS")))
    first.until(1)
    second.until(2)
    assert b'name="step of sis_a" _uid="1"' in first.ask("T")[0]
    assert msgpack.unpackb(second.ask("B", b"StepOfSisB")[0])["StepOfSisB"]["task_text"] == "sis_b 0B 7"
    assert first.ask("I", b"{}") == [b"read only: breakpoints and hooks would change what robots do"]
    assert part.notes == [f"Groot2: sis_a {port}/{port + 1}, sis_b {port + 2}/{port + 3} on 127.0.0.1"]


def test_a_plant_shows_its_cells_where_its_file_says_so(
    viewer: Callable[[int], Viewer], port: int, tmp_path: Path
) -> None:
    model = replace(shipped("sis_a", "sis_b"), groot2_port=port)
    app = build(model, {"orchestrator"}, Options(state_dir=tmp_path / "state"))
    app.start()
    try:
        assert f"Groot2: sis_a {port}/{port + 1}, sis_b {port + 2}/{port + 3} on 127.0.0.1" in app.notes
        assert b"no task yet" in viewer(port + 2).ask("T")[0]
    finally:
        app.stop()
    assert is_free(port)


def test_what_keeps_it_from_starting_is_one_sentence(
    started: Callable[..., Groot2Part], port: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    started("sis_a", port=port)
    with pytest.raises(StartError, match=f"ports {port} and {port + 1}, for sis_b: Address already in use"):
        started("sis_b", port=port)
    with monkeypatch.context() as without:
        without.setitem(sys.modules, "zmq", None)
        with pytest.raises(StartError, match=r"install 'arboleda\[groot2\]'"):
            started("sis_a", port=None)
    (tmp_path / "zmq.py").write_text("raise ImportError('no such library')\n")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(StartError, match="is pyzmq installed"):
        started("sis_a", port=None)


def test_nobody_can_send_what_stops_it_from_answering(
    started: Callable[..., Groot2Part], viewer: Callable[[int], Viewer], port: int
) -> None:
    part, client, chance = started("sis_a", port=port), viewer(port), random.Random(5)
    part.saw(snapshot(("sis_a", "RUNNING")))
    client.until(1)
    for _ in range(2000):
        number = chance.randbytes(chance.choice((4, 4, 3)))
        first = bytes([chance.randrange(4), chance.randrange(256)]) + number
        parts = [chance.randbytes(chance.randrange(100)) for _ in range(chance.randrange(3))]
        assert client.frames(first, *parts)
    for _ in range(100):
        with socket.create_connection(("127.0.0.1", port)) as stranger, suppress(OSError):
            stranger.sendall(chance.randbytes(200))  # no ZeroMQ at all
    viewer(port).send(bytes(MOST_BYTES + 1))  # which ends that connection
    client.until(1)


def test_a_process_that_dies_is_said_once_and_the_plant_goes_on(
    started: Callable[..., Groot2Part], port: int, caplog: pytest.LogCaptureFixture
) -> None:
    before = children()
    part = started("sis_a", port=port)
    for process in children() - before:
        os.kill(process, signal.SIGKILL)
    give_up = time.monotonic() + PATIENCE_S
    with caplog.at_level(logging.ERROR):
        while not caplog.records:
            part.saw(snapshot(("sis_a", random.choice(("RUNNING", "SUCCESS", "FAILURE")))))
            assert time.monotonic() < give_up
            time.sleep(0.01)
    part.saw(snapshot(("sis_a", "INVALID")))
    assert [record.message for record in caplog.records] == [
        "what shows trees to Groot2 has ended; the plant goes on without it"
    ]
