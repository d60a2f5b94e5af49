"""Steps of a drawn recipe as plain data, which `python_text.py` and `xml_text.py` write out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields
from operator import ge, gt, le, lt

Value = bool | int | float | str


@dataclass(frozen=True, kw_only=True)
class Param:
    """Parameter of a recipe in the place of a value."""

    name: str


@dataclass(frozen=True, kw_only=True)
class Range:
    """Range of numbers: those that meet all comparisons, as `>=` 20 and `<` 80; without any: all others."""

    comparisons: tuple[tuple[str, float], ...]

    def has(self, number: float) -> bool:
        return all(MEETS[sign](number, limit) for sign, limit in self.comparisons)

    def __str__(self) -> str:
        return " and ".join(f"{sign} {limit}" for sign, limit in self.comparisons) or "otherwise"


MEETS: Mapping[str, Callable[[float, float], bool]] = {"<": lt, "<=": le, ">": gt, ">=": ge}
Given = tuple[tuple[str, Value | Param | Range], ...]


@dataclass(frozen=True, kw_only=True)
class Tell:
    """A verb of a device; `answer` names the variable for what it answers, empty where it is no query.

    `refused`: the plant has to refuse it, as something that it needs is not so.
    """

    role: str
    verb: str
    values: Given = ()
    answer: str = ""
    refused: bool = False


@dataclass(frozen=True, kw_only=True)
class Ask:
    """A question to a person."""

    role: str
    question: str
    answers: tuple[str, ...]
    at_most_s: float
    answer: str


@dataclass(frozen=True, kw_only=True)
class Says:
    """A check of a fact, and of those in `also` with it."""

    role: str
    fact: str
    value: Value | Range
    also: tuple[tuple[str, Value], ...] = ()


@dataclass(frozen=True, kw_only=True)
class Becomes:
    """A wait for a fact, and for those in `also` with it."""

    role: str
    fact: str
    value: Value | Range
    at_most_s: float
    also: tuple[tuple[str, Value], ...] = ()


@dataclass(frozen=True, kw_only=True)
class Gets:
    """A wait for a part at a place, or for room there; `what` is "part" or "room"."""

    place: str | Param
    what: str
    at_most_s: float


@dataclass(frozen=True, kw_only=True)
class Go:
    """A robot goes to a target, and stays there where that is in no zone."""

    role: str
    target: str | Param


@dataclass(frozen=True, kw_only=True)
class Home:
    """A robot goes home."""

    role: str


@dataclass(frozen=True, kw_only=True)
class Visit:
    """A robot goes to a target, and something is done there."""

    role: str
    target: str | Param
    body: Step


@dataclass(frozen=True, kw_only=True)
class Grip:
    """A robot takes hold with its own effector."""

    role: str


@dataclass(frozen=True, kw_only=True)
class LetGo:
    """A robot lets go with its own effector."""

    role: str


@dataclass(frozen=True, kw_only=True)
class Tour:
    """A robot takes a part with its own effector, brings it to the goal and goes home."""

    role: str
    source: str | Param
    goal: str


@dataclass(frozen=True, kw_only=True)
class Follow:
    """A mobile robot drives over one of its paths."""

    role: str
    path: str | Param


@dataclass(frozen=True, kw_only=True)
class Wait:
    """Nothing, for so long."""

    seconds: float


@dataclass(frozen=True, kw_only=True)
class Fail:
    """The task has failed."""

    sentence: str


@dataclass(frozen=True, kw_only=True)
class Work:
    """Steps one after the other."""

    steps: tuple[Step, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Parallel:
    """Steps at the same time."""

    branches: tuple[Step, ...]


@dataclass(frozen=True, kw_only=True)
class Choose:
    """A way for each answer that stands in the variable `answer`, or for each range of numbers."""

    answer: str
    ways: tuple[tuple[Value | Range, Step], ...]


@dataclass(frozen=True, kw_only=True)
class Retry:
    """The step, again where it fails; `causes` are the only reasons for that, if there are any, which no tree
    as XML can say.
    """

    step: Step
    times: int
    pause_s: float
    causes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Repeat:
    """The step several times."""

    step: Step
    times: int


@dataclass(frozen=True, kw_only=True)
class Timeout:
    """The step, for so long at most."""

    step: Step
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Fallback:
    """The first step that does not fail."""

    steps: tuple[Step, ...]


@dataclass(frozen=True, kw_only=True)
class Recover:
    """The work, and the rescue where it fails."""

    work: Step
    rescue: Step


@dataclass(frozen=True, kw_only=True)
class Invert:
    """The step, which has to fail."""

    step: Step


@dataclass(frozen=True, kw_only=True)
class Using:
    """Steps during which shared devices are held."""

    roles: tuple[str, ...]
    step: Step


@dataclass(frozen=True, kw_only=True)
class Run:
    """Another recipe as a step."""

    recipe: str
    values: Given = ()


Step = (
    Tell
    | Ask
    | Says
    | Becomes
    | Gets
    | Go
    | Home
    | Visit
    | Grip
    | LetGo
    | Tour
    | Follow
    | Wait
    | Fail
    | Work
    | Parallel
    | Choose
    | Retry
    | Repeat
    | Timeout
    | Fallback
    | Recover
    | Invert
    | Using
    | Run
)


@dataclass(frozen=True, kw_only=True)
class Choice:
    """Parameter that is one of some words or numbers."""

    name: str
    words: tuple[Value, ...]


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Parameter that is a number within limits."""

    name: str
    lower: float
    upper: float


@dataclass(frozen=True, kw_only=True)
class OfGroup:
    """Parameter that is one of a group of targets."""

    name: str
    group: str


@dataclass(frozen=True, kw_only=True)
class OfPaths:
    """Parameter that is one of the paths of a cell."""

    name: str


Parameter = Choice | Limits | OfGroup | OfPaths
Ends = tuple[tuple[str, Value], ...]


@dataclass(frozen=True, kw_only=True)
class Recipe:
    """Recipe by its name: its parameters, its step, and what it says is so at its end, as `lamp.lit`.

    `ends_by_answer`: one of these is so as well, that with the answer with which it begins.
    """

    name: str
    parameters: tuple[Parameter, ...]
    step: Step
    ends: Ends = ()
    ends_by_answer: tuple[Ends, ...] = ()

    @property
    def all_ends(self) -> tuple[Ends, ...]:
        """The ends, each whole; empty where it says of none."""
        return tuple((*each, *self.ends) for each in self.ends_by_answer) or (
            (self.ends,) if self.ends else ()
        )


@dataclass(frozen=True, kw_only=True)
class Call:
    """A step that tells, asks or looks at one role, as both forms write it: its verb, and what that is given.

    The first `unnamed` of `given` stand without their names in Python.
    """

    role: str
    verb: str
    given: tuple[tuple[str, Value | Param | Range | tuple[str, ...]], ...] = ()
    unnamed: int = 0


def call_of(step: Step) -> Call | None:
    """The call that a step is; None for any other step."""
    if isinstance(step, Tell):
        return Call(role=step.role, verb=step.verb, given=step.values)
    if isinstance(step, Ask):
        asked = (("question", step.question), ("answers", step.answers), ("at_most_s", step.at_most_s))
        return Call(role=step.role, verb="ask", given=asked, unnamed=2)
    if isinstance(step, Says):
        return Call(role=step.role, verb="says", given=_facts(step))
    if isinstance(step, Becomes):
        return Call(role=step.role, verb="becomes", given=(*_facts(step), ("at_most_s", step.at_most_s)))
    if isinstance(step, Go | Visit):
        verb = "go" if isinstance(step, Go) else "visit"
        return Call(role=step.role, verb=verb, given=(("target", step.target),), unnamed=1)
    if isinstance(step, Home | Grip | LetGo):
        return Call(role=step.role, verb={Home: "home", Grip: "grip", LetGo: "let_go"}[type(step)])
    return None


def _facts(step: Says | Becomes) -> Given:
    return ((step.fact, step.value), *step.also)


def walk(step: Step) -> Iterator[Step]:
    """The step and all in it."""
    yield step
    for inner in children(step):
        yield from walk(inner)


def children(step: Step) -> tuple[Step, ...]:
    """The steps that are right in it."""
    if isinstance(step, Choose):
        return tuple(way for _, way in step.ways)
    found: list[Step] = []
    for each in fields(step):
        value = getattr(step, each.name)
        if isinstance(value, Step):
            found.append(value)
        elif each.name in ("steps", "branches"):
            found += value
    return tuple(found)
