"""Reports of robots as the plant takes them in, and what by them speaks against a command.

`published_joints_are_reported` finds by it a plant that does not take over where a robot is on its way.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from arboleda.drivers import Command, Home, Report
from arboleda.engine import Belief, State
from arboleda.model.plant_model import PlantModel
from arboleda.rig.moment import Moment

from .cells import KnownCell
from .commands import Commands
from .proofs import Proofs
from .robots import KnownRobot, Obstacle


class Heard:
    """Has each robot hear its reports; `anew`: those of this step that say something else than before, or the
    same for some time.
    """

    def __init__(
        self, model: PlantModel, robots: Mapping[str, KnownRobot], cells: Mapping[str, KnownCell]
    ) -> None:
        self.anew: list[Report] = []
        self._model = model
        self._robots = robots
        self._cells = cells
        self._booted: set[str] = set()  # robots that told of a boot in this step
        self._earlier: dict[str, list[KnownRobot]] = {}  # as they were before each report of this step

    def begin_step(self) -> None:
        self._booted.clear()
        self._earlier.clear()

    def hear(self, moment: Moment, commands: Commands, proofs: Proofs) -> None:
        """Take in reports; if somebody asked for something among them, a command may rest on any."""
        commanded = {each.robot for each in moment.sent if isinstance(each, Command)}
        for report in moment.reports:
            known = self._robots.get(report.robot)
            if known is None:
                continue
            if report.robot in commanded and (moment.requests or known.robot.home_at_start):
                self._earlier.setdefault(report.robot, []).append(known.as_it_is())
            if report.robot in proofs.by_robot:
                proofs.hear(report, known)
            if report.boot_id not in (None, known.boot):
                self._booted.add(report.robot)
            if known.hear(report):
                self.anew.append(report)
                if report.rejected is not None:
                    commands.hear(report, known)

    def obstacles(self, known: KnownRobot, now: float, epoch: int) -> frozenset[Obstacle]:
        """The obstacles that spoke against a command to this robot all through this step, from `now` on."""
        found = known.obstacles(now, epoch)
        for earlier in self._earlier.get(known.robot.name, ()):
            earlier.stop = known.stop
            found &= earlier.obstacles(now, epoch)
        cells = self._model.cells_of[known.robot.name]
        stopped = all(self._cells[cell.name].stopped for cell in cells)
        return found | {Obstacle.STOPPED} if stopped else found

    def follow(self, commands: Commands, beliefs: Mapping[str, Belief]) -> None:
        """Take over what the ends of commands tell of a robot: it knows its place again once its homing
        routine has ended. Of refused halted commands the plant's word counts: those of a robot at rest mean
        nothing.
        """
        for sent, _ in commands.moved:
            known = self._robots[sent.robot]
            if isinstance(sent.command, Home) and sent.state is State.DONE:
                known.displaced = False
            if sent.rejected and sent.state is State.CANCELLED:
                known.barred = beliefs[sent.robot].barred

    def put_right(self, robots: Iterable[str], beliefs: Mapping[str, Belief]) -> None:
        """Take over that operators put robots right; a boot reported in this step may be later."""
        for name in robots:
            self._robots[name].displaced = name in self._booted and beliefs[name].displaced
