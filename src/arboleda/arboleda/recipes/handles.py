"""Devices of a cell as a recipe commands them: each call returns a step."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeGuard, TypeVar

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.engine import (
    Act,
    Await,
    Context,
    Leaf,
    Require,
    follow,
    go_home,
    grip,
    interlocked,
    let_go,
    sequence,
    titled,
    tour,
    unchecked_grip,
    visit_from_anywhere,
)
from arboleda.kinds.declared import Device, FactType, QueryCall, UseError
from arboleda.kinds.person import PATIENCE_S, AskPerson, Person
from arboleda.kinds.ranges import Range, Wanted, fact_wanted, is_so
from arboleda.model import zone_plan
from arboleda.model.by_class import nearest
from arboleda.model.facts import Value, shown
from arboleda.model.messages import Failure, Reason, TaskAnswer
from arboleda.model.outside import among, quoted
from arboleda.model.plant_model import PieceCheck, Pose, Robot
from arboleda.model.recipe import spelling
from arboleda.model.sentence import Phrase, Sentence

from . import number_ways
from .errors import Offers, RecipeError
from .sharing import check_holds_none

Step = Behaviour
"""A step of a recipe, which is a node of py_trees."""
StepOf = TypeVar("StepOf", bound=Behaviour)
Way = TypeVar("Way")
LONGEST_QUESTION, LONGEST_ANSWER = 300, 60
TWICE = (
    "{step} stands at two places; a step has one place: call what makes it again for the other, or repeat it"
)
NOT_SO = Phrase("recipe.not_so", "{robot} says {told} of {fact}; {value} is needed")
NOT_YET = Phrase("recipe.not_yet", "{robot} did not say {value} of {fact} within {seconds:g} s")
TOUR = Phrase("step.tour", "tour")
FOLLOW = Phrase("step.follow", "follow path {path}")
VISIT = Phrase("step.visit", "visit {pose}")
ASK = Phrase("step.ask", "ask {person}")
SAYS = Phrase("step.says", "says")
BECOMES = Phrase("step.becomes", "becomes")
DOING = Phrase("doing.order", "doing {order}")
ASKING = Phrase("doing.ask", "asking {person}")


class Question(Leaf):
    """A step that ends with one of these `answers`, by which a recipe may choose a branch."""

    answers: tuple[Value, ...] = ()
    number: FactType | None = None  # the type of an answer that is a number
    ranges: tuple[Range, ...] = ()  # of numbers, by which recipes choose

    @property
    def answer(self) -> Value | None:
        """The answer; None where there is none yet."""
        raise NotImplementedError

    def is_answered(self, wanted: Wanted) -> bool:
        """True if the answer is this value, or a number of this range that its device may answer."""
        if isinstance(wanted, Range):
            return self.number is not None and self.number.takes(self.answer) and wanted.has(self.answer)
        return self.answer == wanted

    def ways(self, branches: Mapping[Value, Way]) -> dict[Wanted, Way]:
        """The branches by answers or ranges; RecipeError unless each answer has one, and nothing else."""
        wanted: Iterable[Wanted] = branches
        if self.number is None:
            self._check(branches)
        else:
            wanted = ranges = tuple(number_ways.read(self.name, self.number, branches))
            self.ranges = (*self.ranges, *ranges)
        return dict(zip(wanted, branches.values(), strict=True))

    def _check(self, branches: Mapping[Value, object]) -> None:
        allowed = ", ".join(map(shown, self.answers))
        for answer in branches:
            if answer not in self.answers:
                raise RecipeError(f"{self.name} never answers {quoted(answer)}; its answers: {allowed}")
        for answer in self.answers:
            if answer not in branches:
                raise RecipeError(f"choose has no way for {quoted(answer)}, which {self.name} may answer")


class Ask(Act, Question):
    """A question to a device or a person; `by` is the name of who answers, `asked` the question in words."""

    by = asked = ""
    _answer: Value | None = None  # of an earlier start of the plant

    @property
    def answer(self) -> Value | None:
        """The answer; None where there is none yet."""
        return self._answer if self.entry is None else self.entry.answer

    def kept(self) -> Mapping[str, Any] | None:
        return super().kept() if self.answer is None else {"answer": self.answer}

    def restore(self, state: Mapping[str, Any]) -> None:
        if "answer" in state:
            self._answer = state["answer"]
        else:
            super().restore(state)

    def _done(self) -> Status:
        if self.answer is not None:
            self.context.note(TaskAnswer(by=self.by, asked=self.asked, answer=self.answer))
        return super()._done()


class FactCheck(Require):
    """Check that a device reports these `facts`."""

    device = ""
    facts: Mapping[str, Wanted] = {}


class FactWait(Await):
    """Wait until a device reports these `facts`."""

    device = ""
    facts: Mapping[str, Wanted] = {}


class AskInZones(composites.Sequence):
    """Question to a device that is in zones while it answers; the zones are taken before."""

    def __init__(self, question: Ask, zones: Sequence[Step]) -> None:
        super().__init__(question.name, memory=True, children=[*zones, question])
        self.asked = question


def question_of(step: object) -> Question | None:
    """The question of a step that asks, also in zones; None for any other step."""
    question = step.asked if isinstance(step, AskInZones) else step
    return question if isinstance(question, Question) else None


class Handle(Offers):
    """A device of the cell: the facts that it may be asked for. Subclasses add its commands."""

    def __init__(self, device: Robot, context: Context) -> None:
        self._device = device
        self._context = context

    def __str__(self) -> str:
        return self._device.name

    def says(self, **facts: Value) -> Step:
        """A check: the device reports these facts, else the task fails."""
        wanted = self._wanted(facts)
        step = FactCheck(SAYS(), self._context.failures, partial(self._objection, wanted))
        step.device, step.facts = self._device.name, wanted
        return step

    def becomes(self, *, at_most_s: float, **facts: Value) -> Step:
        """Wait until the device reports these facts, at most `at_most_s` s."""
        facts_wanted = self._wanted(facts)

        def late() -> Failure:
            name = self._unsaid(facts_wanted)[0]
            sentence = NOT_YET(
                robot=self._device.name, value=value_text(facts_wanted[name]), fact=name, seconds=at_most_s
            )
            return Failure(reason=Reason.DEADLINE, sentence=sentence)

        step = FactWait(BECOMES(), self._context, lambda: not self._unsaid(facts_wanted), at_most_s, late)
        step.device, step.facts = self._device.name, facts_wanted
        return step

    def _of(self, step: StepOf) -> StepOf:
        """The step, in which commands to a shared device are marked; steps inside are marked already."""
        if self._device.name in self._context.cell.shared:
            for node in step.iterate():
                if isinstance(node, Leaf) and node.uses is None:
                    node.uses = self._device.name
        return step

    def _wanted(self, facts: Mapping[str, Value]) -> Mapping[str, Wanted]:
        """The facts with what they have to be; UseError for a fact that the device never reports."""
        return facts

    def _unsaid(self, facts: Mapping[str, Wanted]) -> list[str]:
        """The names of the facts that the device does not report."""
        return [name for name, wanted in facts.items() if not is_so(wanted, self._reported(name))]

    def _reported(self, fact: str) -> Value | None:
        return self._context.robots.fact(self._device.name, fact)

    def _objection(self, facts: Mapping[str, Wanted]) -> Failure | None:
        for name in self._unsaid(facts):
            reported, value = value_text(self._reported(name)), value_text(facts[name])
            sentence = NOT_SO(robot=self._device.name, told=reported, fact=name, value=value)
            return Failure(reason=Reason.PRECONDITION, sentence=sentence)
        return None


class DeviceHandle(Handle):
    """A device that is told the verbs of its kind: `mill.run(program=1001)`."""

    _device: Device

    def _wanted(self, facts: Mapping[str, Value]) -> Mapping[str, Wanted]:
        return {name: fact_wanted(self._device.kind, name, value) for name, value in facts.items()}

    def __getattr__(self, verb: str) -> Callable[..., Step]:
        kind = self._device.kind
        if verb not in kind.verbs:
            raise UseError(f"a {kind.name} has no verb {quoted(verb)}; {among(verb, kind.verbs)}")

        def step(*in_order: Value, **values: Value) -> Step:
            names = [name for name, _ in kind.verbs[verb].parameters]
            if len(in_order) > len(names):
                raise RecipeError(f"{verb} of a {kind.name} takes {', '.join(names) or 'no values'}")
            given = dict(zip(names, in_order, strict=False)) | values
            name = self._device.name

            def make(id: str) -> Any:
                return kind.command(id=id, robot=name, verb=verb, values=given)

            order = make("")  # raises UseError for wrong values at once
            zones = interlocked(self._context, order)
            words = " ".join([verb, *map(shown, given.values())])
            if not isinstance(order, QueryCall):
                act = self._of(Act(f"{name} {words}", self._context, make, DOING(order=words)))
                return sequence(act.title, *zones, act) if zones else act
            question = Ask(f"{name} {words}", self._context, make, DOING(order=words))
            question.answers, question.by, question.asked = order.definition.answers, name, words
            if order.definition.number is not None:
                question.number = order.definition.number
            self._of(question)
            return titled(AskInZones(question, zones), question.title) if zones else question

        step.__name__, step.__qualname__ = verb, f"{self._device.name}.{verb}"
        return step


class PersonHandle(Handle):
    """A person, who answers on the page, on the command line, over HTTP or ROS 2."""

    _device: Person

    def ask(self, question: str, answers: Sequence[str] = ("done",), *, at_most_s: float = PATIENCE_S) -> Ask:
        """Ask the person, and wait for one of the answers; a question for `cell.choose`."""
        if not question.strip() or len(question) > LONGEST_QUESTION:
            raise RecipeError(f"a question has 1 to {LONGEST_QUESTION} characters; this one {len(question)}")
        wrong = [
            each
            for each in answers
            if each != " ".join(each.split()) or "/" in each or not 0 < len(each) <= LONGEST_ANSWER
        ]
        if not answers or wrong or len(set(map(spelling, answers))) < len(answers):
            allowed = f"different words, each 1 to {LONGEST_ANSWER} characters without /"
            raise RecipeError(f"the answers to {quoted(question)} must be {allowed}")

        name = self._device.name

        def make(id: str) -> Any:
            offered = tuple(answers)
            return AskPerson(id=id, robot=name, question=question, offered=offered, patience_s=at_most_s)

        step = Ask(ASK(person=name), self._context, make, ASKING(person=name))
        step.answers, step.by, step.asked = tuple(answers), name, question
        self._of(step)
        return step


@dataclass(frozen=True)
class Pick:
    """Stop of a tour at which the robot takes hold of a part.

    `check` True: the piece sensor has to see the part before and after. "auto": if the robot has a sensor.
    None: as the cell says.
    """

    target: str
    check: PieceCheck | None = None


@dataclass(frozen=True)
class Place:
    """Stop of a tour at which the robot lets go of its part; `check` as for a `Pick`."""

    target: str
    check: PieceCheck | None = None


class RobotHandle(Handle):
    """A robot that goes from target to target: an arm, or a mobile robot."""

    def go(self, target: str) -> Step:
        """Go to a target and stay there; from a target in a shared zone, the robot goes home."""
        return self.visit(target)

    def visit(self, target: str, *work: Step | Sequence[Step]) -> Step:
        """Go to a target and do the work there."""
        pose = self._pose(target)
        there = flat(work, "visit")
        check_holds_none("a visit", there)
        parts = visit_from_anywhere(self._context, self._device.name, pose, there)
        return self._of(sequence(VISIT(pose=pose.sentence), *parts))

    def tour(self, *stops: str | Pick | Place) -> Step:
        """Go from target to target, take hold and let go there, and stay at the last target.

        A leg leads from one target outside all zones to the next such target. Its zones are held over the
        whole leg, also during work, so that no other robot gets between two stops in a zone.
        """
        name = self._device.name
        poses = [self._pose(each if isinstance(each, str) else each.target) for each in stops]
        if not poses or poses[-1].zones:
            why = f"{zone_plan.lying(poses[-1])}; it waits there" if poses else "it has no stops"
            raise RecipeError(f"{name}: a tour has to end outside all zones, and {why}")
        visits = [(pose, self._work(stop, pose)) for stop, pose in zip(stops, poses, strict=True)]
        return self._of(chain(TOUR(), tour(self._context, name, visits)))

    def _work(self, stop: str | Pick | Place, pose: Pose) -> list[Step]:
        if isinstance(stop, str):
            return []
        check = self._context.cell.piece_check if stop.check is None else stop.check
        if isinstance(stop, Pick):
            return grip(self._context, self._device.name, pose, check=check)
        return let_go(self._context, self._device.name, check=check)

    def follow(self, path: str) -> Step:
        """Drive over a path of the cell, by its code; before that to its start, where the cell allows it."""
        space = self._context.cell.reach[self._device.name]
        codes = [each.code for each in space.paths]
        if path not in codes:
            raise RecipeError(f"{self._device.name} has no path {quoted(path)}; {among(path, codes)}")
        return self._of(chain(FOLLOW(path=path), follow(self._context, self._device.name, space.path(path))))

    def home(self) -> Step:
        """Go to the target where the robot waits."""
        return self._of(go_home(self._context, self._device.name))

    def grip(self) -> Step:
        """Take hold of a part."""
        hand = self._context.cell.workspaces[self._device.name].hand
        hand.grip(id="")  # raises an error at once if the hand cannot grip
        return self._of(unchecked_grip(self._context, self._device.name))

    def let_go(self) -> Step:
        """Let go of the part."""
        (off,) = let_go(self._context, self._device.name, check=False)
        return self._of(off)

    def brings_back_to(self, target: str) -> None:
        """Have a recovery bring the robot's part to this target, and not to where the part was taken."""
        self._context.parts.back[self._device.name] = self._pose(target)

    def _pose(self, target: str) -> Pose:
        poses = self._context.cell.reach[self._device.name].targets
        if target not in poses:
            raise RecipeError(f"{self._device.name} has no target {quoted(target)}; {among(target, poses)}")
        return poses[target]


def handle(device: Robot, context: Context) -> Any:
    """The handle by which a recipe uses this device."""
    if device.name in context.cell.reach:
        return RobotHandle(device, context)
    own = nearest(HANDLES, type(device))
    if own is None:
        raise RecipeError(f"{device.name} has no verbs, and no targets in {context.cell.name}")
    return own(device, context)


HANDLES: dict[type[Robot], Callable[[Any, Context], Handle]] = {Device: DeviceHandle, Person: PersonHandle}


def named(step: object) -> str:
    return step.name if isinstance(step, Behaviour) else quoted(step)


def value_text(value: Wanted | None) -> str:
    if isinstance(value, Range):
        return value.text
    return "nothing" if value is None else shown(value)


class Chain(composites.Sequence):
    """Steps one after the other; a sequence around them takes them over, so that fewer nodes are ticked."""

    frame = True
    is_taken = False  # True: another sequence has taken over the steps

    def dissolved(self) -> list[Step]:
        """The steps, which lose this parent."""
        steps = list(self.children)
        self.remove_all_children()
        self.is_taken = True
        return steps


def chain(title: Sentence, parts: Sequence[Step]) -> Chain:
    """A chain of steps with this title."""
    made = Chain(str(title), memory=True, children=list(parts))
    titled(made, title)
    return made


def flat(parts: Sequence[Step | Sequence[Step]], where: str = "work") -> list[Step]:
    """The steps in their order, a chain as its steps. RecipeError for an object that is no step."""
    listed: list[Step] = []
    for part in parts:
        if not isinstance(part, Behaviour) and is_list(part):
            listed += part
        else:
            listed.append(part)  # type: ignore[arg-type]
    steps_in_order: list[Step] = []
    for step in listed:
        usable(step, f"{where} is given")
        if isinstance(step, Chain):
            steps_in_order += step.dissolved()
        else:
            steps_in_order.append(step)
    if len(set(map(id, steps_in_order))) < len(steps_in_order):
        twice = next(step for number, step in enumerate(steps_in_order) if step in steps_in_order[:number])
        raise RecipeError(TWICE.format(step=twice.name))
    return steps_in_order


def is_list(part: object) -> TypeGuard[Iterable[Any]]:
    return isinstance(part, Iterable) and not isinstance(part, str | Behaviour)


def usable(step: object, context: str, rule: str = "it takes steps, e.g. mill.open()") -> Step:
    """The step, if it is one and no other step has it; else RecipeError, which begins with `context`."""
    if not isinstance(step, Behaviour):
        if callable(step):
            name = getattr(step, "__qualname__", type(step).__name__)
            raise RecipeError(f"{context} {name} without its parentheses: write {name}()")
        raise RecipeError(f"{context} {quoted(step)}; {rule}")
    if step.parent is not None or (isinstance(step, Chain) and step.is_taken):
        raise RecipeError(TWICE.format(step=step.name))
    return step
