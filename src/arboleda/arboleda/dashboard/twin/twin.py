"""The twin of one plant: its scene, and its drawing at each moment. Pure."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from arboleda.geometry.bodies import Body

from .parts import Part
from .scene import scene
from .track import Track

Row = dict[str, Any]


class Twin:
    """Twin: draws a plant from its `places`, as `views.places` has them, and each robot's body."""

    def __init__(self, places: Row, drawings: Mapping[str, Body]) -> None:
        self.scene = scene(places, drawings)
        self._places = places
        self._drawings = drawings
        self._followed = TwinTracker(places, drawings)

    def frame(self, positions: Row, now: float) -> Row:
        """The drawing at `now` of the plant, by robot/<name>, part/<cell>, books/<cell>, zone/<name>."""
        return self._followed.frame(positions, now)

    def still(self, positions: Row) -> Row:
        """The drawing of one moment alone, whatever was drawn before; `positions` have their `now`."""
        return TwinTracker(self._places, self._drawings).frame(positions, positions["now"])


class TwinTracker:
    """Robots and parts from frame to frame, as far as their drawing depends on the frames before."""

    def __init__(self, places: Row, drawings: Mapping[str, Body]) -> None:
        robots = {robot["name"]: robot for robot in places["robots"]}
        self._arms = {cell["name"]: cell["arm"] for cell in places["cells"]}
        spots: dict[str, Row] = {cell: {} for cell in self._arms}
        for spot in places["parts"]:
            if spot["robot"] == self._arms.get(spot["cell"]):
                spots[spot["cell"]][spot["place"]] = spot["q"]
        self._tracks = {name: Track(robot) for name, robot in robots.items()}
        self._parts = {
            cell: Part(robots[arm], drawings[arm], spots[cell]) for cell, arm in self._arms.items()
        }

    def frame(self, positions: Row, now: float) -> Row:
        rows = {row["name"]: row for row in positions["robots"]}
        robots = {name: track.see(rows[name], now) for name, track in self._tracks.items()}
        found: Row = {f"robot/{name}": drawn for name, drawn in robots.items()}
        for cell, part in self._parts.items():
            counts, arm = positions["books"][cell]["places"], robots[self._arms[cell]]
            found[f"part/{cell}"] = part.see(positions["parts"][cell], arm, counts)
        found |= {f"books/{cell}": books for cell, books in positions["books"].items()}
        for zone in positions["zones"]:
            found[f"zone/{zone['zone']}"] = {key: zone[key] for key in ("state", "robot", "waiting")}
        return found
