"""Difference between a device and its virtual one: what is said of it, and the fault that plays it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from arboleda.drivers import Robot
from arboleda.extension import Phrase, Sentence
from arboleda.model.plant_model import PlantModel
from arboleda_proofs.campaigns.plants import ELSEWHERE
from arboleda_proofs.simulator.faults import KINDS, Fault

LONGEST_WORD, NOT_ITS = 16, re.compile(r"[^A-Za-z0-9_.-]")  # a board's word for a failure
TAKEN_AS = "ocupado"  # a virtual device refuses in no other words than boards have
WITHOUT_S = 1.0  # of a fault behind which no time was told


@dataclass(frozen=True, kw_only=True)
class Difference:
    """Difference, at `at` on the plant's clock for `seconds`; `word` is a fact, a joint, or what it said."""

    rule: str
    robot: str
    at: float
    seconds: float = 0.0
    amount: float = 0.0
    word: str = ""

    @property
    def sentence(self) -> Sentence:
        """What the device told, in words."""
        phrase = PHRASES[self.rule]
        values: dict[str, str | float] = {
            "robot": self.robot,
            "seconds": self.seconds,
            "amount": self.amount,
            "word": self.word,
        }
        return phrase(**{name: values[name] for name in values if f"{{{name}" in phrase.english})

    def fault(self, robot: Robot, model: PlantModel) -> Fault | None:
        """The fault with which the virtual one tells the same; None where the simulator has none."""
        virtual = model.on_boards(*ELSEWHERE)
        for make in FAULTS.get(self.rule, ()):
            made = Fault(at=0.0, **{"target": robot.mqtt, **make(self)})
            if KINDS[made.kind].objection(made, virtual) is None:
                return made
        return None


Make = Callable[[Difference], Mapping[str, Any]]


def _lasting(kind: str, word: str = "") -> Make:
    return lambda found: {"kind": kind, "seconds": found.seconds or WITHOUT_S, "word": word}


def _late(found: Difference) -> Mapping[str, Any]:
    """What it hears comes late, so all that it tells of that does, too."""
    return {"kind": "delay", "word": "down", "amount": found.amount, "seconds": 2 * found.amount}


def _of_word(kind: str) -> Make:
    return lambda found: {"kind": kind, "seconds": found.seconds or WITHOUT_S, "word": found.word}


def _off(found: Difference) -> Mapping[str, Any]:
    return {**_of_word("lying_telemetry")(found), "amount": found.amount}


def _gives_up(found: Difference) -> Mapping[str, Any]:
    word = NOT_ITS.sub("_", found.word)[:LONGEST_WORD]
    return {"kind": "gives_up", "seconds": WITHOUT_S, "word": word}


def _takes_longer(found: Difference) -> Mapping[str, Any]:
    return {"kind": "ends_late", "seconds": WITHOUT_S, "amount": found.amount}


def _instant(kind: str) -> Make:
    return lambda found: {"kind": kind}


PHRASES = {
    "silence": Phrase("unlike.silence", "{robot} told nothing for {seconds:.1f} s"),
    "boot": Phrase("unlike.boot", "{robot} booted, and was away for {seconds:.1f} s"),
    "alarm": Phrase("unlike.alarm", "{robot} told a fault of its own for {seconds:.1f} s"),
    "confirmed_late": Phrase("unlike.confirmed_late", "{robot} confirmed a command after {amount:.1f} s"),
    "unanswered": Phrase("unlike.unanswered", "{robot} told nothing of a command"),
    "done_unconfirmed": Phrase(
        "unlike.done_unconfirmed",
        "{robot} told the end of a command that it had not confirmed",
    ),
    "stopped_late": Phrase("unlike.stopped_late", "{robot} moved for {amount:.1f} s after a stop"),
    "begins_after_stop": Phrase(
        "unlike.begins_after_stop",
        "{robot} began to move {amount:.1f} s after a stop, by no command",
    ),
    "moves_by_itself": Phrase(
        "unlike.moves_by_itself",
        "{robot} told for {seconds:.1f} s that it moves, by no command",
    ),
    "done_moving": Phrase("unlike.done_moving", "{robot} told that it is done, and that it moves"),
    "takes_longer": Phrase("unlike.takes_longer", "{robot} took {amount:.1f} s longer than declared"),
    "takes_less": Phrase("unlike.takes_less", "{robot} took {amount:.1f} s less than declared"),
    "gave_up": Phrase("unlike.gave_up", "{robot} gave up a command: {word}"),
    "refused": Phrase("unlike.refused", "{robot} refused a command in a word of its own: {word}"),
    "let_go": Phrase("unlike.let_go", "{robot} told that it holds nothing any more, by no command"),
    "changed_by_itself": Phrase(
        "unlike.changed_by_itself",
        "{robot} told another {word} for {seconds:.1f} s, by no command",
    ),
    "done_untrue": Phrase(
        "unlike.done_untrue",
        "{robot} told that it is done, and another {word} than that for {seconds:.1f} s",
    ),
    "unknown": Phrase("unlike.unknown", "{robot} did not know its {word} for {seconds:.1f} s"),
    "other_fact": Phrase("unlike.other_fact", "{robot} tells {word}, which its virtual one has not"),
    "unhomed": Phrase("unlike.unhomed", "{robot} was not homed any more for {seconds:.1f} s, without a boot"),
    "jumped": Phrase("unlike.jumped", "{robot} told a place that it cannot have reached"),
    "beyond": Phrase("unlike.beyond", "{robot} told a place beyond its limits for {seconds:.1f} s"),
    "done_elsewhere": Phrase(
        "unlike.done_elsewhere",
        "{robot} told that it is done, and another place than that",
    ),
}
"""All kinds of differences, each with what is said of it."""

FAULTS: Mapping[str, tuple[Make, ...]] = {
    "silence": (_lasting("mute"),),
    "boot": (_lasting("brown_out"),),
    "alarm": (_lasting("driver_alarm"),),
    "confirmed_late": (_late,),
    "unanswered": (_lasting("partition", "down, lost"),),
    "done_unconfirmed": (_lasting("stuck_bit", "ack"),),
    "stopped_late": (_late,),
    "begins_after_stop": (_late,),
    "moves_by_itself": (_lasting("lying_telemetry", "estado"),),
    "done_moving": (_lasting("stuck_bit", "estado"),),
    "takes_longer": (_takes_longer,),
    "gave_up": (_gives_up, _lasting("driver_alarm")),
    "refused": (_lasting("refuses", TAKEN_AS),),
    "let_go": (_instant("opened_device"),),
    "changed_by_itself": (_of_word("lying_fact"),),
    "done_untrue": (_of_word("stale_fact"),),
    "unhomed": (_lasting("lying_telemetry", "ref"),),
    "jumped": (_off,),
    "done_elsewhere": (_off,),
}
"""The faults that play them; of several the first counts that can befall the device."""


class Spans:
    """What goes on at one device: differences that have begun, and are told once they are over."""

    def __init__(self, robot: str) -> None:
        self._robot = robot
        self._begun: dict[tuple[str, str], Difference] = {}

    def found(self, rule: str, at: float, **told: Any) -> Difference:
        return Difference(rule=rule, robot=self._robot, at=at, **told)

    def words(self, rule: str) -> list[str]:
        """The words of what goes on of this kind."""
        return [word for each, word in self._begun if each == rule]

    def look(
        self, rule: str, word: str, now: float, *, goes_on: bool, amount: float = 0.0
    ) -> Iterator[Difference]:
        """The difference, if it is over with this look."""
        if goes_on:
            self._begun.setdefault((rule, word), self.found(rule, now, word=word, amount=amount))
        elif (rule, word) in self._begun:
            begun = self._begun.pop((rule, word))
            yield replace(begun, seconds=now - begun.at)

    def until(self, now: float) -> list[Difference]:
        """All that goes on, as it is by now."""
        return [replace(each, seconds=now - each.at) for each in self._begun.values()]

    def end(self, now: float) -> list[Difference]:
        """The same, and it is over."""
        found = self.until(now)
        self._begun.clear()
        return found
