"""State that the parts of a plant share."""

from __future__ import annotations

from dataclasses import dataclass, field

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.zones import Zones
from arboleda.trees.cell_time import Clock

from .cell import CellRun
from .intake import Intake
from .news import News


@dataclass(kw_only=True, eq=False)
class PlantState:
    """State of a plant; `clock` is the plant, whose time `Plant.step` alone moves.

    `dispatcher` has what is believed of devices, the open commands, and what the step sends. `news` has what
    the rest of the step has to look at. `cells` are by name, in the order of the plant file.
    """

    clock: Clock
    dispatcher: Dispatcher
    zones: Zones
    intake: Intake
    news: News
    cells: dict[str, CellRun] = field(default_factory=dict)
