"""Ends of commands to a vehicle's devices, for the reports of each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from arboleda.drivers import Command, FactType, Query, Value, VerbCommand, plain, shown

WORDS = {"rejected": "refusal", "failed": "failure", "answered": "answer"}


class Answers:
    """Ends of commands by the names of devices, and the fields of their reports."""

    def __init__(self, devices: Iterable[str]) -> None:
        self._fields: dict[str, dict[str, Any]] = {name: {} for name in devices}

    def of(self, device: str) -> Mapping[str, Any]:
        return self._fields[device]

    def say(self, command: Command, what: str, word: Value | None = None) -> None:
        fields = self._fields[command.robot]
        fields[what] = command.id
        if word is not None:
            fields[WORDS[what]] = plain(word, 100) if isinstance(word, str) else word

    def end(self, command: Command, result: str | None) -> None:
        """Say that a command is done, or answered with this result."""
        if isinstance(command, Query):
            self.say(command, "answered", _answer(command, result))
        else:
            self.say(command, "done")

    def forget(self) -> None:
        for fields in self._fields.values():
            fields.clear()


def _answer(command: Query, result: str | None) -> Value:
    """The answer of the kind that these words mean, else the words."""
    if not isinstance(command, VerbCommand):
        return result or ""
    if command.definition.number is not None:
        return _number(result or "", command.definition.number)
    return next((each for each in command.definition.answers if shown(each) == result), result or "")


def _number(text: str, type: FactType) -> Value:
    """The number that a text means, else the text."""
    try:
        return type.type(text)
    except ValueError:
        return text
