"""What a recipe of one's own is written with: a function of a cell and typed parameters that returns a step.

@recipe("weigh")
def weigh(cell, dose: Choice["5", "10"]):
    pump, scale = cell.devices("pump", "scale")
    seen = scale.weigh()
    return work(pump.pump(ml=int(dose)), seen, cell.choose(seen, {"enough": [], "short": cell.fail("short")}))
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from functools import partial, wraps
from typing import Any

from py_trees import common, composites
from py_trees.behaviour import Behaviour

from arboleda.core import steps
from arboleda.core.context import Context
from arboleda.core.errors import ArboledaError
from arboleda.core.facts import Value, shown
from arboleda.core.leaves import Act, Await, Dwell, Require, Unless
from arboleda.core.messages import Failure, Reason
from arboleda.core.model import Cell
from arboleda.core.outside import among, quoted
from arboleda.core.recipe import Parameter, Recipe
from arboleda.core.sentence import Phrase, as_sentence
from arboleda.core.task import Order
from arboleda.kinds.declared import Device, ToldQuery

Step = Behaviour
OTHER_ANSWER = Phrase("recipe.other_answer", "{robot} answered {answer}; the recipe knows {known}")
NOT_SO = Phrase("recipe.not_so", "{robot} says {told} of {fact}; {value} is needed")
NOT_YET = Phrase("recipe.not_yet", "{robot} did not say {value} of {fact} within {seconds:g} s")


class RecipeError(ArboledaError):
    """A recipe that cannot be built."""


class RoleError(RecipeError):
    """A recipe that needs a device in a role that its cell does not have."""


class Choice:
    """One of some values: `Choice[1001, 1002]`."""

    def __init__(self, values: tuple[Value, ...]) -> None:
        self.values = values

    def __class_getitem__(cls, values: Value | tuple[Value, ...]) -> Choice:
        return cls(values if isinstance(values, tuple) else (values,))

    def parameter(self, name: str) -> Parameter:
        by_word = {shown(value): value for value in self.values}

        def words(cell: Cell) -> Sequence[str]:
            return list(by_word)

        def value(cell: Cell, word: str) -> Value:
            return by_word[word]

        return Parameter(name=name, words=words, value=value)


def recipe(name: str) -> Callable[[Callable[..., Step]], Recipe]:
    """Makes a recipe of a function of a Kit and parameters that are annotated with what they can be."""

    def made(function: Callable[..., Step]) -> Recipe:
        notes = inspect.get_annotations(function, eval_str=True)
        names = list(inspect.signature(function).parameters)[1:]
        unknown = [each for each in names if not isinstance(notes.get(each), Choice)]
        if unknown:
            raise RecipeError(f"{name}: {unknown[0]} needs an annotation, e.g. {unknown[0]}: Choice[1, 2]")

        @wraps(function)
        def build(order: Order, context: Context) -> Behaviour:
            step = function(Kit(context), **order.values)
            if not isinstance(step, Behaviour):
                raise RecipeError(f"{name} returns {quoted(step)}; a recipe returns a step, e.g. work(...)")
            return steps.task(name, [step], context)

        parameters = tuple(notes[each].parameter(each) for each in names)
        return Recipe(name=name, build=build, parameters=parameters)

    return made


def work(*parts: Step | Sequence[Step]) -> Step:
    """One step after the other."""
    return steps.sequence("work", *_flat(parts))


def parallel(*parts: Step) -> Step:
    """All at the same time, done once all are; where one fails, the others are halted."""
    policy = common.ParallelPolicy.SuccessOnAll(synchronise=True)  # else what is done would be done again
    return composites.Parallel("parallel", policy=policy, children=list(parts))


class Ask(Act):
    """A question to a device, and what it may answer."""

    answers: tuple[Value, ...] = ()

    def check(self, ways: Mapping[Value, object]) -> None:
        """RecipeError where the ways are not those of all answers, and of no others."""
        allowed = ", ".join(map(shown, self.answers))
        for answer in ways:
            if answer not in self.answers:
                raise RecipeError(f"{self.name} never answers {quoted(answer)}; its answers: {allowed}")
        for answer in self.answers:
            if answer not in ways:
                raise RecipeError(f"choose has no way for {quoted(answer)}, which {self.name} may answer")


class Kit:
    """What a recipe may use of its cell."""

    def __init__(self, context: Context) -> None:
        self._context = context

    def devices(self, *roles: str) -> list[Handle]:
        """The devices in these roles, to be told their verbs."""
        return [self.device(role) for role in roles]

    def device(self, role: str) -> Handle:
        known = self._context.cell.roles
        if role not in known:
            name = self._context.cell.name
            raise RoleError(f"{name} has no device in the role {role!r}; {among(role, known)}")
        device = known[role]
        if not isinstance(device, Device):
            raise RecipeError(f"{device.name} is no device of a declared kind")
        return Handle(device, self._context)

    def choose(self, asked: Step, ways: Mapping[Value, Step | Sequence[Step]]) -> Step:
        """What to do for each answer to a step that asks a device; another answer is a failure."""
        if not isinstance(asked, Ask):
            raise RecipeError(f"choose looks at the answer of a device's step; {_named(asked)} has none")
        asked.check(ways)

        def answers(value: Value) -> bool:
            return asked.entry is not None and asked.entry.answer == value

        def other() -> Failure | None:
            """A way that was taken and failed has named its cause."""
            told = asked.entry.answer if asked.entry else None
            if told in ways:
                return self._context.failure
            known = tuple(map(shown, ways))
            sentence = OTHER_ANSWER(robot=asked.name, answer=_said(told), known=known)
            return Failure(reason=Reason.REJECTED, sentence=sentence)

        branches = [
            steps.sequence(shown(value), Unless(f"is {shown(value)}", partial(answers, value)), *_flat([way]))
            for value, way in ways.items()
        ]
        return steps.selector("choose", *branches, Require("no other answer", self._context, other))

    def fail(self, sentence: str) -> Step:
        """The task has failed, with this sentence."""
        failure = Failure(reason=Reason.REJECTED, sentence=as_sentence(sentence))
        return Require("fail", self._context, lambda: failure)

    def wait(self, seconds: float) -> Step:
        """Nothing for so long; the time stands still while the cell is held."""
        return Dwell("wait", self._context, seconds)


class Handle:
    """A device of the cell: `mill.run(program=1001)` is the step that tells it to."""

    def __init__(self, device: Device, context: Context) -> None:
        self._device = device
        self._context = context

    def __getattr__(self, verb: str) -> Callable[..., Act]:
        def step(**values: Value) -> Act:
            device, kind = self._device, self._device.kind
            told = kind.command(
                id="", robot=device.name, verb=verb, values=values
            )  # wrong words are told at once

            def make(id: str) -> Any:
                return kind.command(id=id, robot=device.name, verb=verb, values=values)

            words = " ".join([verb, *map(shown, values.values())])
            if not isinstance(told, ToldQuery):
                return Act(f"{device.name} {words}", self._context, make, f"doing {words}")
            asked = Ask(f"{device.name} {words}", self._context, make, f"doing {words}")
            asked.answers = told.told.answers
            return asked

        return step

    def says(self, **facts: Value) -> Step:
        """A check: the device says so, else the task fails."""
        self._check(facts)
        return Require("says", self._context, partial(self._objection, facts))

    def becomes(self, *, at_most_s: float, **facts: Value) -> Step:
        """Wait until the device says so, at most `at_most_s` s."""
        self._check(facts)

        def late() -> Failure:
            name = self._unsaid(facts)[0]
            sentence = NOT_YET(
                robot=self._device.name, value=shown(facts[name]), fact=name, seconds=at_most_s
            )
            return Failure(reason=Reason.DEADLINE, sentence=sentence)

        return Await("becomes", self._context, lambda: not self._unsaid(facts), at_most_s, late)

    def _check(self, facts: Mapping[str, Value]) -> None:
        for name, value in facts.items():
            self._device.kind.check_fact(name, value)

    def _unsaid(self, facts: Mapping[str, Value]) -> list[str]:
        """Those of the facts that the device does not say."""
        return [name for name, value in facts.items() if self._told(name) != value]

    def _told(self, fact: str) -> Value | None:
        return self._context.fact(self._device.name, fact)

    def _objection(self, facts: Mapping[str, Value]) -> Failure | None:
        for name in self._unsaid(facts):
            told, value = _said(self._told(name)), shown(facts[name])
            sentence = NOT_SO(robot=self._device.name, told=told, fact=name, value=value)
            return Failure(reason=Reason.PRECONDITION, sentence=sentence)
        return None


def _named(step: object) -> str:
    return step.name if isinstance(step, Behaviour) else quoted(step)


def _said(value: Value | None) -> str:
    return "nothing" if value is None else shown(value)


def _flat(parts: Sequence[Step | Sequence[Step]]) -> list[Step]:
    return [step for part in parts for step in ([part] if isinstance(part, Behaviour) else part)]
