"""The leader of a plant, as its database or a process that stands by names it."""

from __future__ import annotations

import socket
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from arboleda.model.errors import StartError
from arboleda.model.outside import plain
from arboleda.web.access.names import is_near_only, public_origin

if TYPE_CHECKING:
    from arboleda.store.leadership import Leader


@dataclass(frozen=True, kw_only=True)
class LeaderInfo:
    """LeaderInfo: the process that leads a plant, its host, the address of its page ("" if there is none),
    and the number of its start."""

    plant: str
    host: str
    process: int
    url: str
    epoch: int

    @property
    def here(self) -> bool:
        """True if the leader's host has the name of this one."""
        return _is_here(self.host)

    @property
    def is_far(self) -> bool:
        """True if the address works only on the leader's own host, and that is not this one."""
        return bool(self.url) and not way_to(self.host, self.url)

    @property
    def way(self) -> str:
        """The address if it can be used from this host; else ""."""
        return way_to(self.host, self.url)


def of_leader(plant: str, leader: Leader) -> LeaderInfo:
    """The leader as the database names it."""
    return LeaderInfo(
        plant=plant,
        host=leader.host,
        process=leader.process,
        url=_origin(leader.url),
        epoch=leader.epoch,
    )


def leader_row(led: LeaderInfo | None) -> dict[str, Any]:
    """The leader's row in the answer of a process that stands by, for `of_standby`."""
    if led is None:
        return {"leader": "", "host": "", "process": 0, "epoch": 0}
    return {"leader": led.url, "host": led.host, "process": led.process, "epoch": led.epoch}


def of_standby(answer: Mapping[str, Any]) -> LeaderInfo:
    """The leader as a process that stands by names it."""
    return LeaderInfo(
        plant=plain(str(answer.get("plant", ""))),
        host=plain(str(answer.get("host", ""))),
        process=_number(answer.get("process")),
        url=_origin(str(answer.get("leader", ""))),
        epoch=_number(answer.get("epoch")),
    )


def way_to(host: str, url: str) -> str:
    """The address of a process of that host if it is valid and can be used from this host; else ""."""
    url = _origin(url)
    return "" if url and is_near_only(url) and not _is_here(host) else url


def _is_here(host: str) -> bool:
    return host == plain(socket.gethostname())


def _number(value: object) -> int:
    return value if isinstance(value, int) else 0


def _origin(url: str) -> str:
    try:
        return public_origin(url)
    except StartError:
        return ""
