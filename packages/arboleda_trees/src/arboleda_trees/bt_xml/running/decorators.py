"""Decorators: nodes around one child."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from py_trees.common import Status

from arboleda.drivers import quoted
from arboleda.recipes import Phrase

from .memory import Scope, Value
from .node import ENDED, FAILURE, PAUSE_S, RUNNING, SKIPPED, SUCCESS, TICK_S, Decorator, Node, Result
from .ports import NodePorts
from .scripts import Script, ScriptError

STATUSES = {each.value: each for each in Result}
NO_STATUS = Phrase("xml.no_status", "{word} is no status; there are {known}")
NO_RATE = Phrase("xml.no_rate", "hz of {node} must be more than 0")


class ResultDecorator(Decorator):
    """Decorator that turns each result of its child into another one, by `ends`."""

    def __init__(self, name: str, child: Node, ends: Mapping[Result, Result]) -> None:
        super().__init__(name, [child])
        self.ends = ends

    def work(self) -> Result:
        self.begin()
        result = self.child.execute()
        if result not in ENDED:
            return result
        self.child.reset()
        return self.ends[result]


INVERTED = {SUCCESS: FAILURE, FAILURE: SUCCESS}
ALL_DONE = {SUCCESS: SUCCESS, FAILURE: SUCCESS}
ALL_FAILED = {SUCCESS: FAILURE, FAILURE: FAILURE}


class KeepRunningUntilFailure(Decorator):
    """Decorator that repeats its child until it fails."""

    def work(self) -> Result:
        self.begin()
        result = self.child.execute()
        if result in ENDED:
            self.child.reset()
        if result is FAILURE:
            return FAILURE
        return RUNNING if result is RUNNING else self.again(after_s=PAUSE_S)


class Loop(Decorator):
    """Decorator that repeats its child while its result is `goes_on`, for so many rounds; -1: without end.

    A pause follows a round that took no time: a tree may be ticked only so often at one instant.
    """

    counts = ("rounds",)

    def __init__(self, name: str, child: Node, ports: NodePorts, *, port: str, goes_on: Result) -> None:
        super().__init__(name, [child])
        self.ports = ports
        self.port = port
        self.goes_on: Result = goes_on
        self.rounds = 0
        self.round_began = -math.inf

    def reset_counts(self) -> None:
        self.rounds = 0

    def most(self, scope: Scope) -> int:
        """The number of rounds that the variables of a scope mean."""
        return int(self.ports.number(self.port, scope))

    def work(self) -> Result:
        most = self.ports.number(self.port, self.scope)
        self.begin()
        while self.rounds < most or most == -1:
            if self.child.status is Status.INVALID:
                self.round_began = self.time.now
            result = self.child.execute()
            if result is RUNNING:
                return RUNNING
            self.child.reset()
            if result is SKIPPED:
                return SKIPPED
            if result is not self.goes_on:
                self.rounds = 0
                return result
            self.rounds += 1
            if self.goes_on is FAILURE:
                most = self.ports.number(self.port, self.scope)
            took_no_time = self.round_began == self.time.now
            if took_no_time and (self.rounds < most or most == -1):
                return self.again(after_s=PAUSE_S if most == -1 else TICK_S)
        self.rounds = 0
        return self.goes_on


class TimedDecorator(Decorator):
    """Decorator with a time, which begins anew after a restart of the plant."""

    is_limit = True
    counts = ("started",)

    def __init__(self, name: str, child: Node, ports: NodePorts, port: str) -> None:
        super().__init__(name, [child])
        self.ports = ports
        self.port = port
        self.started = False
        self.until = 0.0

    def reset_counts(self) -> None:
        self.started = False

    def begin_anew(self) -> None:
        if self.started:
            self.start()

    def start(self) -> None:
        """Begin to count the time."""
        self.started = True
        self.begin()
        self.until = self.time.now + self.ports.number(self.port, self.scope) / 1000
        self.time.wake_at(self.until)


class Timeout(TimedDecorator):
    """Decorator that halts its child and fails after so many milliseconds; 0 means never."""

    def work(self) -> Result:
        if not self.started:
            self.start()
        endless = self.ports.number(self.port, self.scope) <= 0
        if not endless and self.child.status is Status.RUNNING and self.time.now >= self.until:
            self.child.reset()
            self.started = False
            return FAILURE
        result = self.child.execute()
        if result in ENDED:
            self.started = False
            self.child.reset()
        return result


class Delay(TimedDecorator):
    """Decorator that begins its child after so many milliseconds."""

    def work(self) -> Result:
        if not self.started:
            self.start()
        if self.time.now < self.until:
            return RUNNING
        result = self.child.execute()
        if result in ENDED:
            self.started = False
            self.child.reset()
        return result


class RunOnce(Decorator):
    """Decorator that runs its child once. After that it is skipped, or has its child's result again."""

    counts = ("ended_as",)

    def __init__(self, name: str, child: Node, ports: NodePorts) -> None:
        super().__init__(name, [child])
        self.ports = ports
        self.ended_as = ""

    def work(self) -> Result:
        if self.ended_as:
            skips = self.ports.is_set("then_skip", self.scope, "true")
            return SKIPPED if skips else STATUSES[self.ended_as]
        self.begin()
        result = self.child.execute()
        if result in ENDED:
            self.ended_as = result.value
            self.child.reset()
        return result


class Precondition(Decorator):
    """Decorator that runs its child if a script is true when it begins."""

    counts = ("is_under_way",)

    def __init__(self, name: str, child: Node, ports: NodePorts) -> None:
        super().__init__(name, [child])
        self.ports = ports
        self.script = Script.of(ports.texts["if"])
        self.is_under_way = False

    def work(self) -> Result:
        if not self.is_under_way:
            self.is_under_way = self.script.holds(self.scope)
        if not self.is_under_way:
            return status(self.ports.text("else", self.scope, "FAILURE"))
        result = self.child.execute()
        if result in ENDED:
            self.child.reset()
            self.is_under_way = False
        return result


def status(word: Value) -> Result:
    """The result that a word of a port means."""
    if str(word) not in STATUSES:
        raise ScriptError(NO_STATUS(word=quoted(word), known=tuple(STATUSES)))
    return STATUSES[str(word)]


class ForEach(Decorator):
    """Decorator that runs its child for each value of a list; it fails as soon as the child fails."""

    counts = ("left", "number", "is_under_way")

    def __init__(
        self, name: str, child: Node, ports: NodePorts, *, source: str, out: str, if_empty: str = "SUCCESS"
    ) -> None:
        super().__init__(name, [child])
        self.ports = ports
        self.source = source
        self.out = out
        self.if_empty = if_empty
        self.left: list[str] = []
        self.number = 0
        self.is_under_way = False

    def reset_counts(self) -> None:
        self.left, self.number, self.is_under_way = [], 0, False

    def work(self) -> Result:
        if self.status is Status.INVALID:
            self.reset_counts()
            self.left = _items(self.ports.text(self.source, self.scope))
        if not self.is_under_way:
            if not self.left:
                return status(self.ports.text("if_empty", self.scope, self.if_empty))
            self._hand_out()
        self.begin()
        result = self.child.execute()
        self.is_under_way = result is RUNNING
        if result is RUNNING:
            return RUNNING
        if result in ENDED:
            self.child.reset()
        return FAILURE if result is FAILURE else self.again()

    def _hand_out(self) -> None:
        value, *self.left = self.left
        if self.out in self.ports.texts:
            self.scope.set(self.ports.variable(self.out), value)
        if "index" in self.ports.texts:
            self.scope.set(self.ports.variable("index"), self.number)
        self.number += 1


def _items(value: Value) -> list[str]:
    """The items of a list written as text, with semicolons between them."""
    return [each.strip() for each in str(value).split(";") if each.strip()]


class RateController(Decorator):
    """Decorator that repeats its child only after a time, counted from its last end."""

    counts = ("has_begun",)

    def __init__(self, name: str, child: Node, ports: NodePorts) -> None:
        super().__init__(name, [child])
        self.ports = ports
        self.has_begun = False
        self.until = 0.0

    def begin_anew(self) -> None:
        self._wait()

    def work(self) -> Result:
        if self.begin():
            self.has_begun = False
            self._wait()
        is_due = self.time.now >= self.until
        if self.has_begun and self.child.status is not Status.RUNNING and not is_due:
            return RUNNING
        self.has_begun = True
        result = self.child.execute()
        if result is SUCCESS:
            self._wait()
        return result

    def _wait(self) -> None:
        hz = self.ports.number("hz", self.scope, "10.0")
        if hz <= 0:
            raise ScriptError(NO_RATE(node=self.name))
        self.until = self.time.now + 1 / hz
        self.time.wake_at(self.until)


class SubTree(Decorator):
    """Decorator around a tree with variables of its own, whose values are kept with it."""

    def work(self) -> Result:
        self.begin()
        result = self.child.execute()
        if result in ENDED:
            self.child.reset()
        return result

    def kept(self) -> Mapping[str, Any] | None:
        return self.child.scope.kept()

    def restore(self, state: Mapping[str, Any]) -> None:
        self.child.scope.restore(state)
