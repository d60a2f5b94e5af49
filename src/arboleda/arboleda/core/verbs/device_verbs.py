"""Verbs of devices on an operator's word: a device does one of its own, as opening a door."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from arboleda.dispatch.obstacles import Make
from arboleda.model.commands import Query, Switch
from arboleda.model.messages import OperatorRequest, Reason
from arboleda.model.outside import quoted
from arboleda.model.plant_model import Robot
from arboleda.model.sentence import OWN, Phrase, Sentence

from ..cell import CellRun
from ..plant_state import PlantState
from ..readiness import STILL_DOING
from ..teaching import ZONE_OF_OTHER
from .cell_by_cell import Doing, at_rest
from .scopes import NO_SCOPE, Scopes, VerbRefusal

DOING = Phrase("doing.own_verb", "doing '{work}' on the operator's word")
NO_SUCH_WORK = Phrase("refusal.no_such_work", "{device} does not do {work}; it does {known}")
NO_WORK = Phrase("refusal.no_work", "{device} does nothing by itself")


def works(robot: Robot) -> Iterator[tuple[str, Make]]:
    """The words and makers of what an operator may have a device do; what holds a part is for `release`."""
    for words, make in robot.calls.items():
        command = make(id="")
        holds = isinstance(command, Switch) and command.grips is not None
        if not holds and not isinstance(command, Query):
            yield words, make


class DeviceVerbs:
    """Verbs of devices; none leads its device into a zone that a robot holds."""

    def __init__(self, state: PlantState, scopes: Scopes, doing: Doing) -> None:
        self._state = state
        self._scopes = scopes
        self._doing = doing

    def plan(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Plan one verb of one device, in the words of `works`."""
        robot = self._state.dispatcher.model.robots.get(scope)
        if robot is None:
            raise VerbRefusal(NO_SCOPE(scope=quoted(scope), known=(*self._state.dispatcher.beliefs,)))
        work = " ".join(str(request.argument("work") or "").lower().split())
        known = dict(works(robot))
        make = next((make for words, make in known.items() if words.lower() == work), None)
        if make is None and not known:
            raise VerbRefusal(NO_WORK(device=scope))
        if make is None:
            raise VerbRefusal(NO_SUCH_WORK(device=scope, work=quoted(work), known=(*known,)))
        cell = self._scopes.in_charge(scope)
        if (refusal := self._objection(cell, scope, make)) is not None:
            raise VerbRefusal(refusal)
        return partial(self._do, cell, scope, make, work)

    def _objection(self, cell: CellRun, device: str, make: Make) -> Sentence | None:
        if (refusal := at_rest(cell, frozenset())) is not None:
            return refusal
        if cell.manual.teaching is not None:
            return cell.manual.teaching.sentence
        if (stop := cell.context.devices.not_reset(device)) is not None:
            return stop.sentence
        if (entry := cell.context.commands.first_of(device)) is not None:
            return STILL_DOING(robot=device, doing=entry.doing)
        zones = cell.context.zones
        for zone, holder in zones.awaited(device, zones.needs.of(make(id=""))).items():
            return ZONE_OF_OTHER(robot=device, zone=zone, holder=holder)
        failure = cell.context.commands.objection(make)
        is_taken_with_it = failure is not None and failure.reason is Reason.ZONE_UNAVAILABLE
        return None if failure is None or is_taken_with_it else failure.sentence

    def _do(self, cell: CellRun, device: str, make: Make, work: str) -> None:
        if device in cell.cell.shared:
            cell.context.devices.claim(device)
        cell.context.zones.enter(make(id=""))
        doing = DOING(work=OWN(text=work))
        self._doing.sent.append(cell.context.commands.send(make, doing))
