"""One cell of a drawn plant file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from arboleda.kinds.joints import Joint
from arboleda_proofs.simulator.chance import Dice

from .mobile_paths import draw_paths
from .poses import Poses, Section
from .robots import DrawnArm, draw_arm, draw_mobile

ZONE_WAITS_S = (0.5, 5.0, 30.0)
PICKUPS = 0.2  # how often exits have pick-ups of their own


@dataclass(kw_only=True)
class DrawnCell:
    """The cell's section, and what the rest of the file needs to know of it."""

    name: str
    arm: DrawnArm
    section: Section
    stations: int

    @property
    def poses(self) -> tuple[str, ...]:
        """Its poses, by the names that zones use."""
        pickups = (f"pickup {exit}" for exit in self.section.get("pickups", ()))
        return ("home", "pickup", *pickups, *(f"station {number}" for number in range(self.stations)))

    def place(self, shared: Section) -> str:
        """The pose at which its palletizing puts a part, with the sections that cells share."""
        own = self.section.get("palletizing") or shared.get("palletizing")
        return str(own["place"]) if own else self.poses[-1]

    def take_stations(self, count: int) -> None:
        """Use the shared stations in place of its own."""
        self.section.pop("stations")
        self.stations = count
        if "palletizing" in self.section:
            self.section["palletizing"] = {"pick": "pickup", "place": f"station {count - 1}"}

    def draw_pickups(self, dice: Dice) -> None:
        """Now and then, give some exits of its own paths a pick-up of their own."""
        exits = dict.fromkeys(code[1].upper() for code in self.section.get("paths", ()))
        if dice.chance(PICKUPS):
            poses = Poses(dice, self.arm.axes)
            drawn = {exit: poses.draw(approach=True) for exit in exits if dice.chance(0.7)}
            if drawn:
                self.section["pickups"] = drawn


def draw_cell(
    dice: Dice, number: int, *, arms: Mapping[str, Sequence[Joint]], mobiles: Mapping[str, float]
) -> DrawnCell:
    """The cell with this number."""
    arm = draw_arm(dice, f"arm_{number}", arms)
    poses = Poses(dice, arm.axes)
    section: Section = {
        "arm": arm.section,
        "mobile": draw_mobile(dice, f"mobile_{number}", mobiles),
        "home": poses.draw(approach=False),
        "pickup": poses.draw(approach=True),
        "paths": draw_paths(dice),
    }
    section["stations"], count = poses.stations()
    if dice.chance(0.5):
        section["palletizing"] = _palletizing(dice, count)
    return DrawnCell(name=f"cell_{number}", arm=arm, section=section | _habits(dice), stations=count)


def _palletizing(dice: Dice, stations: int) -> Section:
    poses = ["pickup", *(f"station {number}" for number in range(stations))]
    pick = dice.pick(poses)
    return {"pick": pick, "place": dice.pick([pose for pose in poses if pose != pick])}


def _habits(dice: Dice) -> Section:
    """The settings of the cell that do not depend on places."""
    section: Section = {}
    if dice.chance(0.4):
        section["queue_limit"] = dice.pick((1, 2, 100))
    if dice.chance(0.4):
        section["drive_to_start"] = dice.chance(0.3)
    if dice.chance(0.5):
        section["retry"] = {"times": dice.below(4), "backoff_s": dice.pick((0, 0.3, 1))}
    if dice.chance(0.4):
        section["piece_check"] = dice.chance(0.8)
    if dice.chance(0.4):
        section["zone_wait_s"] = dice.pick(ZONE_WAITS_S)
    return section
