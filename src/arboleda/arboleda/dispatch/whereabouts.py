"""Whereabouts of robots: the poses at which they surely stand, and the goals that they have reached."""

from __future__ import annotations

from arboleda.model.commands import Command, Motion, Position
from arboleda.model.messages import Fact, MotionState, Report
from arboleda.model.plant_model import Pose, Workspace

from .belief import Belief
from .evidence import Before, came_back_at_zero, strayed
from .fact_memory import DISPLACED, FactMemory, Memory
from .ledger import Ledger
from .underway import UnderWay


class Whereabouts:
    """Whereabouts of robots; `reached` has the goal of a robot's last motion, once that motion is done."""

    def __init__(
        self,
        beliefs: dict[str, Belief],
        facts: Memory,
        memory: FactMemory,
        ledger: Ledger,
        under_way: UnderWay,
    ) -> None:
        self.reached: dict[str, Position] = {}
        self._set_out: set[str] = set()  # robots whose last motion is not done
        self._beliefs = beliefs
        self._memory = memory
        self._ledger = ledger
        self._under_way = under_way
        for name in facts.get(Fact.DISPLACED, {}).keys() & beliefs.keys():
            beliefs[name].displaced = True

    def place(self, workspace: Workspace) -> Pose | None:
        """The zone-free pose at, or above, which its robot surely stands; None where nothing proves that.

        A robot with an open command, or whose place may be older than its last stop, proves nothing: it may
        be on its way into a zone.
        """
        robot = workspace.robot
        belief = self._beliefs[robot.name]
        given = robot.name in self._under_way.ids or self._ledger.work_of(robot.name) is not None
        restless = belief.state is MotionState.MOVING or given
        if not belief.online or belief.unhomed or restless:
            return None
        here = belief.position if belief.supervised else self.reached.get(robot.name)
        if here is None or (belief.supervised and not belief.stillness.is_sure):
            return None
        return next((pose for spot, pose in workspace.free_spots if robot.motion.stands_at(here, spot)), None)

    def set_out(self, robot: str) -> None:
        """Note that a robot was given a motion."""
        self.reached.pop(robot, None)
        self._set_out.add(robot)

    def arrive(self, robot: str, place: Position) -> None:
        """Note that the last motion of a robot is done."""
        self.reached[robot] = place
        self._set_out.discard(robot)

    def hear_after_silence(self, before: Before, belief: Belief, report: Report) -> None:
        """Displace a robot that may have booted unseen, by where it was before its silence and is now."""
        belief.is_unplaced = False
        goal = self.reached.get(report.robot)
        if goal is not None and strayed(belief, report, goal):
            self.displace(belief, displaced=True)
        stood = before.position if goal is None else goal
        if came_back_at_zero(before, belief, report, None if report.robot in self._set_out else stood):
            self.displace(belief, displaced=True)
            belief.came_back_at_zero = True

    def displace(self, belief: Belief, *, displaced: bool) -> None:
        """Remember that the position of a robot has lost its meaning, or has one again."""
        belief.displaced, belief.came_back_at_zero = displaced, False
        self._memory.remember(Fact.DISPLACED, belief.robot.name, DISPLACED if displaced else None)

    def put_at_reference(self, robot: str, home: Position | None = None) -> None:
        """Take a robot that cannot report it for put at its reference by a person.

        One without a reference is put at its `home`. That person has seen if it is in fault, too.
        """
        belief = self._beliefs[robot]
        belief.end_hearsay()
        self.displace(belief, displaced=False)
        self.reached.pop(robot, None)
        self._set_out.discard(robot)
        stands = belief.state in (None, MotionState.STOPPED)
        place = home if belief.robot.reference is None else belief.robot.reference
        if place is not None and not belief.supervised and stands:
            self.reached[robot] = place

    def moves_again(self, robot: str) -> None:
        """Note that a robot without a position moves, or cannot: it has left where its last move ended."""
        self.reached.pop(robot, None)
        for entry in self._ledger.of_robot(robot):
            if entry.is_work and entry.settles_at is not None:
                entry.settles_at = None
                self._ledger.plan(entry)

    def is_there(self, command: Command) -> bool:
        """True for a motion to where the robot's last motion, which is done, has ended."""
        return isinstance(command, Motion) and command.way == (self.reached.get(command.robot),)
