"""Limit of open files of this process, and the share of it that each server may use for its connections.

A connection costs a file descriptor, and all parts of a process share one limit of them (RLIMIT_NOFILE). What
the broker's clients use up is missing when somebody wants to stop the plant over HTTP, so each server gets a
share of its own. This is the one place that divides them.
"""

from __future__ import annotations

import socket
from dataclasses import dataclass
from typing import Any

from arboleda.host import limits
from arboleda.model.errors import StartError

RAISED_TO = 4096  # a higher limit serves nobody here, and programs that we start inherit it
SELECT_SEES = 1024  # paho waits with select(), which takes no descriptor with a higher number
# Counted in /proc/self/fd of a plant of three cells: 26 without ROS 2, 41 with it; the rest is for DDS
# participants that come, the log, and files that are read.
OWN = 56
PER_BOARD = 4  # a virtual one in this process: its socket, paho's two to wake its loop, the broker's end
AT_ONCE = 2  # connections that a server takes before it looks at their number
ON_THE_WAY = 2 * 3 * AT_ONCE  # asyncio needs up to three rounds from accepting to telling us, in two servers
PER_HTTP = 2  # the connection, and the file that is sent over it
LEAST_HTTP, LEAST_MQTT = 8, 8
QUEUE = 128  # connections that wait in the kernel, which cost no descriptor


@dataclass(frozen=True, kw_only=True)
class Shares:
    """Limits of connections: `http` of all kinds, `mqtt` including the plant's own boards and bridge."""

    http: int
    mqtt: int


def raise_limit() -> None:
    """Raise this process's limit of open files as far as that is possible without being root."""
    limits.raise_open_files(RAISED_TO)


def shares(boards: int) -> Shares:
    """The shares for a plant of so many boards, under the present limit; StartError if it is too low."""
    limit = limits.open_files()
    return divided(RAISED_TO if limit is None else limit, boards)


def divided(limit: int, boards: int) -> Shares:
    """The shares under a limit of `limit` files; raises StartError if so many boards need more."""
    members = boards + 1  # the bridge is a client of the broker, too
    own = OWN + PER_BOARD * members + ON_THE_WAY
    least = PER_HTTP * LEAST_HTTP + LEAST_MQTT
    if limit < own + least:
        raise StartError(
            f"This plant needs {own + least} open files, and the system allows {limit}; allow more, e.g. "
            f" with `ulimit -n {RAISED_TO}`."
        )
    free = max(min(limit, SELECT_SEES) - own, least)
    http = max(free * 2 // 3 // PER_HTTP, LEAST_HTTP)
    return Shares(http=http, mqtt=members + free - PER_HTTP * http)


class Listener(socket.socket):
    """A listening socket for a server of asyncio that is started with `backlog=AT_ONCE`.

    asyncio takes `backlog` for two things: how many connections may wait in the kernel, and how many it
    accepts before anybody gets a chance to close one. Here the second is small, and the first is QUEUE.
    """

    def listen(self, backlog: int = QUEUE, /) -> None:
        super().listen(QUEUE)


def listener(host: str, port: int, **options: Any) -> Listener:
    """Listens on the address; `options` are those of `socket.create_server`. OSError where it cannot."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    plain = socket.create_server((host, port), family=family, backlog=QUEUE, **options)
    return Listener(fileno=plain.detach())
