"""Difference between a device and its virtual one: what is said of it, and the fault that plays it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from arboleda.drivers import Robot
from arboleda.extension import Phrase, Sentence
from arboleda.model.plant_model import PlantModel
from arboleda_proofs.campaigns.plants import ELSEWHERE
from arboleda_proofs.simulator.faults import KINDS, Fault

LONGEST_WORD, NOT_ITS = 16, re.compile(r"[^A-Za-z0-9_.-]")  # a board's word for a failure
WITHOUT_S = 1.0  # of a fault behind which no time was told

RULES: Mapping[str, tuple[str, ...]] = {
    "silence": ("{robot} told nothing for {seconds:.1f} s", "mute"),
    "boot": ("{robot} booted, and was away for {seconds:.1f} s", "brown_out"),
    "alarm": ("{robot} told a fault of its own for {seconds:.1f} s", "driver_alarm"),
    "confirmed_late": ("{robot} confirmed a command after {amount:.1f} s", "delay down"),
    "unanswered": ("{robot} told nothing of a command", "partition down, lost"),
    "done_unconfirmed": ("{robot} told the end of a command that it had not confirmed", "stuck_bit ack"),
    "stopped_late": ("{robot} moved for {amount:.1f} s after a stop", "delay down"),
    "begins_after_stop": ("{robot} began to move {amount:.1f} s after a stop, by no command", "delay down"),
    "moves_by_itself": (
        "{robot} told for {seconds:.1f} s that it moves, by no command",
        "lying_telemetry estado",
    ),
    "done_moving": ("{robot} told that it is done, and that it moves", "stuck_bit estado"),
    "takes_longer": ("{robot} took {amount:.1f} s longer than declared", "ends_late"),
    "takes_less": ("{robot} took {amount:.1f} s less than declared",),
    "gave_up": ("{robot} gave up a command: {word}", "gives_up {board_word}", "driver_alarm"),
    "refused": ("{robot} refused a command in a word of its own: {word}", "refuses ocupado"),
    "let_go": ("{robot} told that it holds nothing any more, by no command", "opened_device"),
    "changed_by_itself": (
        "{robot} told another {word} for {seconds:.1f} s, by no command",
        "lying_fact {word}",
    ),
    "done_untrue": (
        "{robot} told that it is done, and another {word} than that for {seconds:.1f} s",
        "stale_fact {word}",
    ),
    "unknown": ("{robot} did not know its {word} for {seconds:.1f} s",),
    "other_fact": ("{robot} tells {word}, which its virtual one has not",),
    "unhomed": (
        "{robot} was not homed any more for {seconds:.1f} s, without a boot",
        "lying_telemetry ref",
    ),
    "jumped": ("{robot} told a place that it cannot have reached", "lying_telemetry {word}"),
    "beyond": ("{robot} told a place beyond its limits for {seconds:.1f} s",),
    "done_elsewhere": ("{robot} told that it is done, and another place than that", "lying_telemetry {word}"),
}
"""Kinds of differences: the sentence, and kind and word of each fault that plays it.

Of several faults the first that can befall the device counts. A virtual device refuses in no other words than
boards have. Where a command is late, all that the device tells of it is late, too.
"""

PHRASES = {rule: Phrase(f"unlike.{rule}", english) for rule, (english, *_) in RULES.items()}


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
        """The difference in words."""
        phrase = PHRASES[self.rule]
        return phrase(**{name: value for name, value in vars(self).items() if f"{{{name}" in phrase.english})

    def fault(self, robot: Robot, model: PlantModel) -> Fault | None:
        """The fault with which the virtual one tells the same; None where the simulator has none."""
        virtual = model.on_boards(*ELSEWHERE)
        for played in RULES[self.rule][1:]:
            kind, _, word = played.partition(" ")
            word = word.format(word=self.word, board_word=NOT_ITS.sub("_", self.word)[:LONGEST_WORD])
            seconds = self._played_s(kind)
            made = Fault(kind=kind, at=0.0, seconds=seconds, target=robot.mqtt, amount=self.amount, word=word)
            if KINDS[kind].objection(made, virtual) is None:
                return made
        return None

    def _played_s(self, kind: str) -> float:
        if not any(KINDS[kind].seconds):  # an instant
            return 0.0
        return 2 * self.amount if kind == "delay" else self.seconds or WITHOUT_S


class Spans:
    """Differences of one device that have begun, and are told once they are over."""

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
