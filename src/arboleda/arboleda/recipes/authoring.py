"""Recipes of one's own: a function of a cell and typed parameters that returns a step.

@recipe("weigh")
def weigh(cell, dose: Choice["5", "10"]):
    pump, scale = cell.devices("pump", "scale")
    seen = scale.weigh()
    return work(pump.pump(ml=int(dose)), seen, cell.choose(seen, {"enough": [], "short": cell.fail("short")}))
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial, reduce, wraps
from importlib import import_module
from typing import Any

from py_trees import common, composites
from py_trees.behaviour import Behaviour

from arboleda.model.facts import Value, shown
from arboleda.model.messages import Failure, Reason
from arboleda.model.outside import among, quoted
from arboleda.model.plant_model import Robot
from arboleda.model.recipe import Recipe
from arboleda.model.sentence import Phrase, as_sentence
from arboleda.model.task import Order
from arboleda.trees import steps
from arboleda.trees.context import Context
from arboleda.trees.leaves import Dwell, Require, Unless, titled

from .decorators import Again, AtMost, Forgiven, Inverted, Times
from .errors import RecipeError, RoleError
from .handles import Ask, Step, chain, flat, handle, named, said
from .parameters import parameter
from .sharing import WORK, check_at_once, held, using

FINAL = frozenset({Reason.STOPPED, Reason.CANCELLED, Reason.PART_LOST, Reason.INTERRUPTED, Reason.INTERNAL})
CHOOSE = Phrase("step.choose", "choose")
IS = Phrase("step.is", "is {answer}")
NO_OTHER = Phrase("step.no_other", "no other answer")
FAIL = Phrase("step.fail", "fail")
WAIT = Phrase("step.wait", "wait")
PARALLEL = Phrase("step.parallel", "parallel")
FALLBACK = Phrase("step.fallback", "fallback")
OTHER_ANSWER = Phrase("recipe.other_answer", "{robot} answered {answer}; the recipe knows {known}")


@dataclass(frozen=True, kw_only=True)
class WrittenRecipe(Recipe):
    """A recipe that is a function; `function(cell, **values)` returns its step."""

    function: Callable[..., Step]

    def __reduce__(self) -> tuple[Callable[..., object], tuple[str, str]]:
        """Its place in its module, by which `pickle` takes it to another process, as it does functions."""
        return _found, (self.function.__module__, self.function.__qualname__)


def _found(module: str, name: str) -> object:
    return reduce(getattr, name.split("."), import_module(module))


def recipe(
    name: str,
    *,
    title: Phrase | None = None,
    about: str | None = None,
    is_default: bool = False,
    alone: str | None = None,
    alone_called: Phrase | None = None,
    part_from: str | None = None,
) -> Callable[[Callable[..., Step]], WrittenRecipe]:
    """Makes a recipe of a function of a Kit and parameters that are annotated with what they can be.

    `title` is its name in sentences, where they exist in several languages; `about` is shown to people, else
    the first line of the docstring. `is_default`: a task that names no recipe means this one. `alone`: the
    role of the one robot that works in it, whose name may stand for that of the cell; `alone_called`: that
    role in sentences. `part_from`: the group of targets at whose first one the part of a task waits, where no
    robot brings it.
    """

    def made(function: Callable[..., Step]) -> WrittenRecipe:
        notes = notes_of(name, function)
        declared = list(inspect.signature(function).parameters.values())[1:]
        read = {each.name: parameter(each.name, notes.get(each.name, each.default)) for each in declared}
        missing = next((each for each, found in read.items() if found is None), None)
        if missing is not None:
            forms = f"{missing}: Choice[1, 2] or {missing}=Choice(1, 2)"
            raise RecipeError(f"{name}: {missing} needs what it can be, e.g. {forms}")

        @wraps(function)
        def build(order: Order, context: Context) -> Step:
            return _build(name, title, function, order, context)

        known = tuple(each for each in read.values() if each is not None)
        first_line = (inspect.getdoc(function) or "").partition("\n")[0]
        return WrittenRecipe(
            name=name,
            build=build,
            parameters=known,
            about=first_line if about is None else about,
            is_default=is_default,
            alone=alone,
            alone_called=alone_called,
            part_from=part_from,
            function=function,
        )

    return made


def notes_of(name: str, function: Callable[..., Step]) -> dict[str, Any]:
    """The annotations of the parameters, by name."""
    try:
        return inspect.get_annotations(function, eval_str=True)
    except (NameError, SyntaxError) as error:
        hint = 'words in brackets are read as names: write target=Target("pallet"), side=Choice("a", "b")'
        raise RecipeError(f"{name}: an annotation cannot be read ({error}); {hint}") from error


def _build(
    name: str, title: Phrase | None, function: Callable[..., Step], order: Order, context: Context
) -> Step:
    context.parts.forget_origins()
    step = function(Kit(context), **order.values)
    if not isinstance(step, Behaviour):
        raise RecipeError(f"{name} returns {quoted(step)}; a recipe returns a step, e.g. work(...)")
    called = title() if title else name
    return steps.task(called, flat([held(context, step)]), context, notes_origins=True)


def _reason(word: Reason | str) -> Reason:
    try:
        return Reason(word)
    except ValueError:
        known = among(str(word), [each.value for each in Reason])
        raise RecipeError(f"retry knows no cause {quoted(word)}; {known}") from None


def work(*parts: Step | Sequence[Step]) -> Step:
    """One step after the other."""
    return chain(WORK(), flat(parts))


def parallel(*parts: Step) -> Step:
    """All at the same time, done once all are; where one fails, the others are halted."""
    check_at_once(parts)
    policy = common.ParallelPolicy.SuccessOnAll(synchronise=True)  # else what is done would be done again
    node = composites.Parallel(str(PARALLEL()), policy=policy, children=list(parts))
    return steps.framed(titled(node, PARALLEL()))


class Kit:
    """Kit of a recipe: the devices and targets of its cell, and the steps around steps."""

    def __init__(self, context: Context) -> None:
        self._context = context

    def devices(self, *roles: str) -> list[Any]:
        """The devices in these roles, to be told what to do."""
        return [self.device(role) for role in roles]

    def device(self, role: str) -> Any:
        """The device in this role, to be told what to do."""
        return handle(self._named(role), self._context)

    def _named(self, role: str) -> Robot:
        known = self._context.cell.roles
        if role not in known:
            name = self._context.cell.name
            raise RoleError(f"{name} has no device in the role {role!r}; {among(role, known)}")
        return known[role]

    def group(self, name: str) -> tuple[str, ...]:
        """The targets of a group of the cell, in their order."""
        groups = self._context.cell.groups
        if name not in groups:
            cell = self._context.cell.name
            raise RoleError(f"{cell} has no group of targets {name!r}; {among(name, groups)}")
        return groups[name]

    def handover(self, path: str = "") -> str:
        """The target at which one robot takes what another one brings on this path, or on most paths."""
        handover = self._context.cell.handover
        if handover is None:
            raise RoleError(f"{self._context.cell.name} has no handover from one robot to another")
        return handover.after(path)

    def using(self, roles: str | Sequence[str], *parts: Step | Sequence[Step]) -> Step:
        """The steps, with devices that other cells share held meanwhile; a recipe without it holds each from
        its first use to its last. What this cell does not share is its own anyway.
        """
        names = [roles] if isinstance(roles, str) else roles
        shared = frozenset(self._named(role).name for role in names).intersection(self._context.cell.shared)
        return using(self._context, shared, flat(parts)) if shared else work(*parts)

    def run(self, other: WrittenRecipe, **values: object) -> Step:
        """Another recipe as a step of this one."""
        return other.function(self, **values)

    def choose(self, asked: Step, ways: Mapping[Value, Step | Sequence[Step]]) -> Step:
        """A way for each answer to a step that asks a device or a person; another answer is a failure."""
        if not isinstance(asked, Ask):
            raise RecipeError(f"choose looks at the answer of a device's step; {named(asked)} has none")
        asked.check(ways)

        def answers(value: Value) -> bool:
            return asked.answer == value

        def other() -> Failure | None:
            """A way that was taken and failed has named its cause."""
            told = asked.answer
            if told in ways:
                return self._context.failures.first
            known = tuple(map(shown, ways))
            sentence = OTHER_ANSWER(robot=asked.name, answer=said(told), known=known)
            return Failure(reason=Reason.REJECTED, sentence=sentence)

        def branch(value: Value, way: Step | Sequence[Step]) -> Step:
            chosen = Unless(IS(answer=shown(value)), partial(answers, value))
            return steps.framed(steps.sequence(shown(value), chosen, *flat([way])))

        branches = [branch(value, way) for value, way in ways.items()]
        other_way = Require(NO_OTHER(), self._context.failures, other)
        return steps.framed(steps.selector(CHOOSE(), *branches, other_way))

    def fail(self, sentence: str) -> Step:
        """The task has failed, with this sentence."""
        failure = Failure(reason=Reason.REJECTED, sentence=as_sentence(sentence))
        return Require(FAIL(), self._context.failures, lambda: failure)

    def wait(self, seconds: float) -> Step:
        """Nothing for so long; the time stands still while the cell is held."""
        return Dwell(WAIT(), self._context.time, seconds)

    def retry(
        self,
        step: Step,
        *,
        times: int = 2,
        pause_s: float = 1.0,
        causes: Collection[Reason | str] | None = None,
    ) -> Step:
        """The step again, `times` more at most and after a pause, where it fails for one of the causes.

        Without `causes` after any failure that another try may mend: not a stop, not a part that is lost.
        """
        reasons = set(Reason) - FINAL if causes is None else {_reason(each) for each in causes}
        return Again(step, self._context, times=times, pause_s=pause_s, causes=reasons)

    def repeat(self, step: Step, times: int) -> Step:
        """The step `times` times, one after the other."""
        return Times(step, self._context.time, times=times)

    def timeout(self, step: Step, seconds: float) -> Step:
        """The step, which is left and has failed after so many seconds."""
        return AtMost(step, self._context, seconds=seconds)

    def fallback(self, *parts: Step) -> Step:
        """The first step that does not fail; where all do, the last one's failure counts."""
        *others, last = parts
        forgiven = [Forgiven(each, self._context.failures) for each in others]
        return steps.framed(steps.selector(FALLBACK(), *forgiven, last))

    def invert(self, step: Step) -> Step:
        """The step, which has to fail."""
        return Inverted(step, self._context.failures)
