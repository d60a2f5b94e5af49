"""Meaning of a drawn recipe: what its steps tell each device, in their order, and how long they wait at
least, where nothing goes wrong.

It reads the plain data from which the recipe was written in Python or as XML, and runs none of that.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from . import steps
from .steps import Param, Recipe, Step, Value

Told = tuple[str, tuple[Value, ...]]  # a verb and its values, as `plain` writes them
TakesS = Callable[[str, Told], float]  # of a role's verb, s


class Unsure(Exception):
    """Nobody can say what the recipe does: an answer is missing, or a parallel was left."""


def plain(value: object) -> Value:
    """A value as every form of a recipe has it: numbers and truth values are floats."""
    words = {"true": 1.0, "false": 0.0}
    if isinstance(value, bool | int | float):
        return float(value)
    try:
        return words[str(value)] if str(value) in words else float(str(value))
    except ValueError:
        return str(value)


@dataclass(kw_only=True)
class Scope:
    """Values of one recipe: those of its parameters, and what was answered."""

    values: Mapping[str, object] = field(default_factory=dict)
    answers: dict[str, Value] = field(default_factory=dict)

    def value(self, written: object) -> object:
        return self.values[written.name] if isinstance(written, Param) else written


class Meaning:
    """Reader of drawn recipes; `orders` are those to each role, `seconds` how long it waits at least, and
    `cause` the words of the step that failed last, None where that has none of its own.

    `answers` are those to the questions of each role, in their order; `pauses`: a retry has its pause.
    """

    def __init__(
        self,
        recipes: Iterable[Recipe],
        answers: Mapping[str, Sequence[Value]],
        takes_s: TakesS,
        *,
        pauses: bool = True,
    ) -> None:
        self.orders: dict[str, list[Told]] = {}
        self.seconds = 0.0
        self.cause: str | None = None
        self._reason = ""  # of the failure that came last, where that is known
        self._pauses = pauses
        self._recipes = {each.name: each for each in recipes}
        self._answers = {role: deque(those) for role, those in answers.items()}
        self._takes_s = takes_s

    def run(self, recipe: str, values: Mapping[str, object]) -> bool:
        """Take a recipe in; whether it succeeds. Raises Unsure."""
        return self._does(self._recipes[recipe].step, Scope(values=values))

    def _does(self, step: Step, scope: Scope) -> bool:
        read = getattr(self, f"_{type(step).__name__.lower()}", None)
        return True if read is None else read(step, scope)

    def _tell(self, step: steps.Tell, scope: Scope) -> bool:
        if step.refused:
            self.cause, self._reason = None, ""
            return False
        self.orders.setdefault(step.role, []).append(_order(step, scope))
        if step.answer:
            scope.answers[step.answer] = self._answer(step.role)
        return True

    def _ask(self, step: steps.Ask, scope: Scope) -> bool:
        scope.answers[step.answer] = self._answer(step.role)
        return True

    def _answer(self, role: str) -> Value:
        left = self._answers.get(role)
        if not left:
            raise Unsure
        return left.popleft()

    def _fail(self, step: steps.Fail, scope: Scope) -> bool:
        self.cause, self._reason = step.sentence, "rejected"
        return False

    def _wait(self, step: steps.Wait, scope: Scope) -> bool:
        self.seconds += step.seconds
        return True

    def _visit(self, step: steps.Visit, scope: Scope) -> bool:
        return self._does(step.body, scope)

    def _work(self, step: steps.Work, scope: Scope) -> bool:
        return all(self._does(each, scope) for each in step.steps)

    def _parallel(self, step: steps.Parallel, scope: Scope) -> bool:
        began = self.seconds
        ends: list[float] = []
        failing: list[float] = []
        for each in step.branches:
            self.seconds = began
            (ends if self._does(each, scope) else failing).append(self.seconds)
        self.seconds = min(failing) if failing else max(ends)
        if failing and not all(isinstance(each, steps.Tell) for each in step.branches[len(failing) :]):
            raise Unsure  # how far the others came by then is a matter of time
        return not failing

    def _choose(self, step: steps.Choose, scope: Scope) -> bool:
        answer = scope.answers[step.answer]
        return self._does(next(way for value, way in step.ways if _is_of(value, answer)), scope)

    def _retry(self, step: steps.Retry, scope: Scope) -> bool:
        for number in range(step.times + 1):
            self.seconds += step.pause_s if number and self._pauses else 0.0
            if self._does(step.step, scope):
                return True
            if step.causes and self._reason not in step.causes:
                return False
        return False

    def _repeat(self, step: steps.Repeat, scope: Scope) -> bool:
        return all(self._does(step.step, scope) for _ in range(step.times))

    def _timeout(self, step: steps.Timeout, scope: Scope) -> bool:
        until = self.seconds + step.seconds
        succeeds = self._does(step.step, scope)
        if isinstance(step.step, steps.Tell) and step.seconds == self._told_s(step.step, scope):
            raise Unsure  # both ends are of the same instant
        if not self._is_late(step, scope):
            return succeeds
        self.seconds, self.cause, self._reason = until, None, "deadline"
        return False

    def _is_late(self, step: steps.Timeout, scope: Scope) -> bool:
        if isinstance(step.step, steps.Tell):
            return step.seconds < self._told_s(step.step, scope)
        return isinstance(step.step, steps.Wait) and step.seconds < step.step.seconds

    def _told_s(self, step: steps.Tell, scope: Scope) -> float:
        return self._takes_s(step.role, _order(step, scope))

    def _fallback(self, step: steps.Fallback, scope: Scope) -> bool:
        *before, last = step.steps
        for each in before:
            if self._does(each, scope) and not isinstance(each, steps.Says):  # drawn so that it fails
                return True
        return self._does(last, scope)

    def _recover(self, step: steps.Recover, scope: Scope) -> bool:
        if self._does(step.work, scope):
            return True
        cause = self.cause
        self._does(step.rescue, scope)
        self.cause = cause
        return False

    def _invert(self, step: steps.Invert, scope: Scope) -> bool:
        self._does(step.step, scope)  # drawn so that it fails
        return True

    def _using(self, step: steps.Using, scope: Scope) -> bool:
        return self._does(step.step, scope)

    def _run(self, step: steps.Run, scope: Scope) -> bool:
        return self.run(step.recipe, {name: scope.value(value) for name, value in step.values})


def _is_of(value: Value | steps.Range, answer: Value) -> bool:
    """True if a way is that of an answer; the range of all other numbers comes last."""
    return value.has(float(answer)) if isinstance(value, steps.Range) else plain(value) == answer


def _order(step: steps.Tell, scope: Scope) -> Told:
    return step.verb, tuple(plain(scope.value(value)) for _, value in sorted(step.values))
