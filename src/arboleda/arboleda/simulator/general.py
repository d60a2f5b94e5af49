"""What must hold in a plant of any devices, judged by how they truly are, whatever kinds they are of.

The invariants of storage know paths, stations and parts; these know commands, facts, targets and zones.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from arboleda.core.advice import in_words
from arboleda.core.cell_states import CellState
from arboleda.core.commands import Motion, Position
from arboleda.core.facts import Value
from arboleda.core.ledger import Entry, State
from arboleda.core.messages import InternalError, TaskChanged, TaskState
from arboleda.core.model import PlantModel, Pose, Robot

from .invariants.invariant import Look, When, invariant
from .world import World

ENDED = frozenset({TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED})
OF_BOARDS = ("reboot", "brown_out", "mute", "board_stall", "driver_alarm", "gives_up")
OF_LINES = ("loss", "duplicate", "reorder", "delay", "partition", "broker_restart", "lost_queue")
OF_THE_HOP = ("hop_delay", "hop_reorder", "hop_partition")
OF_PROCESSES = ("bridge_restart", "bridge_stall", "plant_stall", "plant_freeze", "plant_crash")
SAID = (
    "stop",
    "clear",
    "reset",
    "hold",
    "resume",
    "cancel",
    "retry",
    "abandon",
    "release",
    "home",
    "override",
)
OF_OPERATORS = tuple(f"operator_{verb}" for verb in SAID)
GENERAL_FAULTS = frozenset((*OF_BOARDS, *OF_LINES, *OF_THE_HOP, *OF_PROCESSES, *OF_OPERATORS))
"""The kinds of faults after which these invariants hold; after others boards lie about themselves."""


def is_general(model: PlantModel) -> bool:
    """Whether a plant has a cell that the invariants of storage do not know."""
    return any(not cell.is_storage for cell in model.cells)


class GeneralTruth:
    """How robots and devices are, and what the plant was heard to say of commands and tasks, step by step."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._plant: object = None
        self._open: dict[str, Entry] = {}
        self._so: dict[tuple[str, str, object], float] = {}  # when a fact last had a value, by device
        self._stood: dict[tuple[str, str], float] = {}  # when a robot last stood at a target, by both names
        self.done: list[Entry] = []  # the commands that count as done since this step
        self.accepted: set[str] = set()
        self.ended: list[str] = []

    def look(self) -> None:
        """Take in what one step has changed."""
        world = self._world
        if world.plant is not self._plant:  # a plant that crashed forgets its tasks and commands
            self._plant, self._open = world.plant, {}
            self.accepted.clear()
            self.ended.clear()
        for robot in world.model.robots.values():
            self._look_at(robot)
        for message in world.moment.sent:
            if isinstance(message, TaskChanged) and message.task:
                if message.state in ENDED:
                    self.ended.append(message.task)
                else:
                    self.accepted.add(message.task)
        self.done = [entry for entry in self._open.values() if entry.state is State.DONE]
        self._open = {id: entry for id, entry in world.plant.dispatcher.ledger.entries.items() if entry.open}

    def was_so(self, robot: str, name: str, value: object, since: float) -> bool:
        """Whether a device truly had this value of a fact since then."""
        return self._so.get((robot, name, value), -1.0) >= since

    def stood_at(self, robot: str, goal: Position, since: float) -> bool:
        """Whether a robot truly stood there since then; True where it has no targets."""
        space = self._world.model.cell_of[robot].workspaces.get(robot)
        names = [pose.name for pose in space.poses if goal in (pose.q, pose.above)] if space else []
        return not names or any(self._stood.get((robot, name), -1.0) >= since for name in names)

    def occupants(self, zone: str) -> list[str]:
        """The robots and devices that truly are in a zone."""
        found = []
        for cell in self._world.model.cells:
            for space in cell.workspaces.values():
                here = self.position(space.robot)
                inside = [pose for pose in space.poses if zone in pose.zones]
                if here is not None and any(_is_at(space.robot, here, pose) for pose in inside):
                    found.append(space.robot.name)
            for lock in cell.interlocks:
                facts = self._facts(self._world.model.robots[lock.device])
                if lock.zone == zone and any(facts.get(name) != value for name, value in lock.free_while):
                    found.append(lock.device)
        return found

    def position(self, robot: Robot) -> Position | None:
        """Where a robot truly is; None where it has no place."""
        board = self._world.boards.get(robot.mqtt)
        return board.body.true_place if board else None

    def _look_at(self, robot: Robot) -> None:
        now = self._world.now
        for name, value in self._facts(robot).items():
            self._so[robot.name, name, value] = now
        space = self._world.model.cell_of[robot.name].workspaces.get(robot.name)
        here = self.position(robot) if space else None
        for pose in space.poses if space and here is not None else ():
            if _is_at(robot, here, pose):
                self._stood[robot.name, pose.name] = now

    def _facts(self, robot: Robot) -> Mapping[str, Value]:
        board = self._world.boards.get(robot.mqtt)
        return board.body.true_facts if board else {}


def _is_at(robot: Robot, here: Position, pose: Pose) -> bool:
    """Whether a robot stands at a pose, or over it: both lie in the same zones."""
    return any(robot.stands_at(here, q) for q in (pose.q, pose.above) if q is not None)


@invariant(When.SENT)
def no_step_raises(look: Look) -> Iterator[str]:
    """No step of a cell ends in an error of the program."""
    for message in look.moment.sent:
        if isinstance(message, InternalError):
            yield f"{message.cell}: {type(message.error).__name__}: {message.error}"


@invariant(When.SENT)
def a_task_ends_once(look: Look) -> Iterator[str]:
    """An accepted task ends at most once."""
    ended = look.truth.ended
    for task in {each for each in ended if ended.count(each) > 1}:
        yield f"{task} ended {ended.count(task)} times"


@invariant(When.ALWAYS)
def what_is_done_was_so(look: Look) -> Iterator[str]:
    """A command that counts as done was done since it was given: its facts were so, its goal was reached."""
    for entry in look.truth.done:
        command, since = entry.command, entry.sent_at
        for name, value in command.sets:
            if not look.truth.was_so(command.robot, name, value, since):
                what = f"{type(command).__name__} {command.id}"
                yield f"{command.robot}: {name} was never {value} since {what}"
        goal = command.way[-1] if isinstance(command, Motion) and command.way else None
        if goal is not None and not look.truth.stood_at(command.robot, goal, since):
            yield f"{command.robot} never stood at the goal of {command.id}"


@invariant(When.ALWAYS)
def a_zone_has_one_occupant_who_holds_it(look: Look) -> Iterator[str]:
    """At most one robot or device is in a zone, and it holds the zone."""
    for zone in look.world.model.zones:
        inside = look.truth.occupants(zone)
        if len(inside) > 1:
            yield f"{zone}: {', '.join(inside)} are in it together"
        elif inside and look.world.plant.zones.holder(zone) != inside[0]:
            yield f"{zone}: {inside[0]} is in it, and {look.world.plant.zones.holder(zone)} holds it"


@invariant(When.END)
def everything_comes_to_rest(look: Look) -> Iterator[str]:
    """Without faults, with somebody who follows the advice, every cell gets idle and nothing moves."""
    plant = look.world.plant
    for name, cell in plant.cells.items():
        if cell.state is not CellState.IDLE or cell.queue:
            ways = [str(in_words(each)) for each in plant.advice(name)]
            yield f"{name} is {cell.state.value} with {len(cell.queue)} queued; advice: {ways}"
    for name, board in look.world.boards.items():
        if board.body.moving:
            yield f"{name} still moves"


@invariant(When.END)
def an_accepted_task_has_ended(look: Look) -> Iterator[str]:
    """Every accepted task ends."""
    for task in sorted(look.truth.accepted - set(look.truth.ended)):
        yield f"{task} never ended"


class NoRecord:
    """What these invariants need is all in the truth."""

    def look(self) -> None:
        """Nothing is recorded."""


GENERAL = (
    no_step_raises,
    a_task_ends_once,
    what_is_done_was_so,
    a_zone_has_one_occupant_who_holds_it,
    everything_comes_to_rest,
    an_accepted_task_has_ended,
)
