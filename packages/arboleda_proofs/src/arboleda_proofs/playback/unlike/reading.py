"""All devices of a record, watched step by step; what they told that virtual ones cannot, counted."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import (
    Command,
    FollowPath,
    Home,
    MoveJoints,
    Report,
    SetEffector,
    Stop,
    StopMode,
    UseError,
)
from arboleda.model.messages import Event, Interference, OperatorRequest, Undelivered
from arboleda.model.plant_model import Link, PlantModel
from arboleda.recorder.plain_data import TYPE
from arboleda.recorder.steps import RecordedStep
from arboleda_proofs.playback.incident import AWAY_S, supervised
from arboleda_proofs.playback.troubles import BRIDGE, Trouble, Troubles
from arboleda_proofs.simulator.faults import Fault

from .device import DeviceWatch
from .difference import Difference

COMMANDS: Mapping[str, Any] = {
    each.__name__: each for each in (FollowPath, Home, MoveJoints, SetEffector, Stop)
}
NOBODY = (Link.SCREEN, Link.NONE)


@dataclass(frozen=True, kw_only=True)
class Unlike:
    """One kind of difference of one device: the greatest, how often, when first, and its fault."""

    worst: Difference
    times: int
    unix_ns: int
    fault: Fault | None


class PlantWatch:
    """Watch over the devices of a plant that runs, or ran; times are those of its clock."""

    def __init__(self, model: PlantModel) -> None:
        self._model = model
        self._watches = {
            robot.name: DeviceWatch(robot) for robot in model.robots.values() if robot.link not in NOBODY
        }
        self._troubles = Troubles(supervised(model), model.timing.stale_after_s)
        self._found: list[Difference] = []
        self._absences: list[tuple[float, float]] = []
        self._began: tuple[float, int] | None = None
        self._now = 0.0

    @property
    def minutes(self) -> float:
        """The time that was looked at."""
        return (self._now - (self._began[0] if self._began else self._now)) / 60

    def take(
        self, now: float, events: Iterable[Event], commands: Iterable[Command], unix_ns: int = 0
    ) -> None:
        """Take in a step: what went in, and the commands that came out."""
        if self._began is None:
            self._began = now, unix_ns
        elif now - self._now > AWAY_S:  # whoever did nothing meanwhile is the plant
            self._absences.append((self._now, now))
            for watch in self._watches.values():
                self._found += watch.part(now)
        self._now = now
        events = [*events]
        self._troubles.take(events)
        for event in events:
            self._hear(event, now)
        for command in commands:
            if command.id and command.robot in self._watches:
                self._watches[command.robot].give(command, now)

    def _hear(self, event: Event, now: float) -> None:
        watch = self._watches.get(getattr(event, "robot", ""))
        if isinstance(event, Report) and watch is not None:
            self._found += watch.hear(event, now)
        elif isinstance(event, Interference) and watch is not None:
            watch.excuse(now)
        elif isinstance(event, Undelivered) and watch is not None:
            watch.drop(event.id)
        for each in self._watches.values():
            if isinstance(event, OperatorRequest) and event.by_hand:
                each.excuse(now)
            elif (late_s := getattr(event, "late_s", None)) is not None:  # a command left later
                each.delay(getattr(event, "id", ""), late_s)

    def differences(self) -> list[Difference]:
        """All differences so far, in order, with those that go on."""
        going = [each for watch in self._watches.values() for each in watch.going_on(self._now)]
        troubles = [*self._of_troubles()]
        return sorted([*self._found, *going, *troubles], key=lambda each: each.at)

    def _of_troubles(self) -> Iterator[Difference]:
        for each in self._troubles.of(self._now):
            until = min(each.ends, self._now)
            if each.kind != BRIDGE and not self._was_away(each, until):
                yield Difference(rule=each.kind, robot=each.robot, at=each.at, seconds=until - each.at)

    def _was_away(self, trouble: Trouble, until: float) -> bool:
        return any(began < until and trouble.at < ended for began, ended in self._absences)

    def unlike(self) -> list[Unlike]:
        """The differences, those of a kind as one, in the order in which they came first."""
        kinds: dict[tuple[str, str, str], list[Difference]] = {}
        for each in self.differences():
            kinds.setdefault((each.robot, each.rule, each.word), []).append(each)
        return [self._unlike(found) for found in kinds.values()]

    def _unlike(self, found: list[Difference]) -> Unlike:
        began, unix_ns = self._began or (0.0, 0)
        worst = max(found, key=lambda each: (each.seconds, each.amount))
        return Unlike(
            worst=worst,
            times=len(found),
            unix_ns=unix_ns + round((found[0].at - began) * 1e9),
            fault=worst.fault(self._model.robots[worst.robot], self._model),
        )


def watched(model: PlantModel, steps: Iterable[RecordedStep]) -> PlantWatch:
    """The watch over all steps of a record."""
    watch = PlantWatch(model)
    for step in steps:
        watch.take(step.now, step.events, _commands(model, step.result["messages"]), step.unix_ns)
    return watch


def _commands(model: PlantModel, rows: Iterable[Mapping[str, Any]]) -> Iterator[Command]:
    for row in rows:
        command = _command(model, row)
        if command is not None:
            yield command


def _command(model: PlantModel, row: Mapping[str, Any]) -> Command | None:
    """The command of a message of a record; None for any other, or of a device that the plant has not."""
    robot, make = model.robots.get(row.get("robot", "")), COMMANDS.get(row[TYPE])
    if robot is None or not row.get("id"):
        return None
    if make is not None:
        values = {name: _value(name, value) for name, value in row.items() if name != TYPE}
        made: Command = make(**values)
        return made
    if not robot.verb_names or "verb" not in row:
        return None
    try:
        return robot.verb_command(row["verb"], tuple(dict(row["values"]).items()), id=row["id"])
    except UseError:  # of another version of the plant
        return None


def _value(name: str, value: Any) -> Any:
    if name == "mode":
        return StopMode(value)
    return tuple(value) if isinstance(value, list) else value
