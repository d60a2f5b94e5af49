"""`using` of recipes: steps that hold devices which their cell shares."""

from __future__ import annotations

from collections.abc import Sequence

from py_trees.behaviour import Behaviour

from arboleda.engine import Context, TakeDevices, framed, leave_devices, sequence, take_devices
from arboleda.model.sentence import Phrase

from .errors import RecipeError
from .holding import used

USING = Phrase("step.using", "with {devices}")


def using(context: Context, devices: frozenset[str], parts: Sequence[Behaviour]) -> Behaviour:
    """The steps, with these shared devices held meanwhile."""
    inside = [name for part in parts for name in used(part)]
    if missing := [name for name in inside if name not in devices]:
        those = ", ".join(sorted(devices))
        raise RecipeError(f"using({those}) tells {missing[0]} something; name it there, too")
    check_holds_none("another using", parts)
    within = (take_devices(context, devices), *parts, *leave_devices(context, devices))
    return framed(sequence(USING(devices=tuple(sorted(devices))), *within))


def check_holds_none(where: str, parts: Sequence[Behaviour]) -> None:
    """RecipeError where a part takes shared devices: a task would wait for them while it holds others."""
    if any(isinstance(node, TakeDevices) for part in parts for node in part.iterate()):
        raise RecipeError(f"using(...) stands in {where}; put it around that")


def check_at_once(parts: Sequence[Behaviour]) -> None:
    """RecipeError where two branches of a parallel take shared devices, each by its own `using`."""
    takes = [part for part in parts if any(isinstance(node, TakeDevices) for node in part.iterate())]
    if len(takes) > 1:
        raise RecipeError("two branches of a parallel have using(...); put one around the parallel")
