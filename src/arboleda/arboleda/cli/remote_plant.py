"""The way to a plant that is led from another state directory, on this host or on another one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from arboleda.model.errors import ArboledaError
from arboleda.runtime import tokens
from arboleda.runtime.endpoints import Place, with_tokens
from arboleda.runtime.leader import LeaderInfo, of_leader
from arboleda.runtime.stores import leadership_of
from arboleda.web.auth import Role

from .line import FarLine


class NoLeader(ArboledaError):
    """Nobody leads the plant; `awaited` where somebody stands by, who will."""

    def __init__(self, sentence: str, *, awaited: bool) -> None:
        super().__init__(sentence)
        self.awaited = awaited


class RemotePlant:
    """Of the plant of the state directory `state`. `kept_in()` is the database of its memory, "" for a file,
    and its name; `known()` are tokens by address or by plant. Both are asked only where they are needed: what
    is wrong with them keeps nobody from the plant that runs here."""

    def __init__(
        self, state: Path, kept_in: Callable[[], tuple[str, str]], known: Callable[[], Mapping[str, str]]
    ) -> None:
        self._state = state
        self._kept_in = kept_in
        self._known = known

    @property
    def is_known(self) -> bool:
        """Whether there is a database that knows who leads."""
        return bool(self._memory[0])

    @cached_property
    def _memory(self) -> tuple[str, str]:
        return self._kept_in()

    def led(self) -> LeaderInfo | None:
        """Who leads it, as its database says; None where its memory is a file. Nobody; ArboledaError where
        the database does not say."""
        store, plant = self._memory
        if not store:
            return None
        others = leadership_of(store, plant)
        try:
            leader = others.leader()
        finally:
            others.close()
        if not leader.leads:
            raise NoLeader(f"Nobody leads the plant of {others.name} now.", awaited=bool(leader.standbys))
        return of_leader(plant, leader)

    def line(self, led: LeaderInfo) -> FarLine:
        """To who leads it; ArboledaError where no address of his leads there from here."""
        named = f"Plant {led.plant} is led on {led.host}"
        if led.is_far:
            raise ArboledaError(
                f"{named}, at {led.url}, which is reached from {led.host} alone: start both hosts with"
                " `--host ADDRESS`, 0.0.0.0 or an address that other hosts reach."
            )
        if not led.way:
            raise ArboledaError(f"{named}, which has not said its address yet; try again in some seconds.")
        place = self._place(led)
        shown = "the token that was shown is not valid there" if place.token else "no token is known for it"
        advice = (
            f"({shown}): copy {tokens.TOKENS} of the state directory there into {self._state}, or write"
            f" `{led.plant} TOKEN` into a file and name that by --tokens or $ARBOLEDA_TOKENS."
        )
        return FarLine(place, named, led.host, advice)

    def _place(self, led: LeaderInfo) -> Place:
        """With a token of the file of tokens, of a plant of this machine that has the address, or of this
        state directory: hosts that lead a plant in turns may have the same ones."""
        (place,) = with_tokens(lambda: [Place(url=led.way, plant=led.plant)], self._known())()
        if place.token:
            return place
        with suppress(ArboledaError):
            return replace(place, token=tokens.TokenFile(self._state)()[Role.OPERATOR])
        return place
