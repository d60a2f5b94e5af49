"""Faults as plain data, and kinds of faults: each has its targets, its beginning and its end."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.model.plant_model import PlantModel
from arboleda.recipes import Sentence
from arboleda.rig.world import World

from ..chance import Dice
from .board_site import BoardSite

End = Callable[[], None]


@dataclass(frozen=True, kw_only=True)
class Fault:
    """Something that goes wrong `at` s after the run began, for `seconds` (0: an instant).

    `kind` is a name in KINDS, `target` the board, line or process that it befalls, `amount` its size, `word`
    the choice among several forms; `seed` is for what the fault draws itself.
    """

    kind: str
    at: float
    seconds: float = 0.0
    target: str = ""
    amount: float = 0.0
    word: str = ""
    seed: int = 0


Begin = Callable[[World, Fault], End | None]
BeginAtBoards = Callable[[BoardSite, Fault], End | None]
Targets = Callable[[PlantModel], Sequence[str]]
Words = Callable[[PlantModel, str], Sequence[str]]
Refusal = Callable[[World, Fault], "Sentence | None"]
Range = tuple[float, float]
NONE: Range = (0.0, 0.0)
UNHEARD = "unheard"
WORD = re.compile(r"[A-Za-z0-9_.-]{1,16}")  # that a board has for a reason


def no_words(model: PlantModel, target: str) -> Sequence[str]:
    return ("",)


def never_refused(world: World, fault: Fault) -> None:
    return None


@dataclass(frozen=True, kw_only=True)
class Kind:
    """One kind of fault: `begin` brings it about and returns the call that ends it, None for an instant.

    `targets` gives the possible targets in a plant (none: it cannot happen there), `words` the forms it can
    take then; a word that stands there more often is drawn more often. `seconds` and `amount` are the ranges
    from which these are drawn; `weight` is how often the kind is drawn beside others, 0: never.
    `alike` has one name for all words that the plant treats alike, `UNHEARD` for those that all who hear them
    refuse. `refusal` is the reason why the plant would do nothing of the fault now, where it would not.
    `takes_any_word`: a device says it, so a file may have another one than those that are drawn.
    """

    name: str
    sentence: str
    begin: Begin
    targets: Targets
    words: Words = no_words
    seconds: Range = NONE
    amount: Range = NONE
    weight: float = 1.0
    alike: Callable[[str], str] = str
    refusal: Refusal = never_refused
    takes_any_word: bool = False

    def draw(self, dice: Dice, model: PlantModel, target: str | None = None) -> Mapping[str, Any]:
        """The fields of one fault besides kind, at and seed; `target` is drawn too unless it is given."""
        target = dice.pick(self.targets(model)) if target is None else target
        return {
            "target": target,
            "word": dice.pick(self.words(model, target)),
            "seconds": _drawn(dice, self.seconds),
            "amount": _drawn(dice, self.amount),
        }

    def objection(self, fault: Fault, model: PlantModel) -> str | None:
        """The reason why such a fault cannot be in this plant, with what is allowed; None if it can."""
        targets = self.targets(model)
        if fault.target not in targets:
            return f"{self.name} cannot befall {fault.target!r}; allowed: {_listed(targets)}"
        words = self.words(model, fault.target)
        if fault.word not in words and not (self.takes_any_word and WORD.fullmatch(fault.word)):
            return f"{self.name} of {fault.target!r} knows no {fault.word!r}; allowed: {_listed(words)}"
        if min(fault.at, fault.seconds) < 0:
            return f"{self.name}: at and seconds are 0 or more"
        return None


@dataclass(frozen=True, kw_only=True)
class BoardKind(Kind):
    """Kind of fault that needs boards and their connections alone: those of a real start, too."""

    begin: BeginAtBoards


def kind(
    *,
    targets: Targets,
    words: Words = no_words,
    seconds: Range = NONE,
    amount: Range = NONE,
    weight: float = 1.0,
    alike: Callable[[str], str] = str,
) -> Callable[[Begin], Kind]:
    """Make a function `(world, fault)` a kind of fault: its name, and its docstring as the sentence."""

    def make(begin: Begin) -> Kind:
        return Kind(
            name=begin.__name__,
            sentence=(begin.__doc__ or "").strip(),
            begin=begin,
            targets=targets,
            words=words,
            seconds=seconds,
            amount=amount,
            weight=weight,
            alike=alike,
        )

    return make


def board_kind(
    *,
    targets: Targets,
    words: Words = no_words,
    seconds: Range = NONE,
    amount: Range = NONE,
    weight: float = 1.0,
    alike: Callable[[str], str] = str,
    takes_any_word: bool = False,
) -> Callable[[BeginAtBoards], BoardKind]:
    """Make a function `(boards, fault)` a kind of fault of boards, as `kind` does."""

    general = kind(targets=targets, words=words, seconds=seconds, amount=amount, weight=weight, alike=alike)

    def make(begin: BeginAtBoards) -> BoardKind:
        fields = vars(general(begin)) | {"begin": begin, "takes_any_word": takes_any_word}
        return BoardKind(**fields)

    return make


def words(*allowed: str) -> Words:
    """The same words for every plant and target."""
    return lambda model, target: allowed


def all_alike(word: str) -> str:
    return ""


def unheard(word: str) -> str:
    return UNHEARD


def _drawn(dice: Dice, span: Range) -> float:
    """A number from the range, in thousandths; in a range without 0 small and large ones are as likely."""
    low, high = span
    if low == high:
        return low
    drawn = low * (high / low) ** dice.random() if low > 0 else dice.between(low, high)
    return round(drawn, 3)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(repr(name) for name in dict.fromkeys(names))
