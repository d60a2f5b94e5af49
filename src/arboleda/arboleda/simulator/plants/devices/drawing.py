"""Drawing of a whole plant with cells of devices from a seed: its cells, what they share, its recipes."""

from __future__ import annotations

from copy import deepcopy

from ...chance import Dice
from ..timing import draw_timing
from .cells import CELL, CellDrawer
from .drawn import DrawnDevices, Form, can_be_xml
from .layout import Section
from .recipes import RecipeDrawer
from .trials import Trials

SECOND = 0.35  # how often a second cell is like the first one
AS_XML = 0.4
RECIPES = (2, 3, 4, 5)  # of a plant
IN_PYTHON = 0.35  # how often kinds are written in Python
BESIDE_DEG = 7.0  # half of what targets are apart
AT_ONCE = {"times": 10, "backoff_s": 0}  # the most tries that a file may ask for, without a pause


def draw(seed: int, attempt: int = 0) -> DrawnDevices:
    """The plant of a seed; `arboleda check` may refuse it, and another `attempt` draws another one."""
    dice = Dice(seed, "plant of devices", attempt)
    alike = dice.chance(SECOND)
    are_written = Dice(seed, "kinds in Python", attempt).chance(IN_PYTHON)
    spare = Dice(seed, "spare verbs", attempt)
    drawer = CellDrawer(dice, spare, alike=alike, are_written=are_written)
    layout = drawer.draw()
    section: Section = {"name": f"drawn_{seed}"}
    if dice.chance(0.3):
        section["mqtt_version"] = dice.pick(("3.1.1", "5"))
    timing = _timing(dice)
    if timing:
        section["timing"] = timing
    written = tuple(kind for kind in drawer.kinds.values() if kind.is_written)
    declared = {name: kind.section for name, kind in drawer.kinds.items() if not kind.is_written}
    if declared:
        section["kinds"] = declared
    if drawer.shared:
        section["shared"] = drawer.shared
    section["cells"] = {CELL: drawer.section}
    if alike:
        section["cells"][f"{CELL}_2"] = _other(drawer.section)
    if drawer.zones:
        section["zones"] = _zones(drawer.zones, alike=alike)
    _be_odd(Dice(seed, "odd plants of devices", attempt), section)
    as_xml = dice.chance(AS_XML)
    trials = Trials(Dice(seed, "trials", attempt), layout, as_xml=as_xml)
    recipes = RecipeDrawer(dice, layout, trials, as_xml=as_xml)
    drawn = tuple(recipes.draw(number) for number in range(1, 1 + dice.pick(RECIPES)))
    form = Form.XML if as_xml and all(map(can_be_xml, drawn)) else Form.PYTHON
    return DrawnDevices(
        section=section,
        recipes=drawn,
        form=form,
        kinds=written if are_written else None,
        spelling=seed,
    )


def _be_odd(dice: Dice, section: Section) -> None:
    """Now and then, have cells try again at once, and carts among zones tell nodes without the command."""
    tries_at_once, by_joints = dice.chance(0.15), "zones" in section and dice.chance(0.5)
    for cell in section["cells"].values():
        if tries_at_once:
            cell["retry"] = dict(AT_ONCE)
        for device in cell["devices"].values() if by_joints else ():
            if device.get("kind") == "mobile":
                device["evidence"] = "joints"


def _timing(dice: Dice) -> Section:
    if dice.chance(0.4):
        return {"dwell_s": dice.pick((0, 0, 0.01))}
    return draw_timing(dice) if dice.chance(0.5) else {}


def _other(cell: Section) -> Section:
    """The second cell: the same roles, other devices but for those that both have."""
    made = deepcopy(cell)
    for role, device in made["devices"].items():
        if "shared" not in device:
            device["name"] = f"{role}_b"
            if "mqtt" in device:
                device["mqtt"] = f"{device['mqtt']}_b"
            if device["kind"] == "arm":
                x, y = device["base"]["origin_m"]
                device["base"]["origin_m"] = [x, y + 6]
            if device["kind"] == "mobile":
                x, y = device["grid"]["origin_m"]
                device["grid"]["origin_m"] = [x, y + 6]
    for name, target in made.get("targets", {}).items():
        for pose in target.values() if name != "home" else ():
            _beside(pose)
    for group in made.get("groups", {}).values():
        for corners in group["corners"].values() if isinstance(group, dict) else ():
            for pose in corners:
                _beside(pose)
    return made


def _beside(pose: Section) -> None:
    """Move a pose of an arm, as two cells that share one have no place in common."""
    if "deg" in pose:
        pose["deg"][0] = round(pose["deg"][0] + BESIDE_DEG, 2)


def _zones(zones: Section, *, alike: bool) -> Section:
    """The zones of the first cell; one without a door is of both cells."""
    made = deepcopy(zones)
    for name, zone in list(made.items()):
        if not alike:
            continue
        if "free_while" not in zone:
            zone["poses"] += [pose.replace(f"{CELL} ", f"{CELL}_2 ", 1) for pose in zone["poses"]]
            continue
        other = deepcopy(zone)
        other["free_while"] = {f"{role}_b": facts for role, facts in zone["free_while"].items()}
        if "poses" in zone:
            other["poses"] = [pose.replace(f"{CELL} ", f"{CELL}_2 ", 1) for pose in zone["poses"]]
        if "held_while" in zone:
            other["held_while"] = {f"{role}_b": verbs for role, verbs in zone["held_while"].items()}
        made[f"{name}_b"] = other
    return made
