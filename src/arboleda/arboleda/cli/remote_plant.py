"""The way to a plant that is led from another state directory, on this host or on another one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from arboleda.model.errors import ArboledaError
from arboleda.model.sentence import Phrase, Sentence
from arboleda.runtime import tokens
from arboleda.runtime.endpoints import Place, with_tokens
from arboleda.runtime.leader import LeaderInfo, of_leader
from arboleda.runtime.stores import leadership_of
from arboleda.web.access.auth import Role

from .line import FarLine

NOBODY_LEADS = Phrase("cli.remote.nobody_leads", "Nobody leads the plant of {plant} now.")
LED_ON = Phrase("cli.remote.led_on", "Plant {plant} is led on {host}")
NEAR_ONLY = Phrase(
    "cli.remote.near_only",
    "{led}, at {url}, which is reached from {host} alone: start both hosts with `--host ADDRESS`, 0.0.0.0 or "
    "an address that other hosts reach.",
)
NO_ADDRESS = Phrase(
    "cli.remote.no_address", "{led}, which has not said its address yet; try again in some seconds."
)
NOT_VALID = Phrase("cli.remote.not_valid", "the token that was shown is not valid there")
NO_TOKEN = Phrase("cli.remote.no_token", "no token is known for it")
TOKEN_ADVICE = Phrase(
    "cli.remote.token_advice",
    "({why}): copy {tokens} of the state directory there into {state}, or write `{plant} TOKEN` into a file "
    "and name that by --tokens or $ARBOLEDA_TOKENS.",
)


class NoLeader(ArboledaError):
    """Nobody leads the plant; `awaited` where somebody stands by, who will."""

    def __init__(self, sentence: Sentence, *, awaited: bool) -> None:
        super().__init__(sentence)
        self.awaited = awaited


class RemotePlant:
    """RemotePlant: finds the process that leads the plant of the state directory `state`. `kept_in()` is the
    database of its memory, "" for a file, and its name; `known()` are tokens by address or by plant. Both are
    called only when needed, so that an error in them keeps nobody from the plant that runs here."""

    def __init__(
        self, state: Path, kept_in: Callable[[], tuple[str, str]], known: Callable[[], Mapping[str, str]]
    ) -> None:
        self._state = state
        self._kept_in = kept_in
        self._known = known

    @property
    def is_known(self) -> bool:
        """True if there is a database that knows the leader."""
        return bool(self._memory[0])

    @cached_property
    def _memory(self) -> tuple[str, str]:
        return self._kept_in()

    def led(self) -> LeaderInfo | None:
        """The leader of the plant as its database says it; None if its memory is a file. Raises NoLeader if
        nobody leads, ArboledaError if the database does not answer."""
        store, plant = self._memory
        if not store:
            return None
        others = leadership_of(store, plant)
        try:
            leader = others.leader()
        finally:
            others.close()
        if not leader.leads:
            raise NoLeader(NOBODY_LEADS(plant=others.name), awaited=bool(leader.standbys))
        return of_leader(plant, leader)

    def line(self, led: LeaderInfo) -> FarLine:
        """The line to the leader; ArboledaError if none of its addresses can be reached from here."""
        named = LED_ON(plant=led.plant, host=led.host)
        if led.is_far:
            raise ArboledaError(NEAR_ONLY(led=named, url=led.url, host=led.host))
        if not led.way:
            raise ArboledaError(NO_ADDRESS(led=named))
        place = self._place(led)
        why = NOT_VALID() if place.token else NO_TOKEN()
        advice = TOKEN_ADVICE(why=why, tokens=tokens.TOKENS, state=str(self._state), plant=led.plant)
        return FarLine(place, named, led.host, advice)

    def _place(self, led: LeaderInfo) -> Place:
        """The leader's address with a token: from the file of tokens, from a plant of this machine with that
        address, or from this state directory, as hosts that lead a plant in turns may have the same ones."""
        (place,) = with_tokens(lambda: [Place(url=led.way, plant=led.plant)], self._known())()
        if place.token:
            return place
        with suppress(ArboledaError):
            return replace(place, token=tokens.TokenFile(self._state)()[Role.OPERATOR])
        return place
