"""What a fault is: plain data, and a kind that knows whom it befalls, how it begins and how it ends."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.model.plant_model import PlantModel

from ..chance import Dice
from ..world import World

End = Callable[[], None]


@dataclass(frozen=True, kw_only=True)
class Fault:
    """Something that goes wrong `at` s after the run began, for `seconds` (0: an instant).

    `kind` is a name in KINDS, `target` what it befalls, `amount` how much of it, `word` which of several;
    `seed` is for the chances it takes itself.
    """

    kind: str
    at: float
    seconds: float = 0.0
    target: str = ""
    amount: float = 0.0
    word: str = ""
    seed: int = 0


Begin = Callable[[World, Fault], End | None]
Targets = Callable[[PlantModel], Sequence[str]]
Words = Callable[[PlantModel, str], Sequence[str]]
Range = tuple[float, float]
NONE: Range = (0.0, 0.0)


def no_words(model: PlantModel, target: str) -> Sequence[str]:
    return ("",)


@dataclass(frozen=True, kw_only=True)
class Kind:
    """One kind of fault: `begin` brings it about and returns how it ends, None where it is an instant.

    `targets` are whom it can befall in a plant (nobody: it cannot happen there), `words` what it can be then;
    a word that stands there more often is drawn more often. `seconds` and `amount` are from where to where
    they are drawn; `weight` is how often the kind is drawn beside others, 0: never.
    """

    name: str
    sentence: str
    begin: Begin
    targets: Targets
    words: Words = no_words
    seconds: Range = NONE
    amount: Range = NONE
    weight: float = 1.0

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
        """What such a fault cannot be in this plant, and what is allowed; None where it is right."""
        targets = self.targets(model)
        if fault.target not in targets:
            return f"{self.name} cannot befall {fault.target!r}; allowed: {_listed(targets)}"
        words = self.words(model, fault.target)
        if fault.word not in words:
            return f"{self.name} of {fault.target!r} knows no {fault.word!r}; allowed: {_listed(words)}"
        if min(fault.at, fault.seconds) < 0:
            return f"{self.name}: at and seconds are 0 or more"
        return None


def kind(
    *,
    targets: Targets,
    words: Words = no_words,
    seconds: Range = NONE,
    amount: Range = NONE,
    weight: float = 1.0,
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
        )

    return make


def words(*allowed: str) -> Words:
    """The same words whatever the plant and the target."""
    return lambda model, target: allowed


def _drawn(dice: Dice, span: Range) -> float:
    """From where to where, in thousandths; short and small as often as long and big where 0 is not in it."""
    low, high = span
    if low == high:
        return low
    drawn = low * (high / low) ** dice.random() if low > 0 else dice.between(low, high)
    return round(drawn, 3)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(repr(name) for name in dict.fromkeys(names))
