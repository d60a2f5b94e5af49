"""Smaller drawn plants with cells of devices: one recipe, step or key less."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from dataclasses import fields, replace
from typing import Any

from .drawn import DrawnDevices
from .sorters import ROLE as SORTER
from .steps import Choose, Param, Recipe, Run, Step, Tell, Value, Work, children, walk

KEEP = frozenset({"name", "kind", "model", "effect", "home", "cells", "devices", "evidence_"})


def smaller(drawn: DrawnDevices) -> Iterator[DrawnDevices]:
    """Plants with one part less each, the large parts first."""
    yield from _fewer_recipes(drawn)
    for number, recipe in enumerate(drawn.recipes):
        for step in _smaller_steps(recipe.step):
            by_answer = recipe.ends_by_answer if _leaves_the_sorter(recipe, step) else ()
            less = replace(recipe, step=step, ends=_ends_of(recipe, step), ends_by_answer=by_answer)
            made = _trimmed(less)
            yield replace(drawn, recipes=(*drawn.recipes[:number], made, *drawn.recipes[number + 1 :]))
        for end in range(len(recipe.ends)):
            made = replace(recipe, ends=(*recipe.ends[:end], *recipe.ends[end + 1 :]))
            yield replace(drawn, recipes=(*drawn.recipes[:number], made, *drawn.recipes[number + 1 :]))
    for place in sorted(_places(drawn.section), key=len):
        section = deepcopy(drawn.section)
        parent: Any = section
        for key in place[:-1]:
            parent = parent[key]
        del parent[place[-1]]
        yield replace(drawn, section=section)


def _fewer_recipes(drawn: DrawnDevices) -> Iterator[DrawnDevices]:
    for number, recipe in enumerate(drawn.recipes):
        rest = (*drawn.recipes[:number], *drawn.recipes[number + 1 :])
        used = {s.recipe for each in rest for s in walk(each.step) if isinstance(s, Run)}
        if rest and recipe.name not in used:
            yield replace(drawn, recipes=rest)


def _smaller_steps(step: Step) -> Iterator[Step]:
    """The step with one step less in it, or one of those in it in its place."""
    if isinstance(step, Work):
        for number in range(len(step.steps)):
            yield Work(steps=(*step.steps[:number], *step.steps[number + 1 :]))
    elif not isinstance(step, Choose):
        yield from children(step)
    yield from _with_smaller(step)


def _with_smaller(step: Step) -> Iterator[Step]:
    if isinstance(step, Choose):
        for number, (value, way) in enumerate(step.ways):
            for less in _smaller_steps(way):
                yield replace(step, ways=(*step.ways[:number], (value, less), *step.ways[number + 1 :]))
        return
    for each in fields(step):
        value = getattr(step, each.name)
        if isinstance(value, Step):
            yield from (_changed(step, each.name, less) for less in _smaller_steps(value))
        elif each.name in ("steps", "branches"):
            for number, inner in enumerate(value):
                for less in _smaller_steps(inner):
                    yield _changed(step, each.name, (*value[:number], less, *value[number + 1 :]))


def _changed(step: Step, name: str, value: object) -> Step:
    changes: dict[str, Any] = {name: value}
    changed: Step = replace(step, **changes)
    return changed


def _ends_of(recipe: Recipe, step: Step) -> tuple[tuple[str, Value], ...]:
    """The ends of a recipe that are those of a smaller step, too: of devices that it tells what it told."""
    told, now = _told(recipe.step), _told(step)
    return tuple(each for each in recipe.ends if told.get(role := each[0].partition(".")[0]) == now.get(role))


def _leaves_the_sorter(recipe: Recipe, step: Step) -> bool:
    """True if a smaller step of a recipe tells the sorter what the recipe told it."""
    return _told(recipe.step).get(SORTER) == _told(step).get(SORTER)


def _told(step: Step) -> dict[str, list[Tell]]:
    """The orders of a step to each device, one after the other."""
    found: dict[str, list[Tell]] = {}
    for each in walk(step):
        if isinstance(each, Tell):
            found.setdefault(each.role, []).append(each)
    return found


def _trimmed(recipe: Recipe) -> Recipe:
    """The recipe without parameters that nothing takes."""
    used: set[str] = set()
    for step in walk(recipe.step):
        given = [value for _, value in getattr(step, "values", ())] + [
            getattr(step, name, None) for name in ("target", "place")
        ]
        used |= {value.name for value in given if isinstance(value, Param)}
    return replace(recipe, parameters=tuple(each for each in recipe.parameters if each.name in used))


def _places(value: Any, place: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    if not isinstance(value, dict):
        return
    yield from ((*place, key) for key in value if key not in KEEP)
    for key in value:
        yield from _places(value[key], (*place, key))
