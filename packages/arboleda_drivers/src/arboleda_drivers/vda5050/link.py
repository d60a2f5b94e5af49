"""Link to a vehicle: its connection state, and the choice of the states that count."""

from __future__ import annotations

import math
import re

from arboleda.drivers import plain

from .settings import Settings
from .state import VehicleState

BROKEN = {"CONNECTIONBROKEN", "CONNECTION_BROKEN"}
LONGEST_WHY = 200  # characters
NEIGHBOURS = 20  # that a sentence may name
WRAP = 2**31  # headers count to 2**32, then from 0
DAY_S = 86_400
TIME = re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}T([0-9]{2}):([0-9]{2}):([0-9]{2}(?:\.[0-9]+)?)")


class Link:
    """Connection of the vehicle by the broker's word, and the silence allowed between its states."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._broker = False
        self._word: str | None = None  # the last connection state
        self._last_message_at = -math.inf
        self._silent = False
        self._refused = ""  # reason why its last state did not count; "" once one did
        self._last: VehicleState | None = None
        self._first = True  # the next state begins a row of headers
        self._fastest_s: float | None = None  # of its time of day to our clock, by the fastest state
        self.boots = 1
        self.has_booted = False
        self._neighbours: set[str] = set()

    @property
    def is_online(self) -> bool:
        return self._broker and self._word == "ONLINE"

    @property
    def trouble(self) -> str | None:
        """The reason why there is no link, in a sentence; None if there is one."""
        vehicle = plain(self._settings.vehicle, 80)
        if not self._broker:
            return f"the MQTT broker at {self._settings.broker} is not there"
        if self._word is None:
            return f"no vehicle {vehicle} has said that it is there{self._others()}"
        if self._word in BROKEN:
            return f"the connection of {vehicle} broke"
        if self._word != "ONLINE":
            return f"{vehicle} has left ({self._word})"
        if self._silent:
            counts = " that counts" if self._refused else ""
            return f"{vehicle} has told no state{counts} for {self._settings.silent_after_s:g} s{self._why}"
        if self._last is None:
            return f"{vehicle} is there, and has told no state yet that could be read{self._why}"
        return None

    @property
    def _why(self) -> str:
        return f": {self._refused}" if self._refused else ""

    def _others(self) -> str:
        if not self._neighbours:
            return f" (on {plain(self._settings.topics, 80)})"
        return f"; those that have: {plain(', '.join(sorted(self._neighbours)), 120)}"

    def neighbour(self, vehicle: str) -> None:
        """Note another vehicle at the broker, or this one by another version."""
        if len(self._neighbours) < NEIGHBOURS:
            self._neighbours.add(vehicle)

    def broker(self, *, up: bool) -> None:
        self._broker, self._word = up, None
        self._begin_anew()

    def connection(self, now: float, word: str) -> None:
        """Take the vehicle's connection state; after a new connection its headers may count anew."""
        if word != "ONLINE" or self._word != "ONLINE":
            self._begin_anew()
        self._word, self._last_message_at, self._first = word, now, True
        self._fastest_s = None

    def takes(self, now: float, state: VehicleState) -> bool:
        """True if a state is newer than the last, and so counts; notes a reboot if its headers begin anew."""
        self.has_booted = False
        last = self._last
        if not self.is_online:
            return False
        if last is not None and not self._first:
            behind = (last.header - state.header) % 2**32
            if behind < WRAP and state.timestamp <= last.timestamp:
                was = f"headerId {last.header} and timestamp {last.timestamp}"
                is_ = f"headerId {state.header} and timestamp {state.timestamp}"
                self.refuse(f"the last one has {is_}, which is not after {was}")
                return False
            self.has_booted = 0 < behind < WRAP  # some vehicles never count: their timestamps do
            self.boots += self.has_booted
        self._last, self._last_message_at, self._silent, self._first = state, now, False, False
        self._refused = ""
        return True

    def delay_s(self, now: float, state: VehicleState) -> float:
        """Time that a state was on its way beyond the fastest one; 0 where its timestamp is no time."""
        said = TIME.match(state.timestamp)
        if said is None:
            return 0.0
        hours, minutes, seconds = map(float, said.groups())
        took_s = now - (3600 * hours + 60 * minutes + seconds)
        fastest_s = took_s if self._fastest_s is None else self._fastest_s
        delay_s = (took_s - fastest_s + DAY_S / 2) % DAY_S - DAY_S / 2  # a new day begins with 0 again
        self._fastest_s = fastest_s + min(delay_s, 0.0)
        return max(delay_s, 0.0)

    def refuse(self, why: str) -> None:
        """Note a state that does not count; the reason is reported while no state does."""
        self._refused = plain(why, LONGEST_WHY)

    def lose(self, why: str) -> None:
        """Lose the link: no earlier state counts any more."""
        self._begin_anew()
        self.refuse(why)

    def falls_silent(self, now: float) -> bool:
        """True at the moment at which the last state has become too old."""
        before, self._silent = self._silent, now - self._last_message_at > self._settings.silent_after_s
        return self._silent and not before and self.is_online

    def _begin_anew(self) -> None:
        self._last, self._silent, self._refused = None, False, ""
