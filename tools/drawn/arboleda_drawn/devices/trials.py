"""Trials at the end of a drawn recipe: steps that have to fail, which would succeed with an engine at fault.

They have dice of their own, so that the rest of a recipe does not depend on them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from arboleda_proofs.simulator.chance import Dice

from .blocks import Blocks
from .hands import Hand
from .kinds import SPARE, Verb, another_value, value_of
from .layout import Device, Layout, Parts
from .state import Planner, State
from .steps import (
    Ask,
    Becomes,
    Choose,
    Fail,
    Home,
    Invert,
    Param,
    Parameter,
    Recover,
    Retry,
    Says,
    Step,
    Tell,
    Timeout,
    Value,
    Visit,
    Wait,
    Work,
)

OFTEN = 0.9  # how often a recipe ends with trials
LONGEST_S = 4.0  # that its verbs take together
SOON_S = 0.3
TRIES = 5
TRIALS = (1, 2, 2, 3)
SEEN_BY_FACTS = ("facts", "joints")
Trial = Callable[[], list[Step]]
FAILING: tuple[tuple[str, Step], ...] = (
    ("rejected", Fail(sentence="as it is drawn")),
    ("deadline", Timeout(step=Wait(seconds=1), seconds=0.2)),
)


class Trials:
    """Drawer of trials, with devices that no other cell has."""

    def __init__(self, dice: Dice, layout: Layout, *, as_xml: bool) -> None:
        self._dice = dice
        self._layout = layout
        self._as_xml = as_xml
        self._planner = Planner(layout, dice)
        self._devices = [each for each in layout.devices if not (each.is_shared or each.tool_of)]
        self._people = [each for each in layout.people if each not in layout.shared_people]
        self._asked = 0

    def draw(self) -> list[Step]:
        """The steps of some trials, or none."""
        if not self._dice.chance(OFTEN):
            return []
        rows = self._rows()
        steps: list[Step] = []
        for _ in range(self._dice.pick(TRIALS) if rows else 0):
            drawn = (self._dice.pick(rows)() for _ in range(TRIES))
            steps += next(filter(None, drawn), [])
        return steps

    def _rows(self) -> list[Trial]:
        by_facts = [each for each in self._devices if each.evidence in SEEN_BY_FACTS]
        rows: list[Trial] = [partial(self._several_facts, each) for each in self._devices if _has_two(each)]
        rows += [partial(self._both_at_once, each) for each in self._devices if each.kind.spare]
        rows += [partial(self._both_at_once, each) for each in by_facts if each.kind.spare] * 2
        rows += [partial(self._twice, each) for each in by_facts] * 2
        rows += [partial(self._in_vain, each) for each in self._people]
        if not self._as_xml:
            rows += [partial(self._again_for_some_causes, each) for each in self._devices]
        return rows

    def of_parts(self) -> list[Step]:
        """Grips that the plant has to refuse, by a tool: of a second part, of none, and where no room is."""
        parts = self._layout.parts
        robot = None if parts is None else self._layout.robot(parts.robot)
        if parts is None or robot is None or not robot.tool or robot.is_shared or len(parts.sources) < 2:
            return []
        moves = PartMoves(self._dice, self._layout, parts)
        trials = [moves.second_part] + ([moves.no_part, moves.no_room] if parts.nest else [])
        return self._dice.pick(trials)() or []

    def _in_vain(self, person: str) -> list[Step]:
        """A rescue that fails, too, after one of the answers of a person: the first cause is told."""
        self._asked += 1
        answer = f"t{self._asked}"
        ask = Ask(role=person, question="Go on?", answers=("yes", "no"), at_most_s=900.0, answer=answer)
        failing = Recover(work=Fail(sentence="a person says no"), rescue=Fail(sentence="nothing helps"))
        return [ask, Choose(answer=answer, ways=(("yes", Work()), ("no", failing)))]

    def _both_at_once(self, device: Device) -> list[Step]:
        """A verb that sets two facts, of which one is so already; then a check of both."""
        verb = device.kind.verb(SPARE)
        sets = list(verb.sets)
        so, other = sets if self._dice.chance(0.5) else reversed(sets)
        wrong = another_value(self._dice, device.kind.type_of(other[0]), other[1])
        before = [(device.role, *so), (device.role, other[0], wrong)]
        made = self._planner.establish(State(), before)
        if made is None or not self._may(made[0]):
            return []
        tell = Tell(role=device.role, verb=verb.name)
        (fact, value), *also = sets
        check = Says(role=device.role, fact=fact, value=value, also=tuple(also))
        return [*made[0], tell, *([check] if device.tells_facts else [])]

    def _twice(self, device: Device) -> list[Step]:
        """Work that shows in facts, and the same once more, which changes none."""
        verbs = [each for each in device.kind.verbs if _is_free(each) and each.effect == "process"]
        if not verbs:
            return []
        verb = self._dice.pick(verbs)
        values = self._planner.values(verb)
        made = self._planner.tell(State(), device.role, verb, values)
        if made is None or not self._may([*made[0], made[0][-1]]):
            return []
        return [*made[0], made[0][-1]]

    def _again_for_some_causes(self, device: Device) -> list[Step]:
        """A verb before a failure, which is tried again only where the failure is for one of some causes."""
        dice = self._dice
        verbs = [each for each in device.kind.verbs if _is_free(each)]
        if not verbs:
            return []
        verb = dice.pick(verbs)
        made = self._planner.tell(State(), device.role, verb, self._planner.values(verb))
        if made is None or not self._may(made[0]):
            return []
        reason, failing = dice.pick(FAILING)
        other = next(each for each, _ in FAILING if each != reason)
        again = Retry(
            step=Work(steps=(*made[0], failing)),
            times=dice.pick((1, 2)),
            pause_s=dice.pick((0, 0.5)),
            causes=dice.pick(((reason,), (other,), (other, "device_fault"))),
        )
        return [Invert(step=again)]

    def _several_facts(self, device: Device) -> list[Step]:
        """Checks of two facts of a device: that both are so, and that one of them is not."""
        dice, kind = self._dice, device.kind
        first = dice.pick(kind.is_settable)
        second = dice.pick([each for each in kind.is_settable if each != first])
        facts = {each: value_of(dice, kind.type_of(each)) for each in (first, second)}
        made = self._planner.establish(State(), [(device.role, *each) for each in facts.items()])
        if made is None or not self._may(made[0]):
            return []
        other = another_value(dice, kind.type_of(second), facts[second])
        right, wrong = [*facts.items()], [(first, facts[first]), (second, other)]
        if dice.chance(0.5):
            wrong.reverse()
        trials = [Invert(step=self._of(device, wrong, SOON_S)), self._of(device, right, 5)]
        return [*made[0], *(trials if dice.chance(0.5) else reversed(trials))]

    def _of(self, device: Device, facts: list[tuple[str, Value]], at_most_s: float) -> Step:
        (fact, value), *also = facts
        if self._dice.chance(0.5):
            return Says(role=device.role, fact=fact, value=value, also=tuple(also))
        return Becomes(role=device.role, fact=fact, value=value, also=tuple(also), at_most_s=at_most_s)

    def _may(self, tells: list[Tell]) -> bool:
        """True for verbs that are soon done, of devices that no other cell has."""
        devices = [self._layout.device(each.role) for each in tells]
        verbs = [each.kind.verb(tell.verb) for each, tell in zip(devices, tells, strict=True)]
        is_ours = not any(each.is_shared for each in devices)
        return is_ours and sum(each.takes_s for each in verbs) <= LONGEST_S


class PartMoves:
    """Moves of parts with one that the plant has to refuse; None where something that they need cannot be.

    Each leaves the hand empty, and the robot at home.
    """

    def __init__(self, dice: Dice, layout: Layout, parts: Parts) -> None:
        self._blocks = Blocks(dice, layout, _no_parameter)
        self._hand = Hand(layout, parts.robot, dice)
        first = dice.pick(parts.sources)
        self._sources = (first, dice.pick([each for each in parts.sources if each != first]))
        self._parts = parts

    def second_part(self) -> list[Step] | None:
        """A part is taken while the hand has one."""
        first, second = self._sources
        return self._all(self._take(first), self._refused(self._take(second)), self._put(self._parts.goal))

    def no_part(self) -> list[Step] | None:
        """A part is taken where none is."""
        return self._all(self._refused(self._take(self._parts.nest)))

    def no_room(self) -> list[Step] | None:
        """A second part is put where there is room for one."""
        (first, second), nest, goal = self._sources, self._parts.nest, self._parts.goal
        return self._all(
            *(self._take(first), self._put(nest), self._take(second), self._refused(self._put(nest))),
            *(self._put(goal), self._take(nest), self._put(goal)),
        )

    def _take(self, target: str) -> list[Step] | None:
        return self._blocks.visit(self._parts.robot, target, self._hand.grip)

    def _put(self, target: str) -> list[Step] | None:
        return self._blocks.visit(self._parts.robot, target, self._hand.let_go)

    def _refused(self, steps: list[Step] | None) -> list[Step] | None:
        """The same, where the plant refuses what the hand is told."""
        if steps is None:
            return None
        *before, visit = steps
        assert isinstance(visit, Visit) and isinstance(visit.body, Tell)
        return [*before, Invert(step=replace(visit, body=replace(visit.body, refused=True)))]

    def _all(self, *moves: list[Step] | None) -> list[Step] | None:
        if any(move is None for move in moves):
            return None
        return [*(step for move in moves for step in move or ()), Home(role=self._parts.robot)]


def _no_parameter(make: Callable[[str], Parameter]) -> Param:
    raise AssertionError("a trial has fixed values")


def _has_two(device: Device) -> bool:
    """True for a device that tells two facts, each of which can be made so."""
    return device.tells_facts and len(device.kind.is_settable) > 1


def _is_free(verb: Verb) -> bool:
    """True for a verb that can be told at any time, as often as one likes."""
    return verb.effect != "query" and not verb.holds and not verb.works_on
