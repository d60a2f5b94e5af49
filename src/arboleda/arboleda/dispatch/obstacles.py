"""Obstacles to commands: why a robot takes no command now, or not this command."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.model.commands import Command, Home, Motion, Query, Switch, Work
from arboleda.model.facts import shown
from arboleda.model.messages import Failure, Reason
from arboleda.model.plant_model import Evidence
from arboleda.model.sentence import Phrase

from .belief import STOPPED, Belief
from .effectors import Effectors
from .latches import Latches
from .ledger import Entry, Ledger, State

Make = Callable[..., Command]  # called with id=<the new command's id>
Barrier = Callable[[Command], "Failure | None"]  # why a command must not leave its cell
BUSY_MOVING = (
    Phrase("robot.open_motion", "{robot} has an open motion command"),
    Phrase("robot.had_open_motion", "{robot} had an open motion command"),
)
BUSY_WORKING = (
    Phrase("robot.open_work", "{robot} has not ended its last work"),
    Phrase("robot.had_open_work", "{robot} had not ended its last work"),
)
BUSY_SWITCHING = (
    Phrase("robot.open_switch", "{robot} has not ended switching {fact}"),
    Phrase("robot.had_open_switch", "{robot} had not ended switching {fact}"),
)
NEEDS = Phrase("robot.needs", "{robot} needs {fact} to be {value}, and says {told}")
NEEDED = Phrase("robot.needed", "{robot} needs {fact} to be {value}, and said {told}")
NEEDS_UNSAID = Phrase("robot.needs_unsaid", "{robot} needs {fact} to be {value}, and does not say it")
MAY_LET_GO = Phrase(
    "tool.may_let_go", "{robot} stays where it is: {tool} was told to let go and may still do it"
)


def unbarred(command: Command) -> None:
    """The barrier that lets every command leave."""


class Obstacles:
    """Obstacles to commands, by beliefs about robots, their stops and their open commands.

    `was` asks for words that stay true.
    """

    def __init__(
        self, beliefs: dict[str, Belief], latches: Latches, ledger: Ledger, effectors: Effectors
    ) -> None:
        self._beliefs = beliefs
        self._latches = latches
        self._ledger = ledger
        self._effectors = effectors

    def of(self, robot: str, *, was: bool = False) -> Failure | None:
        """The reason why a robot takes no command now."""
        if robot in self._latches.stopped:
            return STOPPED.failure(robot, was=was)
        return self._beliefs[robot].obstacle(was=was)

    def objection(self, make: Make, *, barrier: Barrier = unbarred) -> Failure | None:
        """The reason for which a command would not leave now."""
        command = make(id="")
        return self.to(command, by_hand=False) or barrier(command)

    def to_opening(self, robot: str) -> Failure | None:
        """The reason why an effector cannot be opened by hand now."""
        return self.to(self._beliefs[robot].robot.let_go(id=""), by_hand=True)

    def to(self, command: Command, *, by_hand: bool, was: bool = False) -> Failure | None:
        """The reason why a command cannot leave; by hand an effector opens even while its arm is stopped."""
        robot = command.robot
        is_query = isinstance(command, Query)
        if (busy := self._query_of(robot) if is_query else self._ledger.work_of(robot)) is not None:
            now, before = BUSY_MOVING if isinstance(busy.command, Motion) else BUSY_WORKING
            return Failure(reason=Reason.REJECTED, sentence=(before if was else now)(robot=robot))
        switches = isinstance(command, Switch) and not by_hand
        if switches and (fact := self._open_switch_of(command)) is not None:
            now, before = BUSY_SWITCHING
            sentence = (before if was else now)(robot=robot, fact=fact)
            return Failure(reason=Reason.REJECTED, sentence=sentence)
        if is_query:
            return self._beliefs[robot].unreachable(was=was) or self._unmet(command, was=was)
        if isinstance(command, Work) and (tool := self._effectors.opening_tool(robot)) is not None:
            return Failure(reason=Reason.REJECTED, sentence=MAY_LET_GO(robot=robot, tool=tool))
        obstacle = self.of(robot, was=was)
        led_out = isinstance(command, Home) and self._beliefs[robot].is_led_out_by_homing
        if led_out and robot not in self._latches.stopped:
            obstacle = None
        moving = obstacle is not None and obstacle.reason is Reason.REJECTED
        if moving and self._shows_its_own_end(command) and not self._breaks_its_work(command):
            obstacle = None  # "moving" may be older than the end of its last move, which was proven
        elif by_hand and obstacle:
            obstacle = self._beliefs[robot].obstacle_besides_stop(was=was)
        return obstacle or (self._unmet(command, was=was) if command.needs else None)

    def may_come_to_rest(self, robot: str) -> bool:
        """True where a robot may take a command soon: its last move may be over, or was cancelled."""
        abandoned = any(entry.is_abandoned for entry in self._ledger.of_robot(robot))
        return abandoned or self._may_be_the_end_of_its_last_move(robot)

    def _query_of(self, robot: str) -> Entry | None:
        """The open query of a robot, which alone keeps it from another query."""
        queries = (e for e in self._ledger.of_robot(robot) if isinstance(e.command, Query))
        return next(queries, None)

    def _open_switch_of(self, command: Command) -> str | None:
        """The fact of a switch that another open command switches, too."""
        entries = self._ledger.of_robot(command.robot)
        if not entries:
            return None
        facts = {name for name, _ in command.sets}
        others = (e.command for e in entries if isinstance(e.command, Switch))
        return next((name for other in others for name, _ in other.sets if name in facts), None)

    def _unmet(self, command: Command, *, was: bool) -> Failure | None:
        """The failure for a need of a command that its robot does not report as met."""
        belief = self._beliefs[command.robot]
        for name, value in command.needs:
            reported = belief.fact(name)
            if reported != value:
                robot, wanted = command.robot, shown(value)
                if reported is None:
                    sentence = NEEDS_UNSAID(robot=robot, fact=name, value=wanted)
                else:
                    needs = NEEDED if was else NEEDS
                    sentence = needs(robot=robot, fact=name, value=wanted, told=shown(reported))
                return Failure(reason=Reason.PRECONDITION, sentence=sentence)
        return None

    def _may_be_the_end_of_its_last_move(self, robot: str) -> bool:
        """True where "moving" may be a late report of a move that the position has already proved done.

        At `state` only that code proves a move, so a "moving" after its end would prove the next command.
        """
        belief = self._beliefs[robot]
        return belief.moves and belief.robot.evidence is Evidence.JOINTS

    def _shows_its_own_end(self, command: Command) -> bool:
        """True where the end of an earlier move cannot be taken for the end of this command."""
        evidence_level = self._beliefs[command.robot].robot.evidence
        if evidence_level is Evidence.JOINTS:
            return isinstance(command, Switch)
        return evidence_level is Evidence.IDS

    def _breaks_its_work(self, command: Command) -> bool:
        """True for a switch that would end a need of its robot's last work, while that is not proven."""
        work, sets = self._ledger.last_work.get(command.robot), dict(command.sets)
        if work is None or work.state is State.DONE:
            return False
        return any(sets.get(name, value) != value for name, value in work.command.needs)
