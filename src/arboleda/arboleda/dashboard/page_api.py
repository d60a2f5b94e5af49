"""The part of the plant that the page may read and ask; nothing else."""

from __future__ import annotations

from typing import Any, Protocol

from arboleda.web.plant_api import PlantApi

Layout = dict[str, Any]
"""Data of a plant that never changes while it runs: its cells, robots and recipes."""
Links = dict[str, Any]
Seen = tuple[float, dict[str, Any]]  # Unix time in seconds, and the snapshot that came then
WAITING = 200  # snapshots that wait for a page, or between two frames; past that the oldest are dropped


class PageApi(PlantApi, Protocol):
    """PlantApi with what only the page shows; all data is plain and never changed by the page."""

    def layout(self) -> Layout:
        """`views.view.layout`: what never changes, and whether this start is `recorded`."""

    def positions(self) -> dict[str, Any]:
        """`views.twin_view.positions` as of now, and `now` on the plant's clock."""

    def urdf(self, robot: str) -> str:
        """A robot's drawing; an ArboledaError says why there is none. Takes a while."""

    def links(self) -> Links:
        """The connections of the plant, and what goes on beside its tasks.

        `broker` is {address, connected} or None, `ros` is {notes} or None, `refused` {robot: {count, last}}.
        `standbys` are [{host, url}]; a url is "" where it leads there from no other host. `demo` is True
        while a demonstration gives tasks. `memory` is {typical_s, worst_s, is_slow}, of its commits. `faults`
        were provoked and go on: [{number, robot, kind, about, left_s}].
        """

    def past_acts(self) -> list[dict[str, Any]]:
        """The acts of operators before this start, oldest first: {at (unix s), scope, sentence}."""
