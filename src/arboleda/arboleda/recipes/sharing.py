"""Which part of a recipe holds the devices that its cell shares with others."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from py_trees import composites
from py_trees.behaviour import Behaviour

from arboleda.model.sentence import Phrase
from arboleda.trees import steps
from arboleda.trees.context import Context
from arboleda.trees.leaves import TakeDevices

from .errors import RecipeError

WORK = Phrase("step.work", "work")
USING = Phrase("step.using", "with {devices}")


def using(context: Context, devices: frozenset[str], parts: Sequence[Behaviour]) -> Behaviour:
    """The steps, with these shared devices held meanwhile."""
    inside = [name for part in parts for name in _used(part)]
    if missing := [name for name in inside if name not in devices]:
        those = ", ".join(sorted(devices))
        raise RecipeError(f"using({those}) tells {missing[0]} something; name it there, too")
    check_holds_none("another using", parts)
    return steps.sequence(USING(devices=tuple(sorted(devices))), *steps.with_devices(context, devices, parts))


def check_holds_none(where: str, parts: Sequence[Behaviour]) -> None:
    """RecipeError where one of the parts takes shared devices: who holds something would wait for them."""
    if any(isinstance(node, TakeDevices) for part in parts for node in part.iterate()):
        raise RecipeError(f"using(...) stands in {where}; put it around that")


def check_at_once(parts: Sequence[Behaviour]) -> None:
    """RecipeError where two branches of a parallel take shared devices for themselves."""
    takes = [part for part in parts if any(isinstance(node, TakeDevices) for node in part.iterate())]
    if len(takes) > 1:
        raise RecipeError("two branches of a parallel have using(...); put one around the parallel")


def held(context: Context, step: Behaviour) -> Behaviour:
    """The step with what it uses of shared devices held from before the first use until after the last.

    A recipe with a `using` of its own says itself when.
    """
    outside = frozenset(_used(step)) if context.cell.shared else frozenset[str]()
    if not outside:
        return step
    if any(isinstance(node, TakeDevices) for node in step.iterate()):
        told = f"{min(outside)} is told something outside of using(...)"
        raise RecipeError(f"{told}; where a recipe has one, all that cells share is used in one")
    around = _innermost(step)
    if around is None:
        return steps.framed(steps.sequence(WORK(), *steps.with_devices(context, outside, [step])))
    uses = [index for index, child in enumerate(around.children) if any(_used(child))]
    first, last = uses[0], uses[-1]
    parts = steps.with_devices(context, outside, around.children[first : last + 1])
    before, after = around.children[:first], around.children[last + 1 :]
    around.remove_all_children()
    around.add_children([*before, *parts, *after])
    return step


def _innermost(step: Behaviour) -> composites.Sequence | None:
    """The innermost `work` that has all the uses in it; None where the step is none."""
    found = None
    while isinstance(step, composites.Sequence) and steps.is_frame(step):
        found = step
        using = [child for child in step.children if any(_used(child))]
        if len(using) > 1:
            break
        (step,) = using
    return found


def _used(step: Behaviour) -> Iterator[str]:
    """The shared devices that a part of a recipe tells something, but for those that it takes itself."""
    if any(isinstance(child, TakeDevices) for child in step.children):
        return
    if device := getattr(step, "uses", None):
        yield device
    for child in step.children:
        yield from _used(child)
