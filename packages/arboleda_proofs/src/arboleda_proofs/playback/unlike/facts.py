"""Watch over the facts of one device: they change at the end of a command that sets them, or by a person."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator

from arboleda.drivers import Command, Facts, Report, Robot, Value, VerbCommand

from .difference import Difference, Spans

PROMPT_S = 0.5  # within it a virtual device has been told, has answered, and has been heard


class FactWatch:
    """Watch over the facts of one device; what goes on is among the `spans`."""

    def __init__(self, robot: Robot, spans: Spans) -> None:
        self._spans = spans
        self._held = robot.held_fact
        self._virtual = robot.fact_names if robot.verb_names else ()
        self._odd: dict[str, Value] = {}  # facts that changed by no command, with their values before
        self._due: dict[str, Value] = {}  # facts that a done command has set, and that are not told so
        self._ended_at = -math.inf  # of the last command
        self._sets: tuple[str, ...] = ()  # the facts that it set

    def part(self) -> None:
        """Nothing was heard for a while, in which anything may have changed."""
        self._odd, self._due = {}, {}

    def end(self, command: Command, now: float) -> None:
        """Note the end of a command."""
        self._ended_at = now
        self._sets = self._virtual if _shows_more(command) else tuple(name for name, _ in command.sets)

    def compare(self, command: Command, report: Report) -> None:
        """Note what a done command has set, and the report of its end does not tell."""
        told = dict(report.facts or ())
        self._due = {name: value for name, value in self._due.items() if name not in self._sets}
        self._due |= {name: value for name, value in command.sets if told.get(name, value) != value}

    def look(
        self, report: Report, last: Facts | None, under_way: Collection[Command] | None, now: float
    ) -> Iterator[Difference]:
        """The differences in a report after the `last` facts; `under_way` is None where any may change."""
        before, spans = dict(last or ()), self._spans
        for name, value in report.facts or ():
            if name in self._virtual:
                self._follow(name, value, before.get(name, value), under_way, now)
                yield from spans.look("done_untrue", name, now, goes_on=self._due.get(name, value) != value)
                held = name == self._held and value is False
                yield from spans.look("let_go", name, now, goes_on=held and name in self._odd)
                yield from spans.look("changed_by_itself", name, now, goes_on=name in self._odd and not held)
            elif name not in before:
                yield spans.found("other_fact", now, word=name)
        for name in {*report.unknown, *spans.words("unknown")}:
            yield from spans.look("unknown", name, now, goes_on=name in report.unknown)

    def _follow(
        self, name: str, value: Value, before: Value, under_way: Collection[Command] | None, now: float
    ) -> None:
        by_command = self._is_by_command(name, value, under_way, now)
        if name in self._odd:
            if value == self._odd[name] or by_command:
                del self._odd[name]
        elif value != before and not by_command:
            self._odd[name] = before
        if self._due.get(name) == value:
            del self._due[name]

    def _is_by_command(
        self, name: str, value: Value, under_way: Collection[Command] | None, now: float
    ) -> bool:
        """True for a change that a virtual device shows by what it does, or has just done."""
        if under_way is None or name in self._due:
            return True
        if now - self._ended_at <= PROMPT_S and name in self._sets:
            return True
        return any((name, value) in each.sets or _shows_more(each) for each in under_way)


def _shows_more(command: Command) -> bool:
    """True where a function says what else a virtual device shows after a command."""
    return isinstance(command, VerbCommand) and command.definition.virtual is not None
