"""Recipes of one's own: a function of a cell and typed parameters that returns a step.

@recipe("weigh")
def weigh(cell, dose: Choice["5", "10"]):
    pump, scale = cell.devices("pump", "scale")
    seen = scale.weigh()
    return work(pump.pump(ml=int(dose)), seen, cell.choose(seen, {"enough": [], "short": cell.fail("short")}))
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial, reduce, wraps
from importlib import import_module
from itertools import chain as all_of
from typing import Any

from py_trees import common, composites

from arboleda.engine import Context, Dwell, Require, Unless, framed, selector, sequence, task, titled
from arboleda.kinds.ranges import Wanted
from arboleda.model.facts import Value, shown
from arboleda.model.messages import Failure, Reason
from arboleda.model.outside import among, quoted
from arboleda.model.plant_model import Cell, Robot
from arboleda.model.recipe import FOR_PEOPLE, End, Recipe
from arboleda.model.sentence import Phrase, Sentence, as_sentence
from arboleda.model.task import Order

from .decorators import Again, AtMost, Forgiven, Inverted, Rescue, Times
from .errors import Offers, RecipeError, RoleError
from .handles import Question, Step, chain, flat, handle, is_list, named, question_of, usable, value_text
from .holding import WORK, held
from .parameters import parameter
from .place_questions import PlaceHandle
from .sharing import check_at_once, using

RETURNS = "a recipe returns a step, e.g. work(...)"
MOST_TIMES = 100_000  # of a repeat or a retry
MOST_NESTED, MOST_SHOWN = 50, 4  # recipes within each other; recipes that a sentence names
FINAL = frozenset({Reason.STOPPED, Reason.CANCELLED, Reason.PART_LOST, Reason.INTERRUPTED, Reason.INTERNAL})
CHOOSE = Phrase("step.choose", "choose")
IS = Phrase("step.is", "is {answer}")
NO_OTHER = Phrase("step.no_other", "no other answer")
FAIL = Phrase("step.fail", "fail")
WAIT = Phrase("step.wait", "wait")
PARALLEL = Phrase("step.parallel", "parallel")
FALLBACK = Phrase("step.fallback", "fallback")
RECOVER = Phrase("step.recover", "recover")
OTHER_ANSWER = Phrase("recipe.other_answer", "{robot} answered {answer}; the recipe knows {known}")
BEYOND: Mapping[type, Phrase] = {
    float: Phrase(
        "recipe.beyond", "{robot} answered {answer}; it may answer numbers from {lower:g} to {upper:g}"
    ),
    int: Phrase(
        "recipe.beyond_whole",
        "{robot} answered {answer}; it may answer whole numbers from {lower:g} to {upper:g}",
    ),
}


@dataclass(frozen=True, kw_only=True)
class WrittenRecipe(Recipe):
    """A recipe that is a function; `function(cell, **values)` returns its step.

    `unused` has a sentence for each named step that the recipe makes and never does, once it was tried.
    """

    function: Callable[..., Step]
    unused: tuple[str, ...] = field(default=(), compare=False, metadata={FOR_PEOPLE: True})

    @property
    def is_shipped(self) -> bool:
        return self.function.__module__.startswith("arboleda.recipes.")

    def __reduce__(self) -> tuple[Callable[..., object], tuple[str, str]]:
        """The name of the recipe in its module, by which `pickle` takes it to another process."""
        return _by_qualified_name, (self.function.__module__, self.function.__qualname__)


def _by_qualified_name(module: str, name: str) -> object:
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
    ends_with: Mapping[str, Value] | Sequence[Mapping[str, Value]] | None = None,
) -> Callable[[Callable[..., Step]], WrittenRecipe]:
    """Makes a recipe of a function of a Kit and of parameters that are annotated with their values.

    `title` is the name of the recipe in sentences, for names in several languages. `about` is shown to
    people, else the first line of the docstring. `is_default`: tasks that name no recipe are of this one.
    `alone` is the role of the only robot that works in the recipe: tasks may name the robot in place of the
    cell. `alone_called` is that role in sentences. `part_from` is a group of targets: the part of a task
    waits at the first of them, where no robot brings parts. `ends_with` are facts and numbers of parts once a
    task is done, `{"nest": 1, "reader.lid": "open"}`; a parameter may name the place. A list of them has the
    ends of several ways, `[{"camera.look": "good", "press": 1}, {"camera.look": "bad", "reject": 1}]`, where
    `camera.look` is the last answer in this task.
    """

    def made(function: Callable[..., Step]) -> WrittenRecipe:
        notes = notes_of(name, function)
        declared = list(inspect.signature(function).parameters.values())[1:]
        read = {each.name: parameter(each.name, notes.get(each.name, each.default)) for each in declared}
        missing = next((each for each, value in read.items() if value is None), None)
        if missing is not None:
            forms = f"{missing}: Choice[1, 2] or {missing}=Choice(1, 2)"
            raise RecipeError(f"{name}: {missing} needs what it can be, e.g. {forms}")

        ends = _ends(name, ends_with or ())
        end = tuple(all_of.from_iterable(ends))

        @wraps(function)
        def build(order: Order, context: Context) -> Step:
            built = _build(name, title, function, order, context)  # first: a cell may lack its devices
            check_end(name, [(str(order.values.get(what, what)), value) for what, value in end], context.cell)
            return built

        parameter_list = tuple(each for each in read.values() if each is not None)
        first_line = (inspect.getdoc(function) or "").partition("\n")[0]
        return WrittenRecipe(
            name=name,
            build=build,
            parameters=parameter_list,
            about=first_line if about is None else about,
            is_default=is_default,
            alone=alone,
            alone_called=alone_called,
            part_from=part_from,
            ends_with=ends,
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
    making = Making(running=((name, order.values),))
    step = usable(function(Kit(context, making), **order.values), f"{name} returns", RETURNS)
    check_choices(step, making)
    called = title() if title else name
    return task(called, flat([held(context, step)]), context, notes_origins=True)


def _ends(name: str, ends_with: Mapping[str, Value] | Sequence[Mapping[str, Value]]) -> tuple[End, ...]:
    ends = [ends_with] if isinstance(ends_with, Mapping) else ends_with
    if not is_list(ends) or not all(isinstance(end, Mapping) for end in ends):
        forms = '{"nest": 1}, or of several ways [{"nest": 1}, {"bin": 1}]'
        raise RecipeError(f"{name}: ends_with is {quoted(str(ends_with))}; write {forms}")
    return tuple(tuple(end.items()) for end in ends)


def check_end(name: str, end: Iterable[tuple[str, Value]], cell: Cell) -> None:
    """RecipeError where no device and no place of a cell can report an end that a recipe states."""
    places = {place.target: place for place in cell.counted}
    members: Sequence[tuple[str, Any]] = [each for each in cell.members if each[1].verb_names]
    facts = {f"{role}.{fact}": (device, fact) for role, device in members for fact in device.fact_names}
    verbs = {f"{role}.{verb.name}": verb for role, device in members for verb in device.kind.verbs.values()}
    answers = {question: verb.answers for question, verb in verbs.items() if verb.answers}
    for what, value in end:
        if what not in places and what not in facts and what not in answers:
            raise RecipeError(f"{name} ends with {quoted(what)}; {among(what, (*places, *facts, *answers))}")
        if what in places and not (type(value) is int and 0 <= value <= places[what].holds):
            most = places[what].holds
            raise RecipeError(f"{name} ends with {quoted(value)} at {what}, which holds 0 to {most}")
        if what in facts:
            device, fact = facts[what]
            device.kind.check_fact(fact, value)
        elif what in answers and value not in answers[what]:
            known = ", ".join(map(shown, answers[what]))
            raise RecipeError(f"{name} ends with {quoted(value)} of {what}, which answers {known}")


def _reason(word: Reason | str) -> Reason:
    try:
        return Reason(word)
    except ValueError:
        allowed = among(str(word), [each.value for each in Reason])
        raise RecipeError(f"retry knows no cause {quoted(word)}; {allowed}") from None


@dataclass(frozen=True, kw_only=True)
class Making:
    """A recipe that is being built.

    `running` are the recipes that run each other in it, `chosen` its choices, each with the question.
    """

    running: tuple[tuple[str, Mapping[str, object]], ...] = ()
    chosen: list[tuple[Step, Question]] = field(default_factory=list)

    def within(self, name: str, values: Mapping[str, object]) -> Making:
        """The making of another recipe inside this one; RecipeError where a recipe would run itself."""
        running = (*self.running, (name, values))
        if running[-1] in self.running or len(running) > MOST_NESTED:
            ring = running[running.index(running[-1]) :] if running[-1] in self.running else running
            names = " > ".join(each for each, _ in ring[-MOST_SHOWN:])
            raise RecipeError(f"{name} runs itself without an end: {names}")
        return Making(running=running, chosen=self.chosen)


def check_choices(step: Step, making: Making) -> None:
    """RecipeError where a choice comes before the question whose answer it needs."""
    if not making.chosen:
        return
    order = {id(node): number for number, node in enumerate(step.iterate())}  # children before their parents
    for node, question in making.chosen:
        first = order.get(id(next(node.iterate())), -1)  # -1: the choice is not used
        if first >= 0 and order.get(id(question), first) >= first:
            how = "let it stand before, as in work(seen, cell.choose(seen, ...))"
            if id(question) not in order and any(each.name == question.name for each in step.iterate()):
                how = (
                    "each call makes a step of its own, and another one stands in the recipe: "
                    "use one name for both, as in work(cell.retry(seen), cell.choose(seen, ...))"
                )
            raise RecipeError(
                f"choose looks at the answer of {question.name}, which is not asked by then; {how}"
            )


def _unexpected(question: Question, known: Iterable[Wanted]) -> Sentence:
    """The sentence on an answer without a branch, or one that its device may not give."""
    answer, number = value_text(question.answer), question.number
    if number is not None and number.is_limited and not number.takes(question.answer):
        beyond = BEYOND[number.type]
        return beyond(robot=question.name, answer=answer, lower=number.lower, upper=number.upper)
    return OTHER_ANSWER(robot=question.name, answer=answer, known=tuple(map(value_text, known)))


def _one(step: Step | Sequence[Step], where: str) -> Step:
    """The step, or a list of steps as one step."""
    return usable(step, f"{where} is given") if not is_list(step) else chain(WORK(), flat(list(step), where))


def _several(parts: Sequence[Step], where: str) -> list[Step]:
    """The steps, each by itself; RecipeError where there is none, or where one is there twice."""
    if not parts:
        raise RecipeError(f"{where} has no step")
    steps = [usable(each, f"{where} is given") for each in parts]
    if len({id(each) for each in steps}) < len(steps):
        raise RecipeError(f"{where} has one step twice; call what makes it again for the other place")
    return steps


def _times(times: object, where: str, least: int) -> int:
    if type(times) is not int or not least <= times <= MOST_TIMES:
        raise RecipeError(f"{where} takes a whole number from {least} to {MOST_TIMES:,}; is {quoted(times)}")
    return times


def _seconds(seconds: object, where: str) -> float:
    if isinstance(seconds, bool) or not isinstance(seconds, int | float) or not 0 <= seconds < math.inf:
        raise RecipeError(f"{where} is a number of seconds from 0; is {quoted(seconds)}")
    return seconds


def work(*parts: Step | Sequence[Step]) -> Step:
    """One step after the other."""
    return chain(WORK(), flat(parts))


def parallel(*parts: Step) -> Step:
    """All at the same time, done once all are; where one fails, the others are halted."""
    branches = _several(parts, "parallel")
    check_at_once(branches)
    policy = common.ParallelPolicy.SuccessOnAll(synchronise=True)  # else what is done would be done again
    node = composites.Parallel(str(PARALLEL()), policy=policy, children=branches)
    return framed(titled(node, PARALLEL()))


class Kit(Offers):
    """Kit of a recipe: the devices and targets of its cell, and the steps around steps."""

    def __init__(self, context: Context, making: Making | None = None) -> None:
        self._context = context
        self._making = making or Making()

    def __str__(self) -> str:
        return self._context.cell.name

    def devices(self, *roles: str) -> list[Any]:
        """The devices in these roles."""
        return [self.device(role) for role in roles]

    def device(self, role: str) -> Any:
        """The device in this role."""
        return handle(self._named(role), self._context)

    def _named(self, role: str) -> Robot:
        roles = self._context.cell.roles
        if role not in roles:
            name = self._context.cell.name
            raise RoleError(f"{name} has no device in the role {role!r}; {among(role, roles)}")
        return roles[role]

    def group(self, name: str) -> tuple[str, ...]:
        """The targets of a group of the cell, in their order."""
        groups = self._context.cell.groups
        if name not in groups:
            cell = self._context.cell.name
            raise RoleError(f"{cell} has no group of targets {name!r}; {among(name, groups)}")
        return groups[name]

    def place(self, target: str) -> PlaceHandle:
        """The place at a target, which a recipe may ask whether a part is there."""
        places = [place.target for place in self._context.cell.places]
        if target not in places:
            cell = self._context.cell.name
            raise RoleError(f"{cell} has no place {target!r}; {among(target, places)}")
        return PlaceHandle(target, self._context)

    def handover(self, path: str = "") -> str:
        """The target at which a robot takes the part that another robot brings on this path, else on most."""
        handover = self._context.cell.handover
        if handover is None:
            raise RoleError(f"{self._context.cell.name} has no handover from one robot to another")
        return handover.after(path)

    def using(self, roles: str | Sequence[str], *parts: Step | Sequence[Step]) -> Step:
        """The steps, with shared devices held meanwhile.

        A recipe without `using` holds each shared device from its first use to its last. Devices that this
        cell does not share are always its own.
        """
        names = [roles] if isinstance(roles, str) else roles
        if not is_list(names) or not all(isinstance(name, str) for name in names):
            raise RecipeError(f'using is given {quoted(str(roles))}; it takes roles, as using("lift", ...)')
        cell = self._context.cell
        shared = cell.together({self._named(role).name for role in names}.intersection(cell.shared))
        return using(self._context, shared, flat(parts, "using")) if shared else work(*parts)

    def run(self, other: WrittenRecipe, **values: object) -> Step:
        """Another recipe as a step of this one."""
        if not isinstance(other, WrittenRecipe):
            raise RecipeError(
                f"run is given {quoted(other)}; it takes a recipe, a function with @recipe before it"
            )
        making = self._making.within(other.name, values)
        return usable(
            other.function(type(self)(self._context, making), **values), f"{other.name} returns", RETURNS
        )

    def choose(self, question_step: Step, ways: Mapping[Value, Step | Sequence[Step]]) -> Step:
        """A branch for each answer to a step that asks a device or a person; another answer is a failure.

        Where the answer is a number, each branch has a comparison: `"> 120"`, `">= 100 and <= 120"`;
        `"otherwise"` has all other numbers.
        """
        question = question_of(question_step)
        if question is None:
            raise RecipeError(
                f"choose looks at the answer of a device's step; {named(question_step)} has none"
            )
        wanted = question.ways(ways)

        def answers(value: Wanted) -> bool:
            return question.is_answered(value)

        def other() -> Failure | None:
            """The cause of a chosen branch that failed; else a failure for an answer without a branch."""
            if any(map(question.is_answered, wanted)):
                return self._context.failures.first
            return Failure(reason=Reason.REJECTED, sentence=_unexpected(question, wanted))

        def branch(value: Wanted, way: Step | Sequence[Step]) -> Step:
            chosen = Unless(IS(answer=value_text(value)), partial(answers, value))
            return framed(sequence(value_text(value), chosen, *flat([way], "choose")))

        branches = [branch(value, way) for value, way in wanted.items()]
        other_way = Require(NO_OTHER(), self._context.failures, other)
        node = framed(selector(CHOOSE(), *branches, other_way))
        node.asked = question  # type: ignore[attr-defined]
        if question.number is not None:
            node.ranges = tuple(wanted)  # type: ignore[attr-defined]
        self._making.chosen.append((node, question))
        return node

    def fail(self, sentence: str) -> Step:
        """The task has failed, with this sentence."""
        if not isinstance(sentence, str | Sentence) or not str(sentence).strip():
            raise RecipeError(f"fail is given {quoted(sentence)}; it takes the words that people are told")
        failure = Failure(reason=Reason.REJECTED, sentence=as_sentence(sentence))
        return Require(FAIL(), self._context.failures, lambda: failure)

    def wait(self, seconds: float) -> Step:
        """Nothing for so long; the time stands still while the cell is held."""
        return Dwell(WAIT(), self._context.time, _seconds(seconds, "wait"))

    def retry(
        self,
        step: Step,
        *,
        times: int = 2,
        pause_s: float = 1.0,
        causes: Collection[Reason | str] | None = None,
    ) -> Step:
        """The step; where it fails by one of the causes, the step again after a pause, at most `times` more.

        Without `causes`, all failures count that another try may mend: not a stop, not a lost part.
        """
        reasons = set(Reason) - FINAL if causes is None else {_reason(each) for each in causes}
        most, pause = _times(times, "times of retry", 0), _seconds(pause_s, "pause_s of retry")
        return Again(_one(step, "retry"), self._context, times=most, pause_s=pause, causes=reasons)

    def repeat(self, step: Step, times: int) -> Step:
        """The step `times` times, one after the other."""
        return Times(_one(step, "repeat"), self._context.time, times=_times(times, "times of repeat", 1))

    def timeout(self, step: Step, seconds: float) -> Step:
        """The step, which is halted and fails after so many seconds."""
        return AtMost(_one(step, "timeout"), self._context, seconds=_seconds(seconds, "timeout"))

    def fallback(self, *parts: Step) -> Step:
        """The steps in order until one does not fail; where all do, the failure of the last one counts."""
        *others, last = _several(parts, "fallback")
        forgiven = [Forgiven(each, self._context.failures) for each in others]
        return framed(selector(FALLBACK(), *forgiven, last))

    def recover(self, work: Step | Sequence[Step], rescue: Step | Sequence[Step]) -> Step:
        """The work, and the rescue after work that fails.

        Then the whole step fails by the cause of the work, also where the rescue succeeds.
        """
        tried = _one(work, "recover")
        rescued = Rescue(_one(rescue, "recover"), self._context.failures)
        return framed(selector(RECOVER(), tried, rescued))

    def invert(self, step: Step) -> Step:
        """The step, which succeeds if it fails, and fails if it succeeds."""
        return Inverted(_one(step, "invert"), self._context.failures)
