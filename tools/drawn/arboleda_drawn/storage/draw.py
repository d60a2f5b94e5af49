"""Drawing of a whole plant file from a seed: one to four cells, what they share, their zones and times."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from arboleda.kinds.joints import Joint
from arboleda_proofs.simulator.chance import Dice

from .cells import DrawnCell, draw_cell
from .mobile_paths import draw_paths
from .poses import Section, draw_rack, may_have_rack
from .timing import draw_timing, hasten
from .zones import draw_zones

CELLS = (1, 1, 1, 1, 1, 2, 2, 2, 3, 4)  # how many; many are simulated slower and find little more
# by section and key: settings without a draw here, most of them of cells of devices
NOT_DRAWN = (
    ("", "uses"),
    ("", "kinds"),
    ("", "shared"),
    ("", "history_days"),
    ("", "groot2"),
    ("", "extensions"),
    ("", "opcua_view"),
    ("", "store"),
    ("", "assistants"),
    ("", "assistant_limits"),
    ("cells", "on_restart"),  # a plant that crashes here starts without the tasks that it had
    ("cells", "teach"),  # people who teach are asked for apart (`rates: {teach: 3}`)
    ("cells", "on_absence"),  # people of the simulator get a held cell going
    ("zones", "free_while"),
    ("zones", "held_while"),
    ("arm", "driver"),  # virtual boards play their devices
    ("mobile", "driver"),
)
SHARED = 0.25  # how often cells share a section at the top of the file


def draw(
    seed: int, attempt: int = 0, *, arms: Mapping[str, Sequence[Joint]], mobiles: Mapping[str, float]
) -> Section:
    """The content of a plant file; `arms` are the joints and `mobiles` the speeds in m/s of the models.

    It has the form of a plant file, but `arboleda check` may refuse it for values that do not fit together;
    another `attempt` draws another one. The same seed and attempt give the same file.
    """
    dice = Dice(seed, "plant", attempt)
    cells = [
        draw_cell(Dice(seed, "plant", attempt, "cell", number), number, arms=arms, mobiles=mobiles)
        for number in range(1, dice.pick(CELLS) + 1)
    ]
    file: Section = {"name": f"drawn_{seed}"}
    if dice.chance(0.3):
        file["mqtt_version"] = dice.pick(("3.1.1", "5", 5))
    if Dice(seed, "plant", attempt, "foreign").chance(0.3):
        file["foreign_commands"] = "refuse"  # with "obey" strangers of the simulator would rightly command
    if dice.chance(0.7):
        file["timing"] = draw_timing(dice)
    shared = _share(dice, cells)
    file |= shared
    for cell in cells:
        cell.draw_pickups(Dice(seed, "plant", attempt, "pickups", cell.name))
    file["cells"] = {cell.name: cell.section for cell in cells}
    if zones := draw_zones(dice, cells, shared):
        file["zones"] = zones
    hasten(Dice(seed, "plant", attempt, "haste"), file)
    return file


def _share(dice: Dice, cells: Sequence[DrawnCell]) -> Section:
    """Put sections at the top of the file, for cells that then have none of their own."""
    shared: Section = {}
    if dice.chance(SHARED):
        shared["paths"] = draw_paths(dice)
        for cell in _some(dice, cells):
            del cell.section["paths"]
    if dice.chance(SHARED):
        kind = dice.pick(cells).arm
        alike = [cell for cell in cells if cell.arm.model == kind.model]
        if may_have_rack(kind.axes):
            shared["stations"], count = draw_rack(dice, kind.around_zero())
            for cell in _some(dice, alike):
                cell.take_stations(count)
    if dice.chance(SHARED):
        shared["palletizing"] = dice.pick(
            ({"pick": "pickup", "place": "station 0"}, {"pick": "station 0", "place": "pickup"})
        )
        for cell in _some(dice, cells):
            cell.section.pop("palletizing", None)
    return shared


def _some(dice: Dice, cells: Sequence[DrawnCell]) -> list[DrawnCell]:
    """Some of them, at least one."""
    first = dice.pick(cells)
    return [cell for cell in cells if cell is first or dice.chance(0.5)]
