"""Recipes drawn for a layout, right by construction: before each verb stand those that make its needs so."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from arboleda_proofs.simulator.chance import Dice

from .asked_places import AskedPlaces
from .blocks import Blocks
from .durations import usual_s
from .hands import Hand
from .late_work import LateWork
from .layout import Layout
from .printers import Printer
from .scales import Scale
from .shared_ends import SharedEnds
from .sorters import Sorter
from .steps import (
    Choice,
    Home,
    Limits,
    OfGroup,
    OfPaths,
    Param,
    Parameter,
    Recipe,
    Run,
    Step,
    Using,
    Work,
)
from .trials import Trials

TRIES = 12
LONGEST_TASK_S = 100.0  # as a rule
PHASES = (1, 2, 2, 3, 4)


@dataclass(frozen=True, kw_only=True)
class Beside:
    """Additions to the steps of recipes, each with dice of its own."""

    trials: Trials
    late: LateWork
    places: AskedPlaces | None  # None without parts
    ends: SharedEnds
    printer: Printer
    scale: Scale
    sorter: Sorter


class RecipeDrawer:
    """Draws recipes one after the other; each may run those before it."""

    def __init__(self, dice: Dice, layout: Layout, beside: Beside, *, as_xml: bool) -> None:
        self._dice = dice
        self._beside = beside
        self._layout = layout
        self._as_xml = as_xml  # only what a tree as XML can say
        self._usual_s: dict[str, float] = {}  # by recipe
        self._carrying: set[str] = set()  # recipes that move a part, which a task may do once
        self._drawn: list[Recipe] = []
        self._parameters: list[Parameter] = []

    def draw(self, number: int) -> Recipe:
        """The recipe with this number, one of some that a task has done before anybody grows tired of it."""
        for _ in range(TRIES):
            made, carries = self._draw(number)
            took_s = usual_s(made.step, self._layout, self._usual_s)
            if took_s <= LONGEST_TASK_S:
                break
        tried = self._beside.trials.draw()
        if not carries and (moved := self._beside.trials.of_parts()):
            tried, carries = [*tried, *moved], True
        tried += self._beside.late.draw()
        if printed := self._beside.printer.draw():
            tried, carries = [*tried, *printed], True
        tried += self._beside.scale.draw()
        if tried:
            made = replace(made, step=Work(steps=(made.step, *tried)))
        made = self._beside.sorter.after(made)
        self._drawn.append(made)
        self._usual_s[made.name] = took_s
        self._carrying |= {made.name} if carries else set()
        return made

    def _draw(self, number: int) -> tuple[Recipe, bool]:
        """A recipe, and whether it moves a part."""
        carried: list[Step] = []
        self._parameters = []
        blocks = Blocks(self._dice, self._layout, self._parameter)
        hand = self._layout.shared_hand
        blocks.apart_from = frozenset() if hand else self._using()
        blocks.resting = hand if number % 2 else frozenset()  # every second recipe is beside it
        steps: list[Step] = []
        for _ in range(self._dice.pick(PHASES)):
            steps += self._phase(blocks)
        if self._carries(blocks, often=1.0 if hand else 0.6):
            carried = self._carry(blocks)
            steps += carried
        if not steps:
            steps += self._phase(blocks)
        steps, ends = self._beside.ends.around(steps, blocks.apart_from)
        name, parameters = f"do_{number}", tuple(self._parameters)
        made = Recipe(name=name, parameters=parameters, step=Work(steps=tuple(steps)), ends=ends)
        return made, bool(carried)

    def _carries(self, blocks: Blocks, *, often: float) -> bool:
        may_move = self._layout.parts is not None and not blocks.resting
        return may_move and self._dice.chance(often) and not blocks.apart_from

    def _using(self) -> frozenset[str]:
        """The shared roles that this recipe holds by `using`, and tells nothing outside of it."""
        shared = self._layout.shared_roles
        return frozenset(shared) if shared and not self._as_xml and self._dice.chance(0.4) else frozenset()

    def _phase(self, blocks: Blocks) -> list[Step]:
        dice = self._dice
        if blocks.apart_from and dice.chance(0.5):
            return self._held(blocks)
        if self._subs and dice.chance(0.15) and not blocks.apart_from:
            return self._sub(blocks)
        return [blocks.draw(dice.pick((1, 2, 3)))]

    def _held(self, blocks: Blocks) -> list[Step]:
        """Steps with all shared devices of the recipe, held together."""
        roles, blocks.apart_from = blocks.apart_from, frozenset()
        step = blocks.draw(2)
        blocks.apart_from = roles
        blocks.state = blocks.state.without([key for key in blocks.state.facts if key[0] in roles])
        return [Using(roles=tuple(sorted(roles)), step=step)]

    @property
    def _subs(self) -> list[Recipe]:
        return [each for each in self._drawn if each.name not in self._carrying]

    def _sub(self, blocks: Blocks) -> list[Step]:
        other = self._dice.pick(self._subs)
        values = tuple((each.name, _any_value(self._dice, self._layout, each)) for each in other.parameters)
        blocks.state = blocks.state.unknown()
        return [Run(recipe=other.name, values=values)]

    def _carry(self, blocks: Blocks) -> list[Step]:
        """A part from a rack to the goal, by way of the nest where there is one."""
        parts = self._layout.parts
        assert parts is not None
        hand = Hand(self._layout, parts.robot, self._dice)
        source = self._source(blocks)
        places = self._beside.places
        assert places is not None
        if not parts.nest or self._dice.chance(0.3):
            return places.from_source(source, self._moved(blocks, hand, source, parts.goal) or [])
        before = blocks.state
        there = self._moved(blocks, hand, source, parts.nest)
        if there is None:
            blocks.state = before
            return places.from_source(source, self._moved(blocks, hand, source, parts.goal) or [])
        blocks.resting = frozenset({parts.robot, *([hand.tool] if hand.tool else [])})
        meanwhile = [blocks.draw(2)] if self._dice.chance(0.7) else []
        meanwhile += blocks.work_on_part(parts.machine) if parts.machine else []
        blocks.resting = frozenset()
        back = self._moved(blocks, hand, parts.nest, parts.goal)
        if back is None:
            blocks.state = before
            return []
        there = places.from_source(source, places.to_nest(there))
        return [*there, *meanwhile, *places.from_nest(back), Home(role=parts.robot)]

    def _source(self, blocks: Blocks) -> str | Param:
        parts = self._layout.parts
        assert parts is not None
        if self._as_xml or self._dice.chance(0.5):
            return self._dice.pick(parts.sources)
        made = OfGroup(name=f"p{len(self._parameters) + 1}", group=parts.source)
        self._parameters.append(made)
        return Param(name=made.name)

    def _moved(self, blocks: Blocks, hand: Hand, source: str | Param, goal: str) -> list[Step] | None:
        if self._tours(hand) and self._dice.chance(0.4):
            return blocks.tour(hand.role, source, goal)
        taken = blocks.visit(hand.role, source, hand.grip)
        put = None if taken is None else blocks.visit(hand.role, goal, hand.let_go)
        return None if taken is None or put is None else [*taken, *put]

    def _tours(self, hand: Hand) -> bool:
        """True for an arm with an effector of its own, where the recipe is in Python."""
        return not self._as_xml and not hand.tool and self._layout.robot(hand.role).section["kind"] == "arm"

    def _parameter(self, make: Callable[[str], Parameter]) -> Param:
        name = f"p{len(self._parameters) + 1}"
        self._parameters.append(make(name))
        return Param(name=name)


def _any_value(dice: Dice, layout: Layout, parameter: Parameter) -> bool | int | float | str:
    if isinstance(parameter, Choice):
        return dice.pick(parameter.words)
    if isinstance(parameter, Limits):
        return parameter.lower
    if isinstance(parameter, OfPaths):
        return dice.pick([code for each in layout.robots for code in each.paths])
    return dice.pick(layout.groups[parameter.group])
