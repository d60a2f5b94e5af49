"""Witness of the truth at the virtual boards of a rig, kept for tests."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from arboleda.engine.inspection import tasks_of
from arboleda.model import text
from arboleda.recipes import Order
from arboleda.testing import Rig
from arboleda.wire.transport import Publication
from arboleda_proofs.simulator.truth.arm import ArmTruth
from arboleda_proofs.simulator.truth.grips import Switching
from arboleda_proofs.simulator.truth.truth import Truth

STARTS_MOTION = ("juntas", "camino", "referencia")


class Witness:
    """Looks at the truth of a rig after every step, and keeps what must never happen.

    `false_successes`: tasks called done that were not; `illegal`: effectors switched where no part can be;
    `collisions`: two arms in one zone; `part`: arm -> where its part is.
    """

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.truth = Truth(rig)
        self.switches: list[Switching] = []  # but those by which an effector lost its power
        self.false_successes: list[str] = []
        self.collisions: list[str] = []
        self.part: dict[str, str] = {}
        self._of_task: dict[str, list[Switching]] = {}  # by arm, since its cell began its task
        rig.watchers.append(self.look)

    @property
    def illegal(self) -> list[Switching]:
        """Effectors that were switched where they must not be."""
        return [each for each in self.switches if not each.is_at_place]

    def look(self) -> None:
        """Take in what happened in this step."""
        truth = self.truth
        truth.look()
        self.switches += [each for each in truth.grips.switched if not each.lost_power]
        for each in truth.grips.switched:
            self._of_task.setdefault(each.arm, []).append(each)
        for effector in truth.grips.effectors.values():
            if effector.arm in truth.changed:
                self._follow_part(effector.arm)
        for meeting in truth.zones.meetings:
            self.collisions.append(f"{' and '.join(meeting.arms)} in {meeting.zone} at {self.rig.now:.2f}")
        for cell, task, _ in truth.done_tasks:
            order = text.parse(tasks_of(self.rig.plant)[task].order.text, self.rig.model)
            self.false_successes += [f"{order.text}: {why}" for why in self._missing(cell, order)]
        for cell, _ in truth.begun_tasks:
            self._of_task.update({robot.name: [] for robot in self.rig.model.cell(cell).robots})

    def _follow_part(self, arm: ArmTruth) -> None:
        if arm.holding == arm.was_holding:
            return
        put = [each for each in self.truth.grips.switched if each.arm == arm.robot.name]
        is_put = bool(put) and put[0].is_at_place and not (put[0].by_others or put[0].lost_power)
        where = "/".join(sorted(arm.stood)) if is_put and arm.stood else "floor"
        self.part[arm.robot.name] = "effector" if arm.holding else where

    def _missing(self, cell: str, order: Order) -> Iterator[str]:
        """The deeds that a task lacks which is called done."""
        model, places = self.rig.model.cell(cell), self.truth.places.cells[cell]
        arm = self.truth.grips.effectors.get(model.taker.robot.name)
        if arm is None:
            return
        switches = self._of_task.get(model.taker.robot.name, [])
        turns = [(each.on, each.is_at_place or each.taken_away) for each in switches]
        if not turns or turns != [(True, True), (False, True)] * (len(turns) // 2):
            told = ", ".join(f"{'on' if each.on else 'off'} at {each.where}" for each in switches)
            yield f"the effector was switched {told or 'not at all'}"
        for place, parts in model.recipe(order.recipe).end_of(order.values).items():
            if places.as_left.get(place) != parts:
                yield f"{place} has {places.as_left.get(place)} parts, not {parts}"
        for path in [model.paths[str(each)] for each in order.values.values() if each in model.paths]:
            home = model.taker.home
            if path.nodes[-1] not in places.came:
                yield f"the mobile never stood at node {path.nodes[-1]}"
            if not (arm.arm.taken_away or arm.arm.stands_at(home.q)):
                yield f"the arm does not stand at {home.name}"

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
