"""Stops on their way to the plant: they leave beside it where it is busy, and overtake older commands."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple, TypeGuard
from uuid import uuid4

from arboleda.adapters import clock
from arboleda.departures.leaving import OVERTAKEN, Unkept, ends_motion
from arboleda.departures.stop_lane import Blocked, Closed, Departed, Happened, Opened, Overrun, StopLane
from arboleda.model.commands import Command, Stop
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Notice, OperatorAnswer, OperatorRequest
from arboleda.model.plant_model import PlantModel

from ..loop import Loop


class CommandOvertaken(ArboledaError):
    """A command was not sent: a stop of its robot left before it."""

    def __init__(self, command: Command) -> None:
        super().__init__(OVERTAKEN(robot=command.robot))


class StopsAway(NamedTuple):
    """Mark among the messages of a step: the stops that these requests asked for have left."""

    request_ids: Sequence[str]


class ActsDone(NamedTuple):
    """Mark among the messages of a step: its stops have left, and with them these acts have happened."""

    answers: Sequence[OperatorAnswer]


class Stops:
    """Requests for stops that the plant has not stepped yet; `send` gets what leaves beside it, in a thread.

    Such a request overtakes a command that the plant made before it and that still waits to leave.
    """

    def __init__(self, model: PlantModel, epoch: int, send: Callable[[Stop | Unkept], None]) -> None:
        self._lane = StopLane(model, epoch=epoch)
        self.loop: Loop[Any, Any] = Loop("stops", self._lane, send, on_send_error=_leave_it_to_the_plant)
        self.ahead: dict[str, frozenset[str]] = {}  # by id, their robots; never changed, only replaced
        self._replacing = threading.Lock()

    def open(self, request: OperatorRequest) -> OperatorRequest:
        """Take a request before the plant does; the plant gets the returned one. From any thread."""
        request_id = request.request or uuid4().hex
        request = replace(request, request=request_id)
        self.loop.post(Opened(request=request))
        with self._replacing:
            self.ahead = {**self.ahead, request_id: self._lane.reached(request)}
        return request

    def expect(self, request: OperatorRequest) -> None:
        """Have who asked for a hold answered in time, even if the plant cannot do it yet."""
        self.loop.post(Opened(request=request))

    def leave_beside(self, request: OperatorRequest) -> None:
        """Have stops leave at once for a request that the plant has, unless a step has taken it already."""
        if request.request in self.ahead:
            self.loop.post(Blocked(request_id=request.request))

    def stepped(self, messages: Sequence[Any]) -> StopsAway | None:
        """Take in the messages of a step: what it has made after a stop is not overtaken by it."""
        ids = [each.request for each in messages if isinstance(each, OperatorAnswer)]
        mine = [id for id in ids if id in self.ahead]
        with self._replacing:
            self.ahead = {id: robots for id, robots in self.ahead.items() if id not in mine}
        return StopsAway(mine) if mine else None

    def departed(self, stops: StopsAway) -> None:
        """Note that the plant itself has sent these stops."""
        for request_id in stops.request_ids:
            self.loop.post(Departed(request_id=request_id))

    def happened(self, acts: ActsDone) -> None:
        """Have who asked for these acts answered in time, even if they cannot be kept."""
        for answer in acts.answers:
            self.loop.post(Happened(at=clock.seconds(), answer=answer))

    def closed(self, answer: OperatorAnswer) -> None:
        """Note that a request has its answer."""
        self.loop.post(Closed(request_id=answer.request or ""))

    def refuse_overtaken(self, message: Command | Notice) -> None:
        """Raise CommandOvertaken for a command that must not leave any more."""
        if self._overtake(message):
            raise CommandOvertaken(message)

    def stop_again(self, message: Command | Notice) -> None:
        """Stop a robot once more if it was sent this command while a stop was leaving beside the plant."""
        if self._overtake(message):
            self.loop.post(Overrun(robot=message.robot))

    def _overtake(self, message: Command | Notice) -> TypeGuard[Command]:
        if not isinstance(message, Command) or ends_motion(message):
            return False
        return any(message.robot in robots for robots in self.ahead.values())


def _leave_it_to_the_plant(_message: object, _error: Exception) -> None:
    """Leave a stop to the plant, which sends its own as soon as it can, and reports the outcome."""
