"""Stop lane: a pure machine that lets stops leave while the plant is kept waiting, and answers requests.

The plant's thread may hang at a disk, a database or a log when somebody asks for a stop. The lane has a
thread of its own, and needs nothing but the plant's model. It also answers a request for another act that has
happened and that the plant does not keep in time, and for a hold that the plant does not do in time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from arboleda.engine import UNSENT
from arboleda.model.commands import Stop, StopMode
from arboleda.model.messages import OperatorAnswer, OperatorRequest
from arboleda.model.plant_model import PlantModel
from arboleda.model.verb_scopes import scope_of, scopes

from .leaving import STILL_WAITS, Unkept, done_unkept, stop_left, taken_up_later

ANSWERED_WITHIN_S = (
    0.8  # within it a stop is kept, or whoever asked hears that it is not; a service of ROS 2 waits 1 s
)


@dataclass(frozen=True, kw_only=True)
class Opened:
    """A request for a stop or for a hold has come, and is on its way to the plant."""

    request: OperatorRequest


@dataclass(frozen=True, kw_only=True)
class Blocked:
    """The plant's thread is busy with something older than the request of this id."""

    request_id: str


@dataclass(frozen=True, kw_only=True)
class Departed:
    """The plant itself has sent the stops of the request of this id."""

    request_id: str


@dataclass(frozen=True, kw_only=True)
class Happened:
    """The plant has done an act, which is to be kept before the request is answered."""

    at: float
    answer: OperatorAnswer


@dataclass(frozen=True, kw_only=True)
class Closed:
    """The request of this id is answered."""

    request_id: str


@dataclass(frozen=True, kw_only=True)
class Overrun:
    """A command has left for this robot although a stop had overtaken it."""

    robot: str


Event = Opened | Blocked | Departed | Happened | Closed | Overrun


@dataclass(kw_only=True)
class OpenAct:
    """A request that is not answered yet, with the answer for an act that is not kept at `due`.

    `has_left` is False for a stop of which no robot was told, and for an unknown scope: then none is true.
    """

    request: OperatorRequest | OperatorAnswer
    unkept: Unkept
    due: float
    has_left: bool = False


class StopLane:
    """Stops that leave beside the steps of the plant, under ids that no step gives.

    The number of such an id has ten digits, and a value that the plant has given already, so that no receiver
    takes the id for a foreign one.
    """

    def __init__(self, model: PlantModel, *, epoch: int) -> None:
        self._scopes = scopes(model)
        self._robots = [name for name, robot in model.robots.items() if robot.link not in UNSENT]
        self._epoch = epoch
        self._count = 0
        self._open: dict[str, OpenAct] = {}

    @property
    def next_deadline(self) -> float | None:
        """The time at which the next request for an act that is not kept is to be answered; None: never."""
        return min((each.due for each in self._open.values() if each.has_left), default=None)

    def reached(self, request: OperatorRequest | OperatorAnswer) -> frozenset[str]:
        """Names of the robots that a request for a stop is for; none where its scope is unknown."""
        return self._scopes.get(scope_of(request), frozenset())

    def step(self, now: float, events: Sequence[Event]) -> list[Stop | Unkept]:
        """Stops that must leave, then answers that are due."""
        out = [message for event in events for message in self._take(event)]
        due = [id for id, each in self._open.items() if each.has_left and each.due <= now]
        return [*out, *(self._open.pop(id).unkept for id in due)]

    def _take(self, event: Event) -> list[Stop | Unkept]:
        if isinstance(event, Opened):
            self._open_act(event.request)
        elif isinstance(event, Happened):
            request_id, due = event.answer.request or "", event.at + ANSWERED_WITHIN_S
            unkept = done_unkept(event.answer, STILL_WAITS())
            self._open[request_id] = OpenAct(request=event.answer, unkept=unkept, due=due, has_left=True)
        elif isinstance(event, Overrun):
            return self._stops(frozenset([event.robot]))
        elif isinstance(event, Closed):
            self._open.pop(event.request_id, None)
        elif (act := self._open.get(event.request_id)) is not None:
            reached = self.reached(act.request)
            act.has_left = bool(reached)
            return self._stops(reached) if isinstance(event, Blocked) else []
        return []

    def _open_act(self, request: OperatorRequest) -> None:
        is_stop = request.verb.row.stops
        answer = stop_left(request, STILL_WAITS()) if is_stop else taken_up_later(request, STILL_WAITS())
        self._open[request.request or ""] = OpenAct(
            request=request,
            unkept=answer,
            due=request.at + ANSWERED_WITHIN_S,
            has_left=not is_stop and bool(self.reached(request)),
        )

    def _stops(self, names: frozenset[str]) -> list[Stop | Unkept]:
        """A stop for each of these robots that anything leaves for."""
        id, self._count = f"{self._epoch}-{self._count:010d}", self._count + 1
        return [Stop(id=id, robot=name, mode=StopMode.LATCH) for name in self._robots if name in names]
