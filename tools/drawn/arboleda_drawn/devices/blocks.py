"""Blocks of a drawn recipe: steps within steps, as people nest them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from arboleda_proofs.simulator.chance import Dice

from .durations import longest_s
from .kinds import Span, Verb
from .layout import Device, Layout, Need, Robot
from .state import Planner, State
from .steps import (
    Ask,
    Becomes,
    Choice,
    Choose,
    Fail,
    Fallback,
    Follow,
    Go,
    Home,
    Invert,
    Limits,
    OfPaths,
    Parallel,
    Param,
    Parameter,
    Recover,
    Repeat,
    Retry,
    Says,
    Step,
    Tell,
    Timeout,
    Tour,
    Value,
    Visit,
    Wait,
    Work,
)

QUESTIONS = ("¿Está lleno?", "Full again?", "Is it good", "Grün?")
PEOPLE_SAY = (("yes", "no"), ("sí", "no"), ("done",), ("good", "bad", "no sé"))
PATIENCE_S = 900.0
MOST_CHOSEN = 2  # choices within one another
STANDS_S = 1.5  # until a device that was left surely stands
WAITS_S = (0, 0.05, 0.3, 1, 2.5)

MakeParameter = Callable[[Callable[[str], Parameter]], Param]


def _choice(words: tuple[Value, ...], name: str) -> Parameter:
    return Choice(name=name, words=words)


def _limits(span: Span, name: str) -> Parameter:
    return Limits(name=name, lower=span.lower, upper=span.upper)


def _path(name: str) -> Parameter:
    return OfPaths(name=name)


class Blocks:
    """Draws blocks and follows the state; `state` is that after the last one.

    Roles of `apart_from` are not touched; those of `resting` stay as they are, as a part depends on them.
    """

    def __init__(self, dice: Dice, layout: Layout, parameter: MakeParameter) -> None:
        self.state = State()
        self.apart_from: frozenset[str] = frozenset()
        self.resting: frozenset[str] = frozenset()
        self._dice = dice
        self._layout = layout
        self._planner = Planner(layout, dice)
        self._parameter = parameter
        self._within: frozenset[str] | None = None  # roles of this branch of a parallel
        self._answers = 0
        self._chosen_in = 0

    def draw(self, depth: int) -> Step:
        """A block of at most so many levels."""
        dice = self._dice
        steps: list[Step] = []
        for _ in range(dice.pick((1, 2, 3))):
            simple = depth <= 0 or dice.chance(0.45)
            steps += self._simple() if simple else self._nested(depth)
        return Work(steps=tuple(steps)) if steps else Wait(seconds=dice.pick(WAITS_S))

    def visit(self, role: str, target: str | Param, work: tuple[Step, list[Need]]) -> list[Step] | None:
        """A visit with a step of the hand, after all that it needs; None where that cannot be."""
        inner, needs = work
        door = self._layout.robot(role).door(target)
        made = self._planner.establish(self.state, [*needs, *([door] if door else [])])
        if made is None or not self._may([*made[0], inner]):
            return None
        self.state = made[1]
        return [*made[0], Visit(role=role, target=target, body=inner)]

    def tour(self, role: str, source: str | Param, goal: str) -> list[Step] | None:
        """A tour that brings a part from one target to another; None where that cannot be."""
        doors = [self._layout.robot(role).door(each) for each in (source, goal)]
        made = self._planner.establish(self.state, [each for each in doors if each])
        if made is None or not self._may([*made[0]]):
            return None
        self.state = made[1]
        return [*made[0], Tour(role=role, source=source, goal=goal)]

    def work_on_part(self, role: str) -> list[Step]:
        """The work of a machine that needs a part, while one is there; nothing where it has none."""
        verbs = [each for each in self._layout.device(role).kind.verbs if each.works_on]
        if not verbs:
            return []
        made = self._planner.tell(self.state, role, verbs[0], self._planner.values(verbs[0]))
        if made is None or not self._may([*made[0]]):
            return []
        self.state = made[1]
        return list(made[0])

    # -- simple steps

    def _simple(self) -> list[Step]:
        makers = [self._tell] * 5 + [self._query] * 3 + [self._ask, self._wait, self._fact, self._fact]
        makers += [self._go] * 3 + [self._refused] * 4
        for _ in range(6):
            if made := self._dice.pick(makers)():
                return made
        return [self._wait()[0]]

    def _free(self, role: str) -> bool:
        return (
            role not in self.apart_from
            and role not in self.resting
            and (self._within is None or role in self._within)
        )

    def _may(self, steps: list[Step]) -> bool:
        """True if none of these steps touches what this block must leave."""
        roles = {str(getattr(step, "role", "")) for step in steps} - {""}
        return all(self._free(role) for role in roles)

    def _devices(self) -> list[Device]:
        return [each for each in self._layout.devices if self._free(each.role) and not each.tool_of]

    def _tell(self) -> list[Step]:
        dice, devices = self._dice, self._devices()
        if not devices:
            return []
        device = dice.pick(devices)
        verbs = [each for each in device.kind.verbs if each.effect != "query" and not each.works_on]
        if not verbs:
            return []
        verb = dice.pick(verbs)
        if verb.holds:
            return self._clamped(device)
        made = self._planner.tell(self.state, device.role, verb, self._planner.values(verb))
        if made is None or not self._may([*made[0]]):
            return []
        self.state = made[1]
        *before, told = made[0]
        return [*before, self._by_name(device, told)]

    def _by_name(self, device: Device, tell: Tell) -> Tell:
        """The verb, now and then with a parameter of the recipe for a value that sets nothing."""
        verb = device.kind.verb(tell.verb)
        if verb.sets or not self._dice.chance(0.4):
            return tell
        for name, type in verb.parameters:
            if isinstance(type, tuple | Span):
                make = partial(_choice, type) if isinstance(type, tuple) else partial(_limits, type)
                made = self._parameter(make)
                rest = tuple(each for each in tell.values if each[0] != name)
                return replace(tell, values=(*rest, (name, made)))
        return tell

    def _clamped(self, device: Device) -> list[Step]:
        """A block while something is clamped, and let go of after it."""
        parts = self._layout.parts
        if parts is not None and parts.machine == device.role:
            return []  # there is a part only while one is carried
        verb, fact = device.kind.verb("clamp"), (device.role, device.kind.clamp)
        if fact in self.state.frozen:
            return []
        made = self._planner.tell(self.state, device.role, verb, (("on", True),))
        if made is None or not self._may([*made[0]]):
            return []
        needs = {need[:2] for need in self._layout.all_needs(device.role, verb)}
        frozen = self.state.frozen
        self.state = made[1].frozen_with({fact, *needs})
        inner = self._simple()
        off = Tell(role=device.role, verb="clamp", values=(("on", False),))
        self.state = replace(self.state.with_fact(*fact, False), frozen=frozen)
        return [*made[0], *inner, off]

    def _query(self) -> list[Step]:
        dice = self._dice
        rows = [
            (each, verb) for each in self._devices() for verb in each.kind.verbs if verb.effect == "query"
        ]
        if not rows:
            return []
        device, verb = dice.pick(rows)
        answer = self._variable()
        made = self._planner.tell(self.state, device.role, verb, self._planner.values(verb), answer)
        if made is None or not self._may([*made[0]]):
            return []
        self.state = made[1]
        return [*made[0], *self._chosen(answer, verb.answers)]

    def _ask(self) -> list[Step]:
        people = [each for each in self._layout.people if self._free(each)]
        if not people:
            return []
        dice, answer = self._dice, self._variable()
        words = dice.pick(PEOPLE_SAY)
        question = Ask(
            role=dice.pick(people),
            question=dice.pick(QUESTIONS),
            answers=words,
            at_most_s=PATIENCE_S,
            answer=answer,
        )
        return [question, *self._chosen(answer, words)]

    def _chosen(self, answer: str, words: tuple[Value, ...]) -> list[Step]:
        """A way for each of the answers, or nothing that depends on it."""
        dice = self._dice
        if dice.chance(0.3) or self._chosen_in >= MOST_CHOSEN:
            return []
        self._chosen_in += 1
        before, ends, ways = self.state, [], []
        for number, word in enumerate(words):
            self.state = before
            fails = number > 0 and self._may_fail and dice.chance(0.15)
            way = Fail(sentence=f"it says {word}") if fails else self._way()
            if not fails:
                ends.append(self.state)
            ways.append((word, way))
        self.state, self._chosen_in = before.met(ends), self._chosen_in - 1
        return [Choose(answer=answer, ways=tuple(ways))]

    @property
    def _may_fail(self) -> bool:
        """True where no part is under way: a task that fails would leave it there."""
        return not self.resting and not self.state.frozen

    def _way(self) -> Step:
        steps: list[Step] = [] if self._dice.chance(0.3) else self._simple()
        return Work(steps=tuple(steps))

    def _wait(self) -> list[Step]:
        return [Wait(seconds=self._dice.pick(WAITS_S))]

    def _fact(self) -> list[Step]:
        """A check of what is known, or a wait for it."""
        shared = self._layout.shared_roles
        known = [
            (role, fact, value)
            for (role, fact), value in self.state.facts.items()
            if self._free(role) and role not in shared and self._layout.device(role).tells_facts
        ]
        if not known:
            return []
        role, fact, value = self._dice.pick(known)
        if self._dice.chance(0.5):
            return [Says(role=role, fact=fact, value=value)]
        return [Becomes(role=role, fact=fact, value=value, at_most_s=self._dice.pick((5, 60)))]

    def _go(self) -> list[Step]:
        dice = self._dice
        robots = [each for each in self._layout.robots if self._free(each.role)]
        if not robots:
            return []
        robot = dice.pick(robots)
        if robot.paths and not robot.doors and dice.chance(0.5):
            return [self._driven(robot)]
        target = "home" if dice.chance(0.25) else dice.pick(robot.targets)
        door = robot.door(target)
        made = self._planner.establish(self.state, [door] if door else [])
        if made is None or not self._may([*made[0]]):
            return []
        self.state = made[1]
        if target == "home" and dice.chance(0.7):
            return [*made[0], Home(role=robot.role)]
        if dice.chance(0.5):
            return [*made[0], Go(role=robot.role, target=target)]
        return [*made[0], self._visited(robot.role, target, door)]

    def _driven(self, robot: Robot) -> Step:
        """A drive over one of the paths of a robot, or over that which the task names."""
        if self._dice.chance(0.3):
            return Follow(role=robot.role, path=self._parameter(_path))
        return Follow(role=robot.role, path=self._dice.pick(robot.paths))

    def _visited(self, role: str, target: str, door: Need | None) -> Step:
        """A visit with work, during which the door stays as it is and no robot moves."""
        frozen, resting = self.state.frozen, self.resting
        robots = {each.role for each in self._layout.robots}
        tools = {each.role for each in self._layout.devices if each.tool_of or each.is_shared}
        self.resting = resting | robots | tools
        if door is not None:
            self.state = self.state.frozen_with([door[:2]])
        steps = self._simple()
        self.state, self.resting = replace(self.state, frozen=frozen), resting
        return Visit(role=role, target=target, body=Work(steps=tuple(steps)))

    def _variable(self) -> str:
        self._answers += 1
        return f"a{self._answers}"

    # -- nested steps

    def _nested(self, depth: int) -> list[Step]:
        makers = (
            self._parallel,
            self._parallel,
            self._retry,
            self._retry,
            self._timeout,
            self._repeat,
            self._fallback,
            self._recover,
            self._invert,
            self._left,
            self._left,
        )
        return self._dice.pick(makers)(depth - 1)

    def _retry(self, depth: int) -> list[Step]:
        step = self._again(depth)
        return [Retry(step=step, times=self._dice.pick((1, 2, 5)), pause_s=self._dice.pick((0, 0.5, 1)))]

    def _repeat(self, depth: int) -> list[Step]:
        return [Repeat(step=self._again(depth), times=self._dice.pick((1, 2, 3)))]

    def _again(self, depth: int) -> Step:
        """A block that is right however often it is done."""
        self.state = self.state.unknown()
        return self.draw(depth)

    def _timeout(self, depth: int) -> list[Step]:
        step = self.draw(depth)
        return [Timeout(step=step, seconds=longest_s(step, self._layout))]

    def _recover(self, depth: int) -> list[Step]:
        before = self.state
        work = self.draw(depth)
        after, self.state = self.state, before.unknown()
        rescue = self.draw(0)
        self.state = after
        return [Recover(work=work, rescue=rescue)]

    def _fallback(self, depth: int) -> list[Step]:
        """Ways of which the first ones fail."""
        failing = [self._failing() for _ in range(self._dice.pick((1, 1, 2)))]
        return [Fallback(steps=(*failing, self._again(depth)))]

    def _invert(self, depth: int) -> list[Step]:
        step = self._failing()
        return [Invert(step=step)]

    def _failing(self) -> Step:
        """A step that fails and leaves nothing behind."""
        dice = self._dice
        known = [
            (role, fact)
            for role, fact in self.state.facts
            if self._free(role)
            and role not in self._layout.shared_roles
            and self._layout.device(role).tells_facts
            and self._layout.device(role).kind.type_of(fact) in ("bool",)
        ]
        if known and dice.chance(0.4):
            role, fact = dice.pick(known)
            return Says(role=role, fact=fact, value=not self.state.facts[role, fact])
        if dice.chance(0.5):
            return Timeout(step=Wait(seconds=dice.pick((1, 3))), seconds=dice.pick((0, 0.2, 0.9)))
        return Work(steps=(Wait(seconds=dice.pick(WAITS_S)), Fail(sentence="as it is drawn")))

    def _left(self, depth: int) -> list[Step]:
        """Long work of a device that is left before its end, which is answered."""
        dice = self._dice
        rows = [
            (each, verb)
            for each in self._devices()
            if each.section.get("stop") != "none"
            for verb in each.kind.verbs
            if verb.effect in ("motion", "process") and verb.takes_s >= 1 and not verb.finishes
            if not verb.works_on
        ]
        if not rows or self.state.frozen or self.resting:
            return []
        device, verb = dice.pick(rows)
        made = self._planner.tell(self.state, device.role, verb, self._planner.values(verb))
        if made is None or not self._may([*made[0]]):
            return []
        *before, told = made[0]
        self.state = made[1].without([(device.role, fact) for fact, _ in verb.sets])
        after_s = round(verb.takes_s * dice.pick((0.2, 0.5)), 3)
        left: Step = Timeout(step=told, seconds=after_s)
        if dice.chance(0.4):
            fails = Work(steps=(Wait(seconds=after_s), Fail(sentence="the other branch")))
            left = Parallel(branches=(fails, told))
        return [*before, Fallback(steps=(left, Wait(seconds=STANDS_S)))]

    def _refused(self) -> list[Step]:
        """A verb that the plant has to refuse: a fact that it needs is another one, or no part is there."""
        verbs = [
            (each, verb)
            for each in self._devices()
            if not each.is_shared and each.role not in self._layout.lock_roles
            for verb in each.kind.verbs
            if not verb.holds and (each.role, verb.name) not in self._layout.waits
            if self._is_unmet(each, verb)
        ]
        if not verbs:
            return []
        device, verb = self._dice.pick(verbs)
        answer = self._variable() if verb.effect == "query" else ""
        values = self._planner.values(verb)
        tell = Tell(role=device.role, verb=verb.name, values=values, answer=answer, refused=True)
        return [Invert(step=tell)]

    def _is_unmet(self, device: Device, verb: Verb) -> bool:
        """True where it is known that a fact which a verb needs is another one, or that it has no part."""
        if verb.works_on:
            return not self.resting
        needs = self._layout.all_needs(device.role, verb)
        believed = [
            each for each in needs if self._free(each[0]) and self._layout.device(each[0]).tells_facts
        ]
        return any(self.state.facts.get(each[:2], each[2]) != each[2] for each in believed)

    def _parallel(self, depth: int) -> list[Step]:
        """Branches of roles that nothing joins."""
        groups = [each for each in self._layout.apart if any(self._free(role) for role in each)]
        if len(groups) < 2 or self._within is not None:
            return []
        cut = 1 + self._dice.below(len(groups) - 1)
        halves = (frozenset().union(*groups[:cut]), frozenset().union(*groups[cut:]))
        before, branches = self.state, []
        for half in halves:
            self._within = half
            branches.append(self.draw(depth))
        self._within = None
        return [Parallel(branches=tuple(branches))] if before is not None else []
