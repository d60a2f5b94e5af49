"""Addresses of plants, and the credentials that are shown to them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from arboleda.model.errors import ArboledaError, ConfigError
from arboleda.plant_file.user_file import read_text
from arboleda.web.access.auth import Role
from arboleda.web.access.names import public_origin

from . import tokens
from .state import Running, find_running, running_plants

if TYPE_CHECKING:  # slow to load, and only needed to ask a plant
    import ssl

    from arboleda.store.leadership import Leaders

LARGEST = 65_536  # bytes of a file of tokens
LINE = re.compile(r"(\S+)\s+(\S+)")


@dataclass(frozen=True, kw_only=True)
class Place:
    """An address where a plant may be; "" where nobody leads the plant of that name.

    `token` is "" if none is known; `certificate`, as PEM, is the one that is believed, "" leaves that to the
    authorities of this machine.
    """

    url: str
    plant: str = ""
    token: str = ""
    certificate: str = ""

    def believed(self) -> ssl.SSLContext:
        """The certificates that a client of this plant believes."""
        if not self.certificate:
            return _authorities()
        from arboleda.adapters.server_tls import pinned

        return pinned(self.certificate)


@cache
def _authorities() -> ssl.SSLContext:
    import ssl

    return ssl.create_default_context()


Find = Callable[[], list[Place]]


def named(addresses: Iterable[str]) -> Find:
    """The places at the given addresses."""
    places = [Place(url=public_origin(address)) for address in addresses]
    return lambda: places


def of_this_machine() -> list[Place]:
    """The plants that run on this machine on their default state directories."""
    directories = ((path, find_running(path)) for path in running_plants())
    return [here(path, running) for path, running in directories if running is not None and running.port]


def here(state: Path, running: Running) -> Place:
    """The process of that state directory, with the operator's token if it wants one: a user who may read it
    may operate. StartError if the token cannot be read."""
    token = ""
    if running.guarded:
        token = tokens.TokenFile(state)()[Role.OPERATOR]
    return Place(url=running.url, plant=running.plant, token=token, certificate=running.certificate)


def of_database(leaders: Leaders) -> Find:
    """The leaders of the plants of this database now."""
    return lambda: [
        Place(url=leader.url if leader.leads else "", plant=plant) for plant, leader in leaders.all().items()
    ]


def with_tokens(find: Find, tokens_by_name: Mapping[str, str]) -> Find:
    """The places with the tokens of a file, by address or by plant; a plant of this machine without one there
    gets the token that its own commands use."""

    def places() -> list[Place]:
        near = {place.url: place for place in _readable()}
        return [_shown(place, tokens_by_name, near.get(place.url)) for place in find()]

    return places


def _readable() -> list[Place]:
    """The plants of this machine whose tokens this user may read."""
    try:
        return of_this_machine()
    except ArboledaError:
        return []


def _shown(place: Place, tokens_by_name: Mapping[str, str], near: Place | None) -> Place:
    token = tokens_by_name.get(place.url) or tokens_by_name.get(place.plant) or place.token
    if near is None:
        return replace(place, token=token)
    certificate = place.certificate or near.certificate
    return replace(place, token=token or near.token, certificate=certificate)


def tokens_of(file: Path) -> dict[str, str]:
    """The tokens of a file, a line for each plant: its address or its name, and its token; ConfigError."""
    if file.exists() and file.stat().st_mode & tokens.OWNER_ONLY:
        raise ConfigError((f"{file}: others can read the tokens in it; chmod 600 {file}",))
    tokens_by_name: dict[str, str] = {}
    for number, line in enumerate(read_text(file, LARGEST).splitlines(), start=1):
        words = line.partition("#")[0].strip()
        if not words:
            continue
        pair = LINE.fullmatch(words)
        if pair is None:
            raise ConfigError(
                (f"{file}: line {number}: write the address or name of a plant, and its token",)
            )
        tokens_by_name[pair[1].rstrip("/")] = pair[2]
    return tokens_by_name
