"""Drawing of a whole plant with cells of devices from a seed: its cells, what they share, its recipes."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass

from arboleda_proofs.simulator.chance import Dice

from ..storage.timing import draw_timing
from .asked_places import AskedPlaces
from .cells import CELL, CellDrawer
from .drawn import DrawnDevices, Form, can_be_xml
from .late_work import LateWork
from .layout import Section
from .printers import Printer
from .recipes import Beside, RecipeDrawer
from .scales import Scale
from .shared_ends import SharedEnds
from .sorters import Sorter
from .trials import Trials

SECOND = 0.35  # how often a second cell is like the first one
SHARED_HAND = 0.12  # how often cells share an arm whose hand moves their parts
THIRD = 0.4  # how often there is a third one beside these
AS_XML = 0.4
RECIPES = (2, 3, 4, 5)  # of a plant
IN_PYTHON = 0.35  # how often kinds are written in Python
AT_ONCE = {"times": 10, "backoff_s": 0}  # the most tries that a file may ask for, without a pause
APART_DEG = 14.0  # targets of the first cell, between which those of the others lie
LETTERS = "bc"  # for the names of the devices of the second and of the third cell


def draw(seed: int, attempt: int = 0) -> DrawnDevices:
    """The plant of a seed; `arboleda check` may refuse it, and another `attempt` draws another one."""
    dice = Dice(seed, "plant of devices", attempt)
    has_shared_hand = Dice(seed, "shared hand", attempt).chance(SHARED_HAND)
    alike = dice.chance(SECOND) or has_shared_hand
    are_written = Dice(seed, "kinds in Python", attempt).chance(IN_PYTHON)
    spare = Dice(seed, "spare verbs", attempt)
    drawer = CellDrawer(dice, spare, alike=alike, has_shared_hand=has_shared_hand, are_written=are_written)
    layout = drawer.draw()
    printer = Printer(Dice(seed, "printer", attempt), layout, are_written=are_written)
    printer.join(drawer.section)
    scale = Scale(Dice(seed, "numbers", attempt), are_written=are_written)
    scale.join(drawer.section)
    sorter = Sorter(Dice(seed, "sorting", attempt), are_written=are_written)
    sorter.join(drawer.section)
    section: Section = {"name": f"drawn_{seed}"}
    if dice.chance(0.3):
        section["mqtt_version"] = dice.pick(("3.1.1", "5"))
    timing = _timing(dice)
    if timing:
        section["timing"] = timing
    kinds = [
        *drawer.kinds.values(),
        *(each.kind for each in (printer, scale, sorter) if each.kind is not None),
    ]
    written = tuple(kind for kind in kinds if kind.is_written)
    declared = {kind.name: kind.section for kind in kinds if not kind.is_written}
    _say_needs(Dice(seed, "said needs", attempt), declared)
    if declared:
        section["kinds"] = declared
    if drawer.shared:
        section["shared"] = drawer.shared
    others = _others(Dice(seed, "third cell", attempt)) if alike else []
    section["cells"] = {CELL: drawer.section} | {each.name: each.like(drawer.section) for each in others}
    if drawer.zones:
        section["zones"] = _zones(drawer.zones, others)
    _be_odd(Dice(seed, "odd plants of devices", attempt), section)
    as_xml = dice.chance(AS_XML)
    asked = Dice(seed, "asked places", attempt)
    beside = Beside(
        trials=Trials(Dice(seed, "trials", attempt), layout, as_xml=as_xml),
        late=LateWork(Dice(seed, "late work", attempt), layout),
        places=None if layout.parts is None else AskedPlaces(asked, layout, layout.parts),
        ends=SharedEnds(Dice(seed, "ends", attempt), layout),
        printer=printer,
        scale=scale,
        sorter=sorter,
    )
    recipes = RecipeDrawer(dice, layout, beside, as_xml=as_xml)
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
    """Now and then, have cells try again at once, carts among zones tell nodes without the command, and arms
    stand on one base.
    """
    tries_at_once, by_joints = dice.chance(0.15), "zones" in section and dice.chance(0.5)
    on_one_base = dice.chance(0.75)
    for cell in section["cells"].values():
        if tries_at_once:
            cell["retry"] = dict(AT_ONCE)
        for device in cell["devices"].values() if by_joints else ():
            if device.get("kind") == "mobile":
                device["evidence"] = "joints"
        for device in cell["devices"].values() if on_one_base else ():
            if device.get("kind") == "arm":
                device["base"] = {"origin_m": [0.0, 0]}


def _say_needs(dice: Dice, kinds: Section) -> None:
    """Have some of the verbs that need nothing say so."""
    for verb in (verb for kind in kinds.values() for verb in kind["verbs"].values()):
        if "needs" not in verb and dice.chance(0.5):
            verb["needs"] = {}


def _timing(dice: Dice) -> Section:
    if dice.chance(0.4):
        return {"dwell_s": dice.pick((0, 0, 0.01))}
    return draw_timing(dice) if dice.chance(0.5) else {}


@dataclass(frozen=True, kw_only=True)
class OtherCell:
    """Cell like the first one: the same roles, other devices but for those that cells share.

    `number` counts from 1. Cells that share an arm have no place in common: its targets here lie `beside_deg`
    beside those there.
    """

    number: int
    beside_deg: float

    @property
    def name(self) -> str:
        return f"{CELL}_{self.number + 1}"

    @property
    def end(self) -> str:
        """The end of the names of its devices, and of its zones."""
        return f"_{LETTERS[self.number - 1]}"

    def like(self, cell: Section) -> Section:
        """The cell, made of the first one."""
        made = deepcopy(cell)
        for role, device in made["devices"].items():
            if "shared" not in device:
                self._rename(role, device)
        for name, target in made.get("targets", {}).items():
            for pose in target.values() if name != "home" else ():
                self._move(pose)
        for group in made.get("groups", {}).values():
            for corners in group["corners"].values() if isinstance(group, dict) else ():
                for pose in corners:
                    self._move(pose)
        return made

    def poses(self, zone: Section) -> list[str]:
        """The poses of a zone of the first cell, as this one has them."""
        return [pose.replace(f"{CELL} ", f"{self.name} ", 1) for pose in zone["poses"]]

    def _rename(self, role: str, device: Section) -> None:
        device["name"] = f"{role}{self.end}"
        if "mqtt" in device:
            device["mqtt"] = f"{device['mqtt']}{self.end}"
        place = {"arm": "base", "mobile": "grid"}.get(device["kind"])
        if place is not None:
            x, y = device[place]["origin_m"]
            device[place]["origin_m"] = [x, y + 6 * self.number]

    def _move(self, pose: Section) -> None:
        if "deg" in pose:
            pose["deg"][0] = round(pose["deg"][0] + self.beside_deg, 2)


def _others(dice: Dice) -> list[OtherCell]:
    """A second cell, and now and then a third one."""
    count = 1 + dice.chance(THIRD)
    return [OtherCell(number=n, beside_deg=n * APART_DEG / (count + 1)) for n in range(1, count + 1)]


def _zones(zones: Section, others: Sequence[OtherCell]) -> Section:
    """The zones of the first cell; one without a door is of all cells."""
    made = deepcopy(zones)
    for name, zone in zones.items():
        for cell in others:
            if "free_while" not in zone:
                made[name]["poses"] += cell.poses(zone)
            else:
                made[f"{name}{cell.end}"] = _zone(zone, cell)
    return made


def _zone(zone: Section, cell: OtherCell) -> Section:
    """A zone with a door, of another cell."""
    made = deepcopy(zone)
    if "poses" in zone:
        made["poses"] = cell.poses(zone)
    for key in ("free_while", "held_while"):
        if key in zone:
            made[key] = {f"{role}{cell.end}": words for role, words in zone[key].items()}
    return made
