"""Witness of the truth at the virtual boards of a rig, kept for tests."""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.simulator.storage.deeds import Switch
from arboleda.simulator.truth.truth import Truth
from arboleda.wire.transport import Publication

from .rig import Rig

STARTS_MOTION = ("juntas", "camino", "referencia")


class Witness:
    """Looks at the truth of a rig after every step, and keeps what must never happen.

    `false_successes`: tasks called done that were not; `illegal`: effectors switched off a legal pose;
    `collisions`: two arms in one zone; `part`: arm -> where its part is.
    """

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.truth = Truth(rig)
        self.switches: list[Switch] = []  # but those by which an effector lost its power
        self.false_successes: list[str] = []
        self.collisions: list[str] = []
        self.part: dict[str, str] = {}
        rig.watchers.append(self.look)

    @property
    def illegal(self) -> list[Switch]:
        """Effectors that were switched where they must not be."""
        return [each for each in self.switches if not each.legal]

    def look(self) -> None:
        """Take in what happened in this step."""
        truth = self.truth
        truth.look()
        switches = [cell.switch for cell in truth.storage.cells.values()]
        self.switches += [each for each in switches if each is not None and not each.lost_power]
        self.part.update({passage.arm: passage.place for passage in truth.storage.parts.passages})
        for meeting in truth.zones.meetings:
            self.collisions.append(f"{' and '.join(meeting.arms)} in {meeting.zone} at {self.rig.now:.2f}")
        for ended in truth.storage.ended:
            if ended.missing is not None:
                self.false_successes.append(f"{ended.text}: {ended.missing}")

    def motions_since(self, mark: int, robots: Iterable[str]) -> list[Publication]:
        """Goals since `mark` that can have started something at these robots' boards: motions, effector on.

        `mark` is a former length of `rig.to_boards`.
        """
        boards = {self.rig.model.robots[robot].mqtt for robot in robots}
        reached = [each for _, each in self.rig.to_boards[mark:] if each.topic.split("/")[0] in boards]
        return [each for each in reached if _starts_something(each)]


def _starts_something(publication: Publication) -> bool:
    channel = publication.topic.split("/")[1]
    return channel in STARTS_MOTION or (channel == "efector" and b'"efector":1' in publication.payload)
