"""Time limits of commands: how long each may take, and when a command without proof counts as done."""

from __future__ import annotations

from arboleda.model.commands import Command, Motion, Switch, Work
from arboleda.model.plant_model import Evidence, PlantModel, Timing

from .belief import Belief
from .ledger import Entry
from .whereabouts import Whereabouts

HOMING_S = 30.0  # a slow search for the switch, and back off it


class TimeLimits:
    """Time limits of commands; `timings` by cell, as each cell takes another version once it rests."""

    def __init__(self, model: PlantModel, beliefs: dict[str, Belief], whereabouts: Whereabouts) -> None:
        self.timings = {cell.name: model.timing for cell in model.cells}
        self._beliefs = beliefs
        self._whereabouts = whereabouts

    def allowed_s(self, command: Command, timing: Timing) -> float:
        """The time (s) that a command may take: its own limit, else by its distance and `timeout_s`."""
        belief = self._beliefs[command.robot]
        robot = belief.robot
        if command.at_most_s is not None:
            return command.at_most_s
        if not isinstance(command, Work):
            return timing.effector_timeout_s
        here = belief.known_position
        positions = command.way if isinstance(command, Motion) else ()
        travel_s = robot.motion.travel_s(here, positions) / robot.pace if positions else HOMING_S
        return max(robot.timeout_s, travel_s * timing.deadline_factor + timing.deadline_floor_s)

    def settles_at(self, entry: Entry, now: float) -> float | None:
        """The time at which a command counts as done without a report; None where the robot has to report.

        A switch of which nothing is reported counts as done after the time that it takes. So does a move, by
        a robot without a position, to where its last move ended: such a robot may report nothing, and has
        `stop_timeout_s` to report that it moves.
        """
        command, timing = entry.command, self.timings[entry.cell]
        belief = self._beliefs[command.robot]
        evidence_level = belief.robot.evidence
        if evidence_level is Evidence.STATE and self._whereabouts.is_there(command):
            return min(now + timing.stop_timeout_s, entry.deadline)
        if not isinstance(command, Switch) or evidence_level is Evidence.IDS:
            return None
        has_facts = command.sets and all(belief.fact(name) is not None for name, _ in command.sets)
        if evidence_level is Evidence.JOINTS and has_facts:
            return None
        return now + timing.effector_settle_s + command.takes_s
