"""The process that answers Groot2: trees come in on its standard input, a line of JSON each; nothing but its
ports goes out on its standard output. It ends where its input does.

It is a process of its own so that whatever clients send, and however much of it, takes neither the
interpreter nor the memory of the plant.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

import msgpack
import zmq

from arboleda.host import abilities, limits
from arboleda_trees.groot2.watched_tree import WatchedTree

DEFAULT_PORT = 1667
LAST_PORT = 65534  # the one after it is the publisher's
MEMORY_BYTES = 1 << 30  # limit of memory: filling it ends this process, not the machine
REQUEST_BYTES = 1 << 16
WAITING = 100  # requests and replies of a client
NICE = 10  # the plant goes first
CHUNK_BYTES = 1 << 16
NO_PIPES = "it is not there on Windows, where one process cannot wait for both another one and a network"


class NoPort(Exception):
    """Error: no port can be opened; the text is the reason."""


class Desk:
    """Answers for all cells, each on a port of its own with a publisher on the next one.

    Nothing is ever published: BehaviorTree.CPP has that port for breakpoints, and a viewer connects to it.
    """

    def __init__(self, host: str, cells: Sequence[str], port: int | None) -> None:
        self._context = zmq.Context()
        self._context.set(zmq.MAX_SOCKETS, 2 * len(cells) + 16)
        self._host = host
        self._watched = {cell: WatchedTree(_pack) for cell in cells}
        self._poller = zmq.Poller()
        self._desks: dict[Any, WatchedTree] = {}
        self._publishers: list[zmq.Socket[bytes]] = []
        self.ports: dict[str, int] = {}
        free = _from(DEFAULT_PORT if port is None else port)
        for cell in cells:
            self._open(cell, free, may_pass_by=port is None)

    def _open(self, cell: str, free: Iterator[int], *, may_pass_by: bool) -> None:
        for port in free:
            server, publisher = self._socket(zmq.ROUTER), self._socket(zmq.PUB)
            try:
                server.bind(self._address(port))
                publisher.bind(self._address(port + 1))
            except zmq.ZMQError as error:
                server.close()
                publisher.close()
                if may_pass_by and error.errno == zmq.EADDRINUSE:
                    continue
                where = f"{self._host}, ports {port} and {port + 1}"
                raise NoPort(f"cannot listen on {where}, for {cell}: {error.strerror}") from error
            self.ports[cell] = port
            self._desks[server] = self._watched[cell]
            self._publishers.append(publisher)
            self._poller.register(server, zmq.POLLIN)
            return
        raise NoPort(f"there is no pair of ports left for {cell}")

    def _socket(self, kind: int) -> Any:
        made = self._context.socket(kind)
        options = {zmq.LINGER: 0, zmq.MAXMSGSIZE: REQUEST_BYTES, zmq.RCVHWM: WAITING, zmq.SNDHWM: WAITING}
        for option, value in {**options, zmq.IPV6: int(":" in self._host)}.items():
            made.setsockopt(option, value)
        return made

    def _address(self, port: int) -> str:
        return f"tcp://[{self._host}]:{port}" if ":" in self._host else f"tcp://{self._host}:{port}"

    def serve(self, source: int) -> None:
        """Answer until there is nothing more to come from `source`, a file descriptor."""
        self._poller.register(source, zmq.POLLIN)
        rest = b""
        while True:
            for ready, _ in self._poller.poll():
                if ready != source:
                    self._answer(ready)
                    continue
                chunk = os.read(source, CHUNK_BYTES)
                if not chunk:
                    return
                *lines, rest = (rest + chunk).split(b"\n")
                for line in lines:
                    self._saw(json.loads(line))

    def _answer(self, server: Any) -> None:
        """Answer a request by hand on a ROUTER socket: a REP socket waits for ever for a broken one."""
        with suppress(zmq.ZMQError):  # the client is gone
            parts = server.recv_multipart(zmq.NOBLOCK)
            if b"" in parts:
                begin = parts.index(b"") + 1  # the parts before it route the reply to the client
                reply = self._desks[server].answer(parts[begin:], time.time_ns() // 1000)
                server.send_multipart([*parts[:begin], *reply], zmq.NOBLOCK)

    def _saw(self, cell: Mapping[str, Any]) -> None:
        watched = self._watched[cell["name"]]
        watched.saw(cell["tree"], cell["facts"], cell["at_us"], has_succeeded=cell["has_succeeded"])


def _from(port: int) -> Iterator[int]:
    """The first port of each pair that can be tried, upwards from `port`."""
    return iter(range(port, LAST_PORT + 1, 2))


def _pack(data: Any) -> bytes:
    return bytes(msgpack.packb(data, default=str))


def main(host: str, cells: Sequence[str], port: int | None) -> None:
    """Print the port of each cell, or the reason why there is none; then answer."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the plant, which ends this
    limits.limit_memory(MEMORY_BYTES)
    limits.give_way(NICE)
    if not abilities.WAITS_FOR_PIPES:
        _say({"error": NO_PIPES})
        return
    try:
        desk = Desk(host, cells, port)
    except NoPort as error:
        _say({"error": str(error)})
        return
    _say({"ports": desk.ports})
    desk.serve(sys.stdin.fileno())
    os._exit(0)  # unsent replies are dropped


def _say(what: dict[str, Any]) -> None:
    print(json.dumps(what), flush=True)
