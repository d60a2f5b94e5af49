"""Positions at which parts are drawn; one that was put down stays until its cell has another."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from arboleda.geometry import kinematics
from arboleda.geometry.bodies import Body

Row = dict[str, Any]
NEAR = 0.02  # rad and m: a motor step or two


class Part:
    """Part: the part of one cell: {at: "arm" | "mobile" | "place", sure, frame}, or None if there is none.

    `frame` (16 numbers, row by row) is the tool's place over a part that was put down. Only a part that an
    effector holds for sure is `sure`.
    """

    def __init__(self, arm: Row, body: Body, places: dict[str, list[float]]) -> None:
        self._base = kinematics.floor(arm["at"])
        self._body = body
        self._places = places
        self._shown: Row | None = None

    def see(self, part: Row | None, arm: Row, counts: Mapping[str, int]) -> Row | None:
        """Follow the part; it is as in `views.twin_view.part`, `arm` as in its Track, `counts` the number of
        parts at each place.
        """
        if part is not None:
            self._shown = self._placed(part["q"]) if part["at"] == "pose" else {"sure": False, **part}
        elif self._shown is not None and self._shown["at"] == "arm" and self._at_one_of(counts, arm):
            self._shown = None
        elif self._shown is not None and self._shown["at"] != "place":
            here = arm["q"] or arm["estimate"]
            self._shown = self._placed(here) if self._shown["at"] == "arm" and here else None
        return self._shown

    def _at_one_of(self, counts: Mapping[str, int], arm: Row) -> bool:
        """True if the arm stands at a place with a part: that part is the one it has let go of."""
        here = arm["q"] or arm["estimate"]
        full = (q for place, q in self._places.items() if counts.get(place))
        return here is not None and any(math.dist(here, q) < NEAR for q in full)

    def _placed(self, q: list[float]) -> Row:
        frame = kinematics.flat(kinematics.tool(self._body, q, self._base))
        return {"at": "place", "sure": False, "frame": frame}
