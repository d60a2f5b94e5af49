"""Waiting for the lead of a plant that another process leads, which a package brings.

The package registers a function like `take_over` under the entry point group `arboleda.standby`.
"""

from __future__ import annotations

from collections.abc import Callable

from arboleda.host.packages import entry_points
from arboleda.model.errors import StartError
from arboleda.model.packages import FLEET, MISSING
from arboleda.model.plant_model import PlantModel
from arboleda.model.recording import Recording
from arboleda.model.sentence import Phrase

from .build import App
from .options import Options

GROUP = "arboleda.standby"
STANDBY = Phrase("package.standby", "Standing by for a plant that another process leads")
ReadAgain = Callable[[], tuple[PlantModel, Recording | None]]  # the plant file, as it is now


def take_over(
    model: PlantModel, parts: set[str], options: Options, tell: Callable[[str], None], again: ReadAgain
) -> App:
    """Wait until nobody leads the plant, then lead it; StartError, KeyboardInterrupt.

    `again` reads it as `model` was read, for files that were changed meanwhile by what was put to work.
    """
    for each in entry_points(GROUP):
        app: App = each.load()(model, parts, options, tell, again)
        return app
    raise StartError(MISSING(what=STANDBY(), package=FLEET))
