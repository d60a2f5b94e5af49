"""Printer of a drawn cell: a device that makes parts at a place from which the hand of a robot takes them.

It has dice of its own, and no other step tells it anything, so that the rest of a plant does not depend on
it.
"""

from __future__ import annotations

from arboleda_proofs.simulator.chance import Dice

from .blocks import Blocks
from .hands import Hand
from .kinds import Kind, Span, Type, Verb, value_of
from .kinds_text import TURNTABLE
from .layout import Layout, Parts, Section
from .steps import Gets, Given, Home, Invert, Param, Step, Tell

OFTEN = 0.3  # how often a cell whose parts a hand moves has one
IN_RECIPES = 0.6  # how often a recipe has it make a part
KIND = ROLE = "printer"
VERB = "form"
BED = "bed"
SOON_S, IN_TIME_S = 0.3, 60.0
NODE = 8  # at which no other target of a mobile robot is
PROGRAMS: tuple[Type, ...] = (Span(lower=1, upper=9), "int", ("cup", "lid"))


class Printer:
    """Drawer of the printer of a cell; `kind` is its kind, None where the cell has none."""

    def __init__(self, dice: Dice, layout: Layout, *, are_written: bool) -> None:
        self._dice = dice
        self._layout = layout
        parts = layout.parts
        self._parts = parts if parts is not None and _can_take(layout, parts) and dice.chance(OFTEN) else None
        self.kind = None if self._parts is None else self._kind(is_written=are_written)

    def join(self, cell: Section) -> None:
        """Put the device, its target and its place into a cell of the plant file."""
        if self.kind is None or self._parts is None:
            return
        cell["devices"][ROLE] = {"kind": KIND}
        if self._dice.chance(0.3):
            cell["devices"][ROLE]["mqtt"] = f"{ROLE}_board"
        cell["targets"][BED] = {self._parts.robot: self._pose()}
        cell["places"][BED] = {"of": ROLE}

    def draw(self) -> list[Step]:
        """A part that is made and brought to where people empty; nothing where the cell has no printer."""
        dice = self._dice
        if self.kind is None or self._parts is None or not dice.chance(IN_RECIPES):
            return []
        blocks = Blocks(dice, self._layout, _no_parameter)
        hand = Hand(self._layout, self._parts.robot, dice)
        taken = blocks.visit(hand.role, BED, hand.grip)
        put = None if taken is None else blocks.visit(hand.role, self._parts.goal, hand.let_go)
        if taken is None or put is None:
            return []
        return [*self._made(), *taken, *put, Home(role=hand.role)]

    def _made(self) -> list[Step]:
        """The making of a part, now and then with waits beside it, or with a second one that has no room."""
        made: list[Step] = [Tell(role=ROLE, verb=VERB, values=self._values())]
        if self._dice.chance(0.4):
            made.insert(0, Gets(place=BED, what="room", at_most_s=IN_TIME_S))
        if self._dice.chance(0.4):
            made.append(Gets(place=BED, what="part", at_most_s=SOON_S))
        if self._dice.chance(0.4):
            made.append(Invert(step=Tell(role=ROLE, verb=VERB, values=self._values(), refused=True)))
        return made

    def _values(self) -> Given:
        assert self.kind is not None
        return tuple((name, value_of(self._dice, type)) for name, type in self.kind.verb(VERB).parameters)

    def _kind(self, *, is_written: bool) -> Kind:
        dice = self._dice
        program = dice.pick(PROGRAMS if is_written else PROGRAMS[1:])
        verb = Verb(
            name=VERB,
            effect="process",
            parameters=(("program", program),) if dice.chance(0.5) else (),
            takes_s=dice.pick((0.05, 0.5, 2, 6)),
            finishes=dice.chance(0.7),
            makes=True,
        )
        return Kind(name=KIND, verbs=(verb,), is_written=is_written)

    def _pose(self) -> Section:
        """The pose of its bed, beside the targets that the robot has without it."""
        assert self._parts is not None
        if self._layout.robot(self._parts.robot).section["kind"] == "mobile":
            return {"node": NODE}
        dice = self._dice
        return {
            "deg": [round(dice.between(-34, -30), 2), round(dice.between(-60, 60), 2)],
            "mm": dice.pick((40, 80)),
        }


def _can_take(layout: Layout, parts: Parts) -> bool:
    robot = layout.robot(parts.robot)
    return robot.section["kind"] != TURNTABLE and not robot.is_shared


def _no_parameter(make: object) -> Param:
    raise AssertionError("what is made has fixed values")
