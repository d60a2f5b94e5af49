"""State machine of one vehicle and its devices: commands become orders and actions, states become reports.

A vehicle sends its state when something changes, and otherwise rarely. In between the driver repeats the
known state, as long as the broker calls the vehicle online. It leaves out the motion after a new order or
action, until a state of the vehicle names that.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from arboleda.drivers import (
    Command,
    Device,
    Facts,
    FollowPath,
    Mobile,
    MotionState,
    NotSent,
    Report,
    Robot,
    Stop,
    VerbCommand,
    lost,
    plain,
)
from arboleda_drivers.connections.link import LogLine

from . import factsheet
from .answers import Answers
from .link import Link
from .map import GridMap
from .orders import Action, Actions, Order, instant
from .settings import Settings
from .state import FACTS, Body, VehicleState, read
from .stops import AGAIN_S, Stops

BEAT_S = 0.3
LATE_S = 2.0
FACTSHEET_TRIES = 3  # factsheet requests; not all vehicles have one
LONGEST_COMMAND = "1800000000-99999"  # an id as the plant makes them, by its start and a number
OURS = "arboleda-"  # prefix of the ids of all orders of plants


@dataclass(frozen=True, kw_only=True)
class Publish:
    """Message for the vehicle, to which the sender adds the header."""

    topic: str
    body: Mapping[str, Any]


Message = Report | Publish | LogLine


class Vehicle:
    """State machine of one vehicle; `mark` sets its orders apart from those of any other start or plant."""

    def __init__(self, devices: Sequence[Robot], settings: Settings, *, mark: str) -> None:
        mobiles = [device for device in devices if isinstance(device, Mobile)]
        if len(mobiles) > 1:
            raise ValueError(f"{', '.join(each.name for each in mobiles)} are one vehicle by their settings")
        self._devices = {device.name: device for device in devices}
        self._settings, self._mark = settings, mark
        self._map = GridMap(mobiles[0] if mobiles else None, settings)
        self.link = Link(settings)
        self._state: VehicleState | None = None
        self._order: Order | None = None
        self._instants: dict[str, Command] = {}  # commands beside its order, by action
        self._stops = Stops()
        self._actions = Actions(mark)
        self._most_nodes: int | None = None  # of an order
        self._has_sheet, self._sheet_requests, self._ask_at = False, 0, -math.inf
        self._answers = Answers(self._devices)
        self.next_deadline = 0.0

    def step(self, now: float) -> list[Message]:
        """Report the known state, if that is due."""
        if now < self.next_deadline:
            return []
        if self.link.falls_silent(now):
            self._forget()
        return [*self._ask(now), *self._say_stops_again(now), *self._reports(now)]

    def connected(self, now: float, *, up: bool) -> list[Message]:
        """Note that the broker is connected, or is lost."""
        self.link.broker(up=up)
        if not up:
            self._forget()
        return list(self._reports(now))

    def connection(self, now: float, body: Body) -> list[Message]:
        """Take a message of the topic `connection`."""
        was_online = self.link.is_online
        self.link.connection(now, body["connectionState"])
        if not self.link.is_online:
            self._forget()
        elif not was_online:
            self._ask_at, self._sheet_requests = now, 0
        return [*self._ask(now), *self._reports(now)]

    def _ask(self, now: float) -> list[Message]:
        """Ask for messages still missing; a vehicle may begin to listen only a while after it is online."""
        if not self.link.is_online or now < self._ask_at:
            return []
        self._ask_at = now + AGAIN_S
        missing = [] if self._state is not None else ["stateRequest"]
        if not self._has_sheet and self._sheet_requests < FACTSHEET_TRIES:
            self._sheet_requests += 1
            missing.append("factsheetRequest")
        return self._instantly(self._actions.of_types(*missing))

    def state(self, now: float, body: Body) -> list[Message]:
        """Take a state that fits the schema; one not newer than the last is ignored."""
        state = read(body)
        if not self.link.takes(now, state):
            return []
        if self.link.has_booted:
            self._forget()
        self._state = state
        self._stops.see(state)
        messages = [*self._judge_order(now, state), *self._left_over(now, state)]
        self._judge_instants(state)
        return [*messages, *self._reports(now), *_late(self._settings.vehicle, self.link.delay_s(now, state))]

    def lose(self, now: float, why: str) -> list[Message]:
        """Lose the link, and open work, after a message that caused an error; the next state restores it."""
        self.link.lose(why)
        self._forget()
        return [*self._reports(now)]

    def factsheet(self, now: float, body: Body) -> list[Message]:
        """Take the vehicle's factsheet: limit orders to its lengths, and name what it lacks."""
        sheet, self._has_sheet = factsheet.read(body), True
        self._most_nodes = None if sheet.most_nodes is None else max(2, sheet.most_nodes)
        wanted = factsheet.wanted(self._devices.values(), self._settings)
        ids = (f"{OURS}{self._mark}-{LONGEST_COMMAND}", *self._map.edge_ids)
        name = self._settings.vehicle
        return [
            LogLine(text=f"{name} by its factsheet: {each}") for each in factsheet.lacks(sheet, wanted, ids)
        ]

    # --- commands ---

    def command(self, now: float, command: Command) -> list[Message]:
        """The messages that carry out a command; raises NotSent if that is impossible."""
        if (why := self.link.trouble) is not None:
            raise NotSent(why)
        if isinstance(command, Stop):
            return self._stop(now, *self._stops.types(command.mode))
        at = self._state.node if self._state is not None else ""
        if isinstance(command, FollowPath):
            return self._begin(command, self._map.way(at, command.nodes))
        if not isinstance(command, VerbCommand):
            raise NotSent(f"VDA 5050 has no word for {type(command).__name__}")
        if command.verb not in self._settings.instant:
            if not at:
                verb = command.verb
                raise NotSent(f"the vehicle says of no node that it stands there, so it cannot {verb} there")
            return self._begin(command, (at,), verb=command)
        action = self._actions.new("NONE", command.verb, command.values)
        self._instants[action.id] = command
        return self._instantly([action])

    def _begin(
        self, command: Command, nodes: tuple[str, ...], verb: VerbCommand | None = None
    ) -> list[Message]:
        state = self._state
        if self._order is not None:
            raise NotSent(f"the vehicle is still at its order {self._order.id}")
        if state is not None and state.ahead:
            other = plain(state.order, 60)
            raise NotSent(f"the vehicle is at the order {other} of somebody else; stop it, then clear")
        actions = () if verb is None else (self._actions.new("HARD", verb.verb, verb.values),)
        self._order = Order(
            id=f"{OURS}{self._mark}-{command.id}",
            command=command,
            nodes=nodes,
            released=min(len(nodes), 1 + self._base) if self._base else len(nodes),
            actions=actions,
            passing={
                step: tuple(
                    self._actions.new(edge.blocking, edge.action, tuple(edge.values.items()))
                    for edge in self._settings.edges
                    if {*edge.between} == {*ends}
                )
                for step, ends in enumerate(pairwise(nodes))
            },
        )
        return [self._sent(self._order)]

    @property
    def _base(self) -> int:
        """The number of nodes ahead of the vehicle that are released; 0: all of them."""
        limit = 0 if self._most_nodes is None else self._most_nodes - 1
        return (
            min(self._settings.base, limit) if self._settings.base and limit else self._settings.base or limit
        )

    def _sent(self, order: Order, first: int = 0) -> Publish:
        body = order.message(self._map.position, self._settings.map, first, self._most_nodes)
        return Publish(topic="order", body=body)

    def _stop(self, now: float, *types: str) -> list[Message]:
        """Send instant actions that must end before the vehicle counts as standing."""
        actions = self._actions.of_types(*types)
        self._stops.sent(now, actions)
        if self._order is not None and "cancelOrder" in types:
            self._order.cancelled = True
        return self._instantly(actions)

    def _say_stops_again(self, now: float) -> list[Message]:
        if not self._stops.are_due(now) or self.link.trouble is not None:
            return []
        types = self._stops.again(self._state)
        return self._stop(now, *types) if types else []

    def _instantly(self, actions: Sequence[Action]) -> list[Message]:
        """A message for each action: some vehicles lose the second action of a message."""
        version = self._settings.version
        return [Publish(topic="instantActions", body=instant([action], version)) for action in actions]

    def unsent(self, command: Command) -> None:
        """Forget a command whose message could not leave."""
        if self._order is not None and self._order.command is command:
            self._order = None
        self._instants = {id: each for id, each in self._instants.items() if each is not command}

    # --- states of the vehicle ---

    def _judge_order(self, now: float, state: VehicleState) -> list[Message]:
        order = self._order
        if order is None:
            return []
        if order.cancelled:
            if not state.driving and "cancelOrder" not in self._stops.open:
                self._order = None
            return []
        if state.order != order.id:
            return self._judge_strange(now, order, state)
        if not order.taken:
            order.taken = True
            self._answers.say(order.command, "accepted")
        word = order.failure(state, is_known=self._map.number(state.node) is not None)
        if word is not None:
            return self._fail(now, order, word, state)
        if order.is_done(state):
            found = next((state.actions.get(action.id) for action in order.actions), None)
            self._answers.end(order.command, found.result if found is not None else None)
            self._order = None
            return []
        first = order.extend(state.node, state.sequence, self._base)
        return [] if first is None else [self._sent(order, first)]

    def _judge_strange(self, now: float, order: Order, state: VehicleState) -> list[Message]:
        """Judge a state that names another order than ours, or none."""
        word = next((each.word for each in state.troubles if order.id in dict(each.about).values()), None)
        if order.taken:
            self._answers.say(order.command, "failed", "order_lost")
            self._order = None
        elif word is not None:
            self._answers.say(order.command, "rejected", word)
            self._order = None
        elif state.hindrance is not None:
            self._answers.say(order.command, "rejected", state.hindrance)
            return self._stop(now, "cancelOrder")
        return []

    def _fail(self, now: float, order: Order, word: str, state: VehicleState) -> list[Message]:
        """Report a failed command, and cancel the rest of its order."""
        self._answers.say(order.command, "failed", word)
        if state.ahead or state.driving:
            return self._stop(now, "cancelOrder")
        self._order = None
        return []

    def _left_over(self, now: float, state: VehicleState) -> list[Message]:
        """Cancel an order of ours that the vehicle still drives but that no command stands behind.

        It is left from before a silence, from an earlier start, or after a cancel that failed. Repeated every
        AGAIN_S, not with each state.
        """
        ours = state.order.startswith(OURS) and state.ahead
        if not ours or self._order is not None or not self._stops.are_due(now):
            return []
        return self._stop(now, "cancelOrder")

    def _judge_instants(self, state: VehicleState) -> None:
        for action, command in list(self._instants.items()):
            found = state.actions.get(action)
            trouble = state.trouble_with(action)
            if found is None and trouble is not None:
                self._answers.say(command, "rejected", trouble)
            elif found is not None:
                self._answers.say(command, "accepted")
                if found.status == "FAILED":
                    self._answers.say(command, "failed", trouble or "action_failed")
                elif found.status == "FINISHED":
                    self._answers.end(command, found.result)
            if state.is_over(action) or (found is None and trouble is not None):
                del self._instants[action]

    # --- reports for the plant ---

    def _reports(self, now: float) -> Iterator[Report]:
        self.next_deadline = now + BEAT_S
        why = self.link.trouble
        for device in self._devices.values():
            if why is not None:
                yield lost(device.name, at=now, why=why)
            elif self._state is not None:
                yield self._report(now, device, self._state)

    def _report(self, now: float, device: Robot, state: VehicleState) -> Report:
        mobile = isinstance(device, Mobile)
        return Report(
            at=now,
            robot=device.name,
            boot_id=self.link.boots,
            state=self._motion(state),
            node=self._map.number(state.node) if mobile else None,
            homed=state.homed if mobile else None,
            facts=_facts(device, state),
            **self._answers.of(device.name),
        )

    def _motion(self, state: VehicleState) -> MotionState | None:
        """The motion state; None if the last state does not reflect commands given since."""
        if state.hindrance is not None:
            return MotionState.FAULT
        if state.driving:
            return MotionState.MOVING
        if self._order is not None:
            return MotionState.MOVING if self._order.taken and not self._order.cancelled else None
        if self._stops.open:
            return None
        if state.ahead:
            return MotionState.MOVING
        return MotionState.STOP_LATCHED if state.paused else MotionState.STOPPED

    def _forget(self) -> None:
        """Forget open work; an order that the vehicle still has is cancelled when it is back."""
        self._state, self._order = None, None
        self._stops.forget()
        self._instants.clear()
        self._answers.forget()


def _late(vehicle: str, late_s: float) -> Iterator[LogLine]:
    if late_s > LATE_S:
        yield LogLine(text=f"the states of {vehicle} come {late_s:.0f} s late, or its clock was set back")


def _facts(device: Robot, state: VehicleState) -> Facts:
    if not isinstance(device, Device):
        return ()
    found = ((name, type, FACTS[name](state)) for name, type in device.kind.facts.items() if name in FACTS)
    read = (
        (name, type.read(int(value) if type.type is int else value))
        for name, type, value in found
        if value is not None
    )
    return tuple((name, value) for name, value in read if value is not None)
