"""Span of a recipe over which a cell holds a shared device: from the first step that uses it to the last."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Protocol, runtime_checkable

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.decorators import Decorator

from arboleda.engine import (
    Context,
    TakeDevices,
    TakeZones,
    framed,
    is_frame,
    leave_devices,
    sequence,
    take_devices,
)
from arboleda.model.sentence import Phrase

from .decorators import Again, Forgiven, Inverted
from .errors import RecipeError

Take = Callable[[], Behaviour]
WORK = Phrase("step.work", "work")


@runtime_checkable
class TakesLate(Protocol):
    """Node that inserts the taking of devices into its own tree."""

    def uses_first(self) -> bool:
        """True where no step comes before the first use of a shared device."""

    def take_late(self, take: Take) -> None:
        """Insert the step that `take` makes before the first use."""


def held(context: Context, step: Behaviour) -> Behaviour:
    """The step, with the shared devices that it uses held from before the first use until after the last.

    A recipe with `using` of its own must use all shared devices inside of it.
    """
    outside = context.cell.together(used(step)) if context.cell.shared else frozenset[str]()
    if not outside:
        return step
    if any(isinstance(node, TakeDevices) for node in step.iterate()):
        problem = f"{min(outside)} is told something outside of using(...)"
        raise RecipeError(f"{problem}; where a recipe has one, all that cells share is used in one")
    if _is_work(step):
        _hold_in(context, step)
        return step
    return framed(sequence(WORK(), *_hold(context, outside, [step])))


def _take_late(step: Behaviour, take: Take) -> bool:
    """Insert the taking of shared devices into a step, before the first of its parts that uses one.

    True if the devices are certainly taken once the step has succeeded. A part that cannot be divided, such
    as a visit with its zones, has them taken before it. A repeated part, or one of two that run at the same
    time, may find them taken already.
    """
    if isinstance(step, TakesLate):
        step.take_late(take)
        return True
    if _is_work(step):
        parts, certain = _late(step.children, take)
        _replace(step, parts)
        return certain
    if isinstance(step, Decorator):
        return _take_late(step.decorated, take) and not isinstance(step, Inverted)
    if isinstance(step, composites.Parallel):
        taken = [_take_late(child, take) for child in step.children if any(used(child))]
        return any(taken)
    branches = [_late([child], take) for child in step.children]
    _replace(step, [])  # a step has one parent
    _replace(step, [_one(parts) for parts, _ in branches])
    return all(certain for _, certain in branches)


@dataclass
class _Group:
    """Steps next to each other, from the first to the last use of the devices that they need together."""

    first: int
    last: int
    devices: frozenset[str]


def _hold_in(context: Context, work: Behaviour) -> None:
    """Hold the devices that the steps of a sequence use, each from its first use to its last."""
    children = list(work.children)
    for group in reversed(_groups(context, children)):
        parts = children[group.first : group.last + 1]
        if len(parts) == 1 and _is_work(parts[0]):
            _hold_in(context, parts[0])
        else:
            _replace(work, [])  # a step has one parent
            children[group.first : group.last + 1] = _hold(context, group.devices, parts)
    _replace(work, children)


def _hold(context: Context, devices: frozenset[str], parts: Sequence[Behaviour]) -> list[Behaviour]:
    """The steps, with the devices taken before the first use among them and given back after all of them."""
    late, _ = _late(parts, partial(take_devices, context, devices))
    return [*late, *leave_devices(context, devices)]


def _groups(context: Context, parts: Sequence[Behaviour]) -> list[_Group]:
    """Groups of parts that use shared devices; no two groups use one device.

    Only a person may be in several: between two questions, a person is free for other cells.
    """
    needed = [context.cell.together(used(part)) for part in parts]
    for index, part in enumerate(parts):
        if _may_stay_in_zones(part):
            needed[index] = needed[index].union(*needed[index:])
    people = {each.name for each in context.cell.robots if each.is_person}
    last = {device: index for index, devices in enumerate(needed) for device in devices - people}
    groups: list[_Group] = []
    for index, devices in enumerate(needed):
        end = max([index, *(last[device] for device in devices - people)])
        if groups and index <= groups[-1].last:
            groups[-1].last, groups[-1].devices = max(groups[-1].last, end), groups[-1].devices | devices
        elif devices:
            groups.append(_Group(first=index, last=end, devices=devices))
    return groups


def _late(parts: Sequence[Behaviour], take: Take) -> tuple[list[Behaviour], bool]:
    """The parts of a sequence with the taking of devices in or between them, and whether it is certain."""
    with_taking: list[Behaviour] = []
    certain = False
    for part in parts:
        if not certain and (any(used(part)) or _may_stay_in_zones(part)):
            if certain := _uses_first(part):
                with_taking.append(take())
            else:
                certain = _take_late(part, take)
        with_taking.append(part)
    return with_taking, certain


def _uses_first(step: Behaviour) -> bool:
    """True for a step before which the devices must be taken, as it uses them at once or is not divided."""
    if isinstance(step, TakesLate):
        return step.uses_first()
    if _may_stay_in_zones(step):
        return True
    if _is_work(step):
        return bool(step.children) and _uses_first(step.children[0])
    if isinstance(step, composites.Parallel) and _is_open(step):
        return any(map(_uses_first, step.children))
    return _uses_first(step.children[0]) if _is_open(step) else any(used(step))


def _may_stay_in_zones(step: Behaviour) -> bool:
    """True where work may go on while a robot is in a zone: it may not wait for a device there."""
    return any(_goes_on_after_failure(each) and _takes_zones(each) for each in step.iterate())


def _goes_on_after_failure(step: Behaviour) -> bool:
    if isinstance(step, Again):  # the next try may take another branch
        return any(isinstance(each, composites.Selector) and is_frame(each) for each in step.iterate())
    return isinstance(step, Forgiven | Inverted)


def _takes_zones(step: Behaviour) -> bool:
    return any(isinstance(each, TakeZones) for each in step.iterate())


def _is_work(step: Behaviour) -> bool:
    return isinstance(step, composites.Sequence) and is_frame(step)


def _is_open(step: Behaviour) -> bool:
    """True for a step between whose parts another step may be inserted."""
    several = composites.Sequence | composites.Selector | composites.Parallel | Decorator
    return isinstance(step, several) and is_frame(step)


def _one(parts: Sequence[Behaviour]) -> Behaviour:
    return parts[0] if len(parts) == 1 else framed(sequence(WORK(), *parts))


def _replace(step: Behaviour, parts: Collection[Behaviour]) -> None:
    assert isinstance(step, composites.Composite)
    step.remove_all_children()
    step.add_children(list(parts))


def used(step: Behaviour) -> Iterator[str]:
    """Names of the shared devices that a part of a recipe uses, without devices that it takes itself."""
    if any(isinstance(child, TakeDevices) for child in step.children):
        return
    if device := getattr(step, "uses", None):
        yield device
    for child in step.children:
        yield from used(child)
