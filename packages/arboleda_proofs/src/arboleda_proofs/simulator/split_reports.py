"""Robots whose state and position are not of one instant: two topics on ROS 2, or one that was put together.

A robot with command ids says everything in one message that its board made. Others may be anybody's: what
they say of moving and of where they are comes up to APART_S apart, either of them first.
"""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import cast

from arboleda.drivers import Device, Effect, Evidence, Mobile, Report, Robot
from arboleda.model.plant_model import APART_S
from arboleda.rig.world import World
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Publication

from .chance import Dice

PERIOD_S = 0.1
STATE = "estado"


def come_apart(world: World, seed: int) -> None:
    """Have robots without command ids report in one message, in two, or from one of two instants."""
    for robot in world.model.robots.values():
        dice = Dice(seed, "apart", robot.name)
        if (way := dice.pick(_ways(robot))) is not None:
            way(world, robot, dice)


def _ways(robot: Robot) -> tuple[Callable[[World, Robot, Dice], None] | None, ...]:
    """The ways to report of this robot; not two instants if a short state or node would never be reported."""
    if robot.evidence is Evidence.IDS:
        return (None,)
    if robot.evidence is Evidence.STATE or _is_too_fast(robot):
        return (None, _two_topics)
    return (None, _two_topics, _two_instants)


def _is_too_fast(robot: Robot) -> bool:
    """True if a robot may leave a node, or end a process, before its state of then is told."""
    if robot.floor_grid:
        return bool(robot.floor_grid.pitch / cast(Mobile, robot).speed < APART_S)
    verbs = cast(Device, robot).kind.verbs.values() if robot.verb_names else ()
    return any(verb.effect is Effect.PROCESS and verb.takes_s < APART_S for verb in verbs)


def _two_topics(world: World, robot: Robot, dice: Dice) -> None:
    world.partings[robot.name] = TwoTopics(dice, lambda: world.skipped_s).parted


class TwoTopics:
    """Two topics for each report, position and all the rest; each has its own delay and keeps its order.

    `skipped_s` is how much of the time until now nobody did anything: reports under way came later by it.
    """

    def __init__(self, dice: Dice, skipped_s: Callable[[], float]) -> None:
        self._dice = dice
        self._skipped_s = skipped_s
        self._latest_s = {which: dice.pick((0.0, APART_S)) for which in ("state", "position")}
        self._last = {"state": 0.0, "position": 0.0}  # when the last of each comes, less what was skipped
        self._place: Report | None = None  # the last position, as reports are made of others at less cost

    def parted(self, report: Report) -> Iterable[Report]:
        """The parts of a report, each stamped with its time of arrival."""
        at = report.at
        if report.q is None and report.node is None:
            yield report.again(self._arrival("state", at))
            return
        place = self._place or Report(at=0.0, robot=report.robot)
        self._place = place.again(self._arrival("position", at), q=report.q, node=report.node)
        yield self._place
        yield report.again(self._arrival("state", at), q=None, node=None)

    def _arrival(self, which: str, at: float) -> float:
        """The time at which a part comes of a report of this time."""
        late_s, skipped_s = self._dice.between(0.0, self._latest_s[which]), self._skipped_s()
        self._last[which] = max(self._last[which], at + late_s - skipped_s)
        return self._last[which] + skipped_s


def _two_instants(world: World, robot: Robot, dice: Dice) -> None:
    address = topic(robot.mqtt, Channel.TELEMETRY)
    mixed = partial(_mixed, state_s=dice.between(0.0, PERIOD_S), place_s=dice.between(0.0, PERIOD_S))
    reports: deque[tuple[float, bytes]] = deque()

    def mix(publication: Publication) -> Publication:
        if publication.topic != address:
            return publication
        reports.append((world.now, publication.payload))
        while len(reports) > 1 and reports[1][0] <= world.now - PERIOD_S:
            reports.popleft()
        return publication._replace(payload=mixed(reports, world.now))

    world.mixers[robot.mqtt] = mix


def _mixed(reports: Sequence[tuple[float, bytes]], now: float, *, state_s: float, place_s: float) -> bytes:
    """The state of `state_s` ago with all else of `place_s` ago, as far back as is known."""
    state, place = _as_of(reports, now - state_s), _as_of(reports, now - place_s)
    if state == place:
        return place
    return json.dumps({**json.loads(place), STATE: json.loads(state)[STATE]}, separators=(",", ":")).encode()


def _as_of(reports: Sequence[tuple[float, bytes]], at: float) -> bytes:
    for when, payload in reversed(reports):
        if when <= at:
            return payload
    return reports[0][1]
