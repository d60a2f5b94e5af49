"""Link to a device that is mapped by its topics: whether it is there, and whether it has booted."""

from __future__ import annotations

import math
import zlib

from arboleda.drivers import plain
from arboleda.wire.transport import Delivery
from arboleda_drivers.meaning import as_text
from arboleda_drivers.paths import NOTHING

from .heard import Source, matches
from .keys import Boot, Keys

TWINS_S = 10.0  # that two devices of one name are said after their boots have alternated
LONGEST = 100  # characters of topics in a sentence


class Link:
    """Link of one device, called `name` in its topics."""

    def __init__(self, settings: Keys, name: str) -> None:
        self._settings, self._name = settings, name
        self.broker = False
        self._is_there = settings.online is None  # by its last will
        self._said: str | None = None  # of its being there
        self._heard_at = -math.inf  # any message that was not retained
        self._is_silent = False
        self._twins_until = -math.inf
        self._shown: list[str] = []  # the last two boots as it tells them
        self.boot = 1

    def connected(self, *, up: bool) -> None:
        """Note that the broker is connected, or is lost."""
        self.broker, self._is_there = up, self._settings.online is None
        self._heard_at, self._is_silent, self._said = -math.inf, False, None

    def trouble(self, now: float) -> str | None:
        """The reason why there is no link, in a sentence; None if there is one."""
        online, silent_s = self._settings.online, self._settings.silent_after_s
        if not self.broker:
            return f"the MQTT broker at {self._settings.address} is not there"
        if online is not None and not self._is_there:
            where, meant = online.named(self._name), " or ".join(map(as_text, online.values))
            if self._said is None or not meant:
                return f"{self._name} has not said on {where} that it is there"
            return f"{self._name} has said {self._said} on {where}; it is there while it says {meant}"
        if now < self._twins_until:
            return (
                f"two devices call themselves {self._name}, as their boots alternate; give one another name"
            )
        if silent_s is not None and self._heard_at == -math.inf:
            return f"{self._name} has said nothing yet on {self.topics}"
        if self._is_silent:
            return f"{self._name} has said nothing for {silent_s:g} s on {self.topics}"
        return None

    @property
    def topics(self) -> str:
        """The topics on which it is heard."""
        named = dict.fromkeys(source.named(self._name) for source in self._settings.sources)
        return plain(", ".join(named), LONGEST)

    def is_on(self, source: Source | None, message: Delivery) -> bool:
        """True for a message on the topic of a source."""
        return source is not None and matches(source.named(self._name), message.topic)

    def falls_silent(self, now: float) -> bool:
        """True at the moment at which it has said nothing for too long."""
        silent_s, was = self._settings.silent_after_s, self._is_silent
        self._is_silent = silent_s is not None and -math.inf < self._heard_at < now - silent_s
        return self._is_silent and not was

    def see(self, now: float, message: Delivery) -> bool:
        """Take a message; True where it shows that whatever was open is over: it has left, or booted."""
        online, was = self._settings.online, self._is_there
        if not message.retain:
            self._heard_at, self._is_silent = now, False
        if self.is_on(online, message):
            assert online is not None
            self._is_there = online.is_said(message.payload)
            raw = online.raw(message.payload)
            self._said = plain("nothing" if raw is NOTHING else as_text(raw), LONGEST)
        return (was and not self._is_there) or self._see_boot(now, message)

    def _see_boot(self, now: float, message: Delivery) -> bool:
        boot = self._settings.boot
        if boot is None or message.retain or not self.is_on(boot, message):
            return False
        if (raw := boot.raw(message.payload)) is NOTHING:
            return False
        shown, before = as_text(raw), self._shown[-1:]
        if before == [shown] or not before or not _is_boot(boot, before[0], shown):
            self._shown = [*self._shown[:-1], shown]
            return False
        if shown in self._shown[:-1] and not boot.falls:
            self._twins_until = now + TWINS_S
        self._shown = [*before, shown]
        self.boot = self.boot + 1 if boot.falls else zlib.crc32(shown.encode())
        return True


def _is_boot(boot: Boot, before: str, shown: str) -> bool:
    if not boot.falls:
        return True
    try:
        return float(shown) < float(before)
    except ValueError:
        return False
