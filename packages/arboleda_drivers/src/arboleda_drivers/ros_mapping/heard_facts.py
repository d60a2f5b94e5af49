"""Facts of a device as its topics, its feedback and the results of its verbs tell them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from arboleda.drivers import Device, DriverError, Facts, FactType, Value
from arboleda_drivers.paths import field_at
from arboleda_drivers.plc.plc_snapshot import STATES
from arboleda_drivers.ros_action.presence import End

from .keys import Keys, Source

Told = End | tuple[str, str]
"""Where something is told: a topic, or ("feedback", verb) or ("result", verb)."""
STILL_S = 1.0  # a fact that has not changed for this time stands still
TEXT = FactType(type=str, first="")
STATE = FactType(type=str, words=tuple(STATES), first="stopped")


class ToldFacts:
    """Facts of one device; what nobody has told yet, or a verb may have changed since, is unknown."""

    def __init__(self, keys: Keys, device: Device) -> None:
        self._kinds = device.kind.facts
        self._sources = keys.facts
        self._from: dict[Told, list[tuple[str, Source, FactType]]] = {}
        for name, source in keys.facts.items():
            self._from.setdefault(_told_in(keys, source), []).append((name, source, self._kinds[name]))
        if keys.state is not None:
            row = ("", keys.state, STATE)
            self._from.setdefault(_told_in(keys, keys.state), []).append(row)
        self._values: dict[str, Value] = {}
        self._meant: dict[str, Value] = {}  # what verbs have set last
        self._changed_at: dict[str, float] = {}
        self._bad: dict[Told, str] = {}
        self._heard_at: dict[Told, float] = {}

    @property
    def topics(self) -> list[End]:
        return [told for told in self._from if isinstance(told, End)]

    @property
    def state(self) -> str:
        """The word of its own for what it does; "stopped" where none is mapped."""
        return str(self._values.get("", "stopped"))

    @property
    def facts(self) -> Facts:
        return tuple((name, value) for name, value in self._values.items() if name)

    @property
    def unknown(self) -> tuple[str, ...]:
        return tuple(name for name in self._sources if name not in self._values)

    def shows(self, facts: Facts) -> bool:
        """True where all these facts are told so."""
        return all(self._values.get(name) == value for name, value in facts)

    def changes(self, now: float, names: Iterable[str]) -> bool:
        """True where one of these facts has changed a moment ago."""
        return any(now < self._changed_at.get(name, -math.inf) + STILL_S for name in names)

    def missing(self, now: float) -> str:
        """The reason why the device is not known well enough; "" if it is."""
        for why in self._bad.values():
            return why
        for told, rows in self._from.items():
            at = self._heard_at.setdefault(told, now)
            if any(not name for name, _, _ in rows) and "" not in self._values:
                return f"{_name(told)} has said nothing yet"
            silent_s = max(source.silent_s for _, source, _ in rows)
            if silent_s and now >= at + silent_s:
                return f"{_name(told)} has said nothing for {silent_s:g} s"
        return ""

    def hear(self, now: float, told: Told, message: object) -> None:
        self._heard_at[told] = now
        self._bad.pop(told, None)
        for name, source, of in self._from.get(told, []):
            try:
                raw, where = field_at(source.path, message), f"{_name(told)} {source.path}"
                value = self._read(name, source, of, raw, where)
                if name in self._values and self._values[name] != value:
                    self._changed_at[name] = now
                self._values[name] = value
            except DriverError as error:
                self._values.pop(name, None)
                if isinstance(told, End):
                    self._bad[told] = str(error)

    def _read(self, name: str, source: Source, of: FactType, raw: object, where: str) -> Value:
        """The value; a number near the one that a verb has set last is that one."""
        exact = replace(source, near=0.0).value(raw, of, where) if source.near and not of.words else None
        meant = self._meant.get(name)
        numbers = isinstance(exact, int | float) and isinstance(meant, int | float)
        if numbers and abs(float(exact) - float(meant)) <= source.near:  # type: ignore[arg-type]
            return meant  # type: ignore[return-value]
        return source.value(raw, of, where)

    def begin(self, verb: str, sets: Facts) -> None:
        """A verb is sent: what only its end tells is unknown until then."""
        self._meant |= dict(sets)
        touched = {name for name, _ in sets if not self._sources[name].topic}
        for told in (("feedback", verb), ("result", verb)):
            touched |= {name for name, _, _ in self._from.get(told, [])}
        self.forget(touched)

    def end(self, sets: Facts) -> None:
        """A verb has ended well: take its word for what it sets, where nothing else tells that."""
        self._values |= {name: value for name, value in sets if self._sources[name].done}

    def forget(self, names: Iterable[str]) -> None:
        for name in names:
            self._values.pop(name, None)

    def began_anew(self, ends: Iterable[End]) -> None:
        """These were started anew: what they told before counts no more, nor what verbs told."""
        ends = set(ends)
        is_server = any(end.kind != "topic" for end in ends)
        for told, rows in self._from.items():
            if told in ends or (is_server and not isinstance(told, End)):
                self.forget(name for name, _, _ in rows)
                self._heard_at.pop(told, None)
                self._bad.pop(told, None)


def _told_in(keys: Keys, source: Source) -> Told:
    if source.topic:
        return End("topic", keys.full(source.topic))
    if source.done:
        return ("done", "")
    return ("feedback" if source.feedback else "result", keys.verb_of(source))


def _name(told: Told) -> str:
    return told.name if isinstance(told, End) else " of ".join(told)
