"""Homing, at the start or for an operator: robots run a routine, or a person puts them at their reference."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from arboleda.dispatch.belief import ONLY_DRAWN, stands_while_cleared
from arboleda.dispatch.ledger import Entry
from arboleda.model.commands import Home
from arboleda.model.messages import OperatorRequest
from arboleda.model.plant_model import Evidence, is_homed_by_word
from arboleda.model.sentence import Phrase, Sentence

from ..cell import CellRun
from ..plant_state import PlantState
from ..readiness import STILL_DOING
from .cell_by_cell import AT_REST, Doing, at_rest
from .scopes import Scopes, VerbRefusal

WITH_OTHER = Phrase("refusal.with_other", "{device}, which cells share, is with {cell} now")
MAY_CROSS = Phrase(
    "refusal.may_cross",
    "{arm} may cross zone {zone}, which {holder} holds; home it once the zone is free",
)
SAYS_ITSELF = Phrase(
    "refusal.says_itself", "{robot} says itself whether it is homed; home {robot} runs its routine"
)
SAYS_UNHOMED = Phrase(
    "refusal.says_unhomed", "{robot} says that it is not homed; home {robot} runs its routine"
)
SAYS_UNHOMED_BY_HAND = Phrase(
    "refusal.says_unhomed_by_hand",
    "{robot} says that it is not homed; home {robot} at its own controls first",
)
ONLY_BY_HAND = Phrase(
    "refusal.home_only_by_hand",
    "{robot} finds no reference by itself; put it at its zero and say: home {robot} --by-hand",
)
NO_HOMING = Phrase("refusal.no_homing", "{robot} has no homing")
CANNOT_REPORT = Phrase(
    "refusal.cannot_report",
    "{robot} cannot report a homing; put it at its reference and say: home {robot} --by-hand",
)
HOMED_MEANWHILE = Phrase("cell.homed_meanwhile", "{arm} was homed meanwhile")


class Homing:
    """Homing of robots; none sets out for its reference while another robot is where it may come by."""

    def __init__(self, state: PlantState, scopes: Scopes, doing: Doing) -> None:
        self._state = state
        self._scopes = scopes
        self._doing = doing
        reached = [robot for cell in scopes.cells.values() for robot in cell.cell.reached]
        self._reached = {robot.name for robot in reached}
        self._homing = {robot.name for robot in reached if robot.homes}

    def plan(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Plan the homing of a scope, without robots that have none; one of those alone is refused."""
        robots, by_hand = self._scopes.robots(scope), request.by_hand
        if scope in self._scopes.cells and self._scopes.cells[scope].cell.shared:
            robots = self._here(scope, robots)
        robots = robots & self._homing or robots
        for name in sorted(robots):
            obstacle = self._not_homeable(name, by_hand=by_hand)
            if obstacle:
                raise VerbRefusal(obstacle)
        if not by_hand and (occupied := self.not_free(robots)):
            raise VerbRefusal(occupied)
        return partial(self._home, robots, by_hand=by_hand)

    def home(self, name: str) -> Entry:
        """Have a robot run its homing routine; no other robot gets into its zones meanwhile.

        One that has none is told that it stands at its zero, and does not move.
        """
        cell = self._scopes.in_charge(name)
        if not stands_while_cleared(self._state.dispatcher.beliefs[name]):
            _uproot(cell, name)
        users = [run for run in self._scopes.of_robots(frozenset([name])) if name in run.cell.zone_users]
        for run in (each for each in users if each.state in AT_REST):
            run.context.zones.forsake()
        if name in cell.cell.shared:
            cell.context.devices.claim(name)
        for run in users:
            run.context.zones.claim(name)
        return self._state.dispatcher.home(name, cell.cell.name, self._state.clock.now)

    def not_free(self, robots: frozenset[str]) -> Sentence | None:
        """The reason why robots may not home: from where they stand they may cross any zone."""
        taken: dict[str, str] = {}
        for cell in self._scopes.of_robots(robots):
            for name, space in cell.cell.workspaces.items():
                for zone in sorted(space.zones) if name in robots else ():
                    for_task = cell.state in AT_REST and cell.context.zones.is_for_task(zone)
                    holder_now = None if for_task else self._state.zones.holder(zone)
                    holder = holder_now or taken.setdefault(zone, name)
                    if holder != name:
                        return MAY_CROSS(arm=name, zone=zone, holder=holder)
        return None

    def _here(self, scope: str, robots: frozenset[str]) -> frozenset[str]:
        """The robots that are homed with a cell: not the shared robots that another cell holds."""
        shared, holder = self._scopes.cells[scope].cell.shared, self._state.zones.holder
        here = frozenset(name for name in robots if name not in shared or holder(name) in (None, scope))
        if self._homing.isdisjoint(here) and (others := sorted(self._homing & robots)):
            raise VerbRefusal(WITH_OTHER(device=others[0], cell=holder(others[0]) or ""))
        return here

    def _home(self, robots: frozenset[str], *, by_hand: bool) -> None:
        for name in sorted(robots):
            if by_hand and not is_homed_by_word(self._state.dispatcher.beliefs[name].robot):
                run = self._scopes.in_charge(name)
                space = run.cell.workspaces.get(name)
                self._state.dispatcher.declare_homed(name, space.home.q if space is not None else None)
                _uproot(run, name)
            else:
                self._doing.sent.append(self.home(name))

    def _not_homeable(self, name: str, *, by_hand: bool) -> Sentence | None:
        cell = self._scopes.alone.get(name) or self._scopes.in_charge(name)
        belief = self._state.dispatcher.beliefs[name]
        if refusal := at_rest(cell, frozenset()):
            return refusal
        if cell.manual.teaching is not None and not by_hand:
            return cell.manual.teaching.sentence
        if name in cell.cell.shared and (stopped := cell.context.devices.not_reset(name)) is not None:
            return stopped.sentence
        if name not in self._reached:
            return ONLY_DRAWN(robot=name)
        if not belief.robot.homes:
            return NO_HOMING(robot=name)
        if work := self._state.dispatcher.ledger.work_of(name):
            return STILL_DOING(robot=name, doing=work.doing)
        robot, has_routine = belief.robot, belief.robot.evidence is Evidence.IDS
        if is_homed_by_word(robot):
            return self._objection(name) if by_hand else ONLY_BY_HAND(robot=name)
        if by_hand and robot.says_homed:
            return SAYS_ITSELF(robot=name)
        if belief.says_unhomed and (by_hand or not has_routine):
            return SAYS_UNHOMED(robot=name) if has_routine else SAYS_UNHOMED_BY_HAND(robot=name)
        if by_hand:
            return None
        if not has_routine:
            return CANNOT_REPORT(robot=name)
        return self._objection(name)

    def _objection(self, name: str) -> Sentence | None:
        """The reason why a robot would not take the command to home."""
        obstacle = self._state.dispatcher.obstacles.objection(partial(Home, robot=name))
        return obstacle.sentence if obstacle else None


def _uproot(run: CellRun, robot: str) -> None:
    """Note that a robot with poses is homed, so that it is not where the cell's held task left it."""
    if robot in run.cell.workspaces and run.context.devices.has(robot):
        run.lose(HOMED_MEANWHILE(arm=robot))


class HomingAtStart:
    """Homing of robots whose plant file wants it at the start; `robots` are those that wait for it.

    The robots of a cell that holds a task of an earlier start stay where they are.
    """

    def __init__(self, state: PlantState, scopes: Scopes, homing: Homing) -> None:
        held = (run for run in scopes.cells.values() if run.task is not None)
        staying = {robot.name for run in held for robot in run.cell.robots}
        self.robots = {
            name for name, robot in state.dispatcher.model.robots.items() if robot.home_at_start
        } - staying
        self._state = state
        self._scopes = scopes
        self._homing = homing

    def look(self, robot: str) -> None:
        """Home a robot that was heard, if its cell lets it."""
        belief = self._state.dispatcher.beliefs[robot]
        if not belief.answered or belief.homed is None:
            return
        run = self._scopes.in_charge(robot)
        if run.state not in AT_REST or run.manual.teaching is not None:
            return
        if belief.unhomed and self._homing.not_free(frozenset([robot])):
            return
        self.robots.discard(robot)
        if belief.unhomed:
            self._homing.home(robot)
