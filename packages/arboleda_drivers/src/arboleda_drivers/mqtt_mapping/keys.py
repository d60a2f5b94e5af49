"""Keys of the driver `mqtt` in a plant file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal

from arboleda.drivers import DriverError

from .heard import REPLY, Heard, Says, Source
from .sent import Sent

BROKER = "127.0.0.1:1883"  # of a plant that has found its port free


@dataclass(frozen=True, kw_only=True)
class Verb:
    """Messages that are sent for a verb, and what says how it goes on where that is not said for all verbs.

    `answer` is the answer to a query, and `id` the path of the command's id in the same message.
    """

    send: tuple[Sent, ...] = ()
    accepted: Says | None = None
    done: Says | None = None
    failed: Says | None = None
    answer: Heard | None = None
    id: str = ""

    @property
    def names_command(self) -> bool:
        """True where the answer to a query names its command."""
        return bool(self.id) or (self.answer is not None and self.answer.is_reply)


@dataclass(frozen=True, kw_only=True)
class Boot(Source):
    """Value that changes with each boot of a device; an uptime `falls` then, and else only rises."""

    falls: bool = False


@dataclass(frozen=True, kw_only=True)
class Still:
    """Facts of a device that moves while one of them changes, and has stopped once none has for `for_s`."""

    facts: tuple[str, ...]
    for_s: float = 1.0

    def __post_init__(self) -> None:
        if not self.facts:
            raise DriverError("facts is empty; name the facts that change while it moves")
        if not 0.2 <= self.for_s <= 60:
            raise DriverError(f"for_s is {self.for_s:g}; allowed: 0.2 to 60")


@dataclass(frozen=True, kw_only=True)
class Keys:
    """Keys of the driver `mqtt`: what a device hears and says at its topics.

    Without `broker` it is at the plant's. `accepted`, `done` and `failed` are for all verbs. It is there
    while `online` is said last, and nothing for `silent_after_s` is silence; at least one of them is needed.
    `ask` has it tell its facts and its state where some are not known; it never tells those that are
    `unheard`. `names` are names of devices in their topics, where these differ from the plant's.
    """

    broker: str = ""
    version: Literal["3.1.1", "5"] = "3.1.1"
    names: dict[str, str] = field(default_factory=dict)
    online: Says | None = None
    silent_after_s: float | None = None
    boot: Boot | None = None
    state: Heard | None = None
    still: Still | None = None
    facts: dict[str, Heard] = field(default_factory=dict)
    unheard: tuple[str, ...] = ()
    verbs: dict[str, Verb] = field(default_factory=dict)
    accepted: Says | None = None
    done: Says | None = None
    failed: Says | None = None
    ask: tuple[Sent, ...] = ()
    halt: tuple[Sent, ...] = ()
    latch: tuple[Sent, ...] = ()
    clear: tuple[Sent, ...] = ()

    def __post_init__(self) -> None:
        if self.online is None and self.silent_after_s is None:
            how = "online: {hear: tele/lamp/LWT, equals: Online}, or silent_after_s: 30"
            raise DriverError(f"nothing says whether the device is there; write {how}")
        if self.silent_after_s is not None and not 0.5 <= self.silent_after_s <= 86400:
            raise DriverError(f"silent_after_s is {self.silent_after_s:g}; allowed: 0.5 to 86400")
        if self.state is not None and self.still is not None:
            raise DriverError("has state and still; keep one of them")
        if self.version != "5" and any(each.is_reply for each in self.sources):
            raise DriverError(f'only MQTT 5 has {REPLY}; write version: "5"')

    @property
    def address(self) -> str:
        """The address of its broker, for who is no plant."""
        return self.broker or BROKER

    def name_of(self, device: str) -> str:
        """The name of a device in its topics."""
        return self.names.get(device, device)

    def accepts(self, verb: str) -> Says | None:
        return self.verbs[verb].accepted or self.accepted

    def ends(self, verb: str) -> Says | None:
        return self.verbs[verb].done or self.done

    def fails(self, verb: str) -> Says | None:
        return self.verbs[verb].failed or self.failed

    @property
    def sources(self) -> Iterator[Source]:
        """All that is heard."""
        found = (self.online, self.boot, self.state, self.accepted, self.done, self.failed)
        yield from (each for each in found if each is not None)
        yield from self.facts.values()
        for verb in self.verbs.values():
            told = (verb.accepted, verb.done, verb.failed, verb.answer)
            yield from (each for each in told if each is not None)
