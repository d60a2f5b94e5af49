"""Resolver of a wiring file: from it and its kind to tables; every mistake with its line."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from arboleda.drivers import Device, DeviceVerb, Effect
from arboleda.plant_file.document import Document, Place
from arboleda.plant_file.user_file import read_bytes

from . import parts
from .driving import Driving
from .naming import unknown
from .readings import Readings
from .shapes import Wiring, read
from .tables import Tables, Verb
from .values import encoded

LARGEST = 100_000
MOST_VALUES = 6


def tables(device: Device, path: Path) -> Tables:
    """The tables of a wiring; ConfigError with every problem of the file."""
    document = Document(str(path), read_bytes(path, LARGEST), path.parent)
    resolver = Resolver(document, device, read(document))
    made = resolver.tables()
    document.finish()
    return made


class Resolver:
    """Reads one file for one device; problems are kept in the document."""

    def __init__(self, document: Document, device: Device, wiring: Wiring) -> None:
        self._document, self._device, self._kind, self._wiring = document, device, device.kind, wiring
        self._readings = Readings(document, wiring)
        self._driving = Driving(document, wiring, device.kind)
        self._facts = {name: at for at, name in enumerate(self._kind.facts)}

    def tables(self) -> Tables:
        parts.check(self._document, self._device, self._wiring)
        self._same_names(("facts",), self._wiring.facts, self._kind.facts, "fact")
        self._same_names(("verbs",), self._wiring.verbs, self._kind.verbs, "verb")
        facts = tuple(self._readings.fact(name, type) for name, type in self._kind.facts.items())
        commanded = {fact.name for fact in facts if fact.source == "kTold"}
        verbs = tuple(self._verb(verb, commanded) for verb in self._kind.verbs.values())
        unseen = {name for verb in self._kind.verbs.values() for name, _ in verb.sets} & commanded
        return Tables(
            name=self._device.mqtt,
            wiring=self._wiring,
            facts=facts,
            verbs=verbs,
            unseen=tuple(name for name in self._kind.facts if name in unseen),
        )

    def _verb(self, verb: DeviceVerb, commanded: set[str]) -> Verb:
        place: Place = ("verbs", verb.name)
        shape = self._wiring.verbs.get(verb.name)
        if verb.sets_by is not None or verb.takes_s_by is not None:
            self._document.problem(
                place, "its kind computes in Python what it sets or how long it takes; this board cannot"
            )
        if len(verb.parameters) > MOST_VALUES:
            self._document.problem(place, f"a board has room for {MOST_VALUES} values of a verb")
        timed = verb.effect is Effect.QUERY or all(name in commanded for name, _ in verb.sets)
        least_s = shape.at_least_s if shape else None
        at_least_s = least_s if least_s is not None else verb.takes_s if timed else 0.0
        if at_least_s > verb.at_most_s:
            self._document.problem(
                place, f"at_least_s is {at_least_s:g}, and its kind gives it up after {verb.at_most_s:g} s"
            )
        return Verb(
            declared=verb,
            sets=tuple(self._driving.sets(place, verb)),
            needs=tuple(
                (self._facts[name], encoded(self._kind.facts[name], value)) for name, value in verb.needs
            ),
            start=tuple(self._driving.actions((*place, "start"), verb, shape.start if shape else {})),
            end=tuple(self._driving.actions((*place, "end"), verb, shape.end if shape else {})),
            answer=self._readings.answer(place, verb),
            at_least_s=at_least_s,
            held_fact=self._facts[verb.held[0]] if verb.holds else -1,
        )

    def _same_names(
        self, place: Place, wired: Mapping[str, object], known: Mapping[str, object], what: str
    ) -> None:
        for name in wired:
            if name not in known:
                unknown(self._document, (*place, name), name, known, f"{what} of a {self._kind.name}")
        for name in known:
            if name not in wired:
                self._document.problem(
                    place, f"{name} is missing: each {what} of a {self._kind.name} is wired"
                )
