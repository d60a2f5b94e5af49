"""Themes of drawn plants: what a plant has to have at a seed, so that few seeds come by much.

What is rare in a cell (work on a part: 2 plants of 100) would hardly be met in 25 plants.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import count

from arboleda_drawn import devices
from arboleda_drawn.devices import DrawnDevices, Form
from arboleda_drawn.devices.layout import Section
from arboleda_drawn.devices.steps import Recover, Repeat, walk
from arboleda_drawn.plants import of_devices
from arboleda_proofs.campaigns.plants import Plant

MANY_SEEDS = 10_000  # between a plant that does not fit and the next that is drawn instead
Theme = Callable[[DrawnDevices], bool]


def _cell(drawn: DrawnDevices) -> Section:
    return next(iter(drawn.section["cells"].values()))  # type: ignore[no-any-return]


def _zones(drawn: DrawnDevices) -> list[Section]:
    return list(drawn.section.get("zones", {}).values())


def _work_on_parts(drawn: DrawnDevices) -> bool:
    """A machine works on a part that a robot brings."""
    declared = str(drawn.section.get("kinds", {}))
    return "works_on" in declared or any(verb.works_on for kind in drawn.kinds or () for verb in kind.verbs)


def _seen_by_facts(drawn: DrawnDevices) -> bool:
    """A device of a drawn kind proves its work by what it shows alone."""
    devices_of = _cell(drawn)["devices"].values()
    kinds = {each.get("kind", "") for each in devices_of if each.get("evidence") in ("facts", "joints")}
    return any(kind.startswith("kind_") for kind in kinds)


def _shared_holder(drawn: DrawnDevices) -> bool:
    """Two cells share a device that can hold a part."""
    kinds = {each.get("kind", "") for each in drawn.section.get("shared", {}).values()}
    declared = drawn.section.get("kinds", {})
    clamps = {name for name, kind in declared.items() if "clamp" in kind["verbs"]}
    return not kinds.isdisjoint(clamps | {"gripper", "effector"})


def _held_zone(drawn: DrawnDevices) -> bool:
    """A device holds a zone while it does something."""
    return any("held_while" in zone for zone in _zones(drawn))


def _door(drawn: DrawnDevices) -> bool:
    """A robot reaches into a zone with the door of a machine."""
    return any("poses" in zone and "free_while" in zone for zone in _zones(drawn))


def _nest(drawn: DrawnDevices) -> bool:
    """Parts go over a place with room for one."""
    return any(not each or "of" in each for each in _cell(drawn).get("places", {}).values())


def _roads(drawn: DrawnDevices) -> bool:
    """A mobile robot drives where zones are, or over paths."""
    mobile = any(each.get("kind") == "mobile" for each in _cell(drawn)["devices"].values())
    return mobile and ("paths" in _cell(drawn) or any("poses" in zone for zone in _zones(drawn)))


def _rescues(drawn: DrawnDevices) -> bool:
    """A recipe has a rescue and a loop, in a cell that goes on where it was after a restart."""
    steps = [each for recipe in drawn.recipes for each in walk(recipe.step)]
    loops = any(isinstance(each, Repeat) for each in steps) and any(
        isinstance(each, Recover) for each in steps
    )
    return loops and _cell(drawn).get("on_restart") == "go_on"


THEMES: tuple[Theme, ...] = (
    _work_on_parts,
    _seen_by_facts,
    _shared_holder,
    _held_zone,
    _door,
    _nest,
    _roads,
    _rescues,
)


def plants_of(form: Form) -> Callable[[int], Plant]:
    """Plants with cells of devices whose recipes have this form, each with the theme of its seed."""

    def of(seed: int) -> Plant:
        theme = THEMES[seed % len(THEMES)]

        def fits(drawn: DrawnDevices | None) -> bool:
            return drawn is not None and drawn.form is form and theme(drawn)

        seeds = (seed + MANY_SEEDS * number for number in count())
        fitting = (each for each in seeds if fits(devices.draw(each)))
        return next(plant for plant in map(of_devices, fitting) if fits(plant.drawn))

    return of
