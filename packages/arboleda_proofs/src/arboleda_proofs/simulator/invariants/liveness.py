"""Liveness: nothing sleeps, starves or waits for ever, and in the end all is at rest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from arboleda.drivers import Evidence, MotionState
from arboleda.engine import Entry, why_held, why_waiting
from arboleda.engine.inspection import (
    beliefs_of,
    is_ending,
    ledger_of,
    parts_of,
    places_of,
    reached_of,
    time_of,
)
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Fact
from arboleda.model.plant_model import Link, Pose, Workspace
from arboleda.sim.board import Board

from ..recorded.cells import KnownCell
from .invariant import Look, Trigger, invariant

NOTHING: tuple[str, ...] = ()
SLACK_S = 0.001
SURE_S = 1.5  # after a start, and some reports
AT_WORK = (CellState.EXECUTE, CellState.HOLDING, CellState.HELD)


@invariant(Trigger.NEWS)
def running_tree_has_waker(look: Look) -> Iterable[str]:
    """A tree that runs has an open command or a time that will wake it."""
    awake = {sent.entry.cell for sent in look.record.commands.open.values() if sent.entry}
    awake |= {entry.cell for entry in _questions(look)}
    asleep = [cell for cell in look.record.cells.values() if cell.name not in awake and _sleeps(cell)]
    return [f"{cell.name} sleeps with a running tree" for cell in asleep]


def _questions(look: Look) -> list[Entry]:
    """The open questions to people: nothing is sent for those."""
    ledger, robots = ledger_of(look.world.plant), look.world.model.robots.values()
    asked = [ledger.question(robot.name) for robot in robots if robot.link is Link.SCREEN]
    return [entry for entry in asked if entry is not None]


def _sleeps(cell: KnownCell) -> bool:
    """True if no time will wake a tree that runs; a cell whose own time stands still has no such time."""
    runs = cell.tree is not None and cell.state is CellState.EXECUTE
    return runs and time_of(cell.run).next_deadline is None


@invariant(Trigger.NEWS)
def time_stands_still_only_when_held(look: Look) -> Iterable[str]:
    """The own time of a cell, which its trees wait by, passes unless the cell is held."""
    frozen = [cell for cell in look.record.cells.values() if cell.frozen_s > SLACK_S]
    return [f"{cell.name} is {cell.state.value}, and its time stood still" for cell in frozen]


@invariant(Trigger.NEWS)
def time_stands_still_where_held(look: Look) -> Iterable[str]:
    """The own time of a cell that is held at work stands still: what waits there waits on when it goes on."""
    ran = [cell for cell in look.record.cells.values() if abs(cell.ran_s) > SLACK_S]
    return [f"{cell.name} was held, and its time went on" for cell in ran]


@invariant(Trigger.NEWS)
def no_tree_outlives_its_work(look: Look) -> Iterable[str]:
    """A cell has a tree only while it works, or is held at work."""
    left = [
        cell for cell in look.record.cells.values() if cell.tree is not None and cell.state not in AT_WORK
    ]
    return [f"{cell.name} is {cell.state.value}, and still has a tree" for cell in left]


@invariant(Trigger.IDLE)
def no_starvation(look: Look) -> Iterable[str]:
    """In a cell that is idle, ready and not paused the next task starts in the same step."""
    return _idle_though_ready(look) if look.record.step.stepped else NOTHING


def _idle_though_ready(look: Look) -> Iterator[str]:
    for cell in look.record.states.idle:
        if ready(look, cell):
            yield f"{cell.name} is ready, and its next task does not start"


def ready(look: Look, cell: KnownCell) -> bool:
    """True if a cell would start a task, by what its robots said and what operators asked for."""
    plant, robots = look.world.plant, look.record.robots
    if cell.stopped or is_ending(plant) or _is_asked(look, cell):
        return False
    for robot in cell.cell.robots:
        if robot.link is Link.SCREEN:
            if _is_stopped_with_another_cell(look, robot.name):
                return False
            continue
        known = robots[robot.name]
        if known.stop is not None and robot.name in cell.cell.shared:
            return False  # it still waits for another cell's reset
        if known.state is MotionState.MOVING or known.is_unfit(plant.now, plant.epoch):
            return False
        # the plant's evidence judges if a jump of its joints was a reboot
        if not robot.says_homed and beliefs_of(plant)[robot.name].displaced:
            return False
    return not _is_busy(look, cell) and _outside(look, cell)


def _is_asked(look: Look, cell: KnownCell) -> bool:
    """True while a person has to say what a task that is not done has left at a place."""
    places = look.truth.places.cells.get(cell.name)
    asked = places_of(look.world.plant.cells[cell.name]).asked
    return places is not None and bool(asked.targets) and places.may_have_left(asked.targets)


def _is_stopped_with_another_cell(look: Look, person: str) -> bool:
    """True for a person whom cells share while one of them is stopped: nothing is sent that would tell."""
    return any(look.record.cells[cell.name].stopped for cell in look.world.model.cells_of[person])


def _is_busy(look: Look, cell: KnownCell) -> bool:
    """True while one of its robots may not have done yet what an operator told it."""
    robots = {robot.name for robot in cell.cell.robots}
    has_question = any(entry.command.robot in robots for entry in _questions(look))
    return has_question or any(sent.robot in robots for sent in look.record.commands.open.values())


def _outside(look: Look, cell: KnownCell) -> bool:
    """True if each robot that shares zones is seen at a pose outside of them, and stays there; one that is
    shared itself, and that no other cell has, at its home.

    A report that comes just after a start may be older than the robot's last move.
    """
    if any(_is_away(look, cell, name) for name in cell.cell.shared_movers):
        return False
    if (
        look.world.plant_process.found.facts.get(Fact.QUARANTINE)
        and look.world.now < look.record.unattended.born_at + SURE_S
    ):
        return not (cell.cell.zone_users or cell.cell.shared_movers)
    return all(_is_outside(look, cell.cell.workspaces[name]) for name in cell.cell.zone_users)


def _is_away(look: Look, cell: KnownCell, robot: str) -> bool:
    """True if a shared robot that no other cell has says where it is, and that is not its home."""
    space, known = cell.cell.workspaces[robot], look.record.robots[robot]
    is_lent = look.world.plant.zones.holder(robot) not in (None, cell.name)
    says_where = known.q is not None or known.node is not None
    return says_where and not is_lent and not _stands_at(look, space, [space.home])


def _is_outside(look: Look, space: Workspace) -> bool:
    """True for a robot outside of the shared zones; at `state` it counts where its last motion led, not what
    it says of its place.
    """
    if space.robot.evidence is Evidence.STATE:
        goal = reached_of(look.world.plant).get(space.robot.name)
        return goal is None or any(not pose.zones and pose.q == goal for pose in space.poses)
    return _stands_at(look, space, [pose for pose in space.poses if not pose.zones])


def _stands_at(look: Look, space: Workspace, poses: list[Pose]) -> bool:
    """True if a robot is seen at, or above, one of these poses, and stays there."""
    robot, known = space.robot, look.record.robots[space.robot.name]
    # until it names its last command, that may still be on its way and set it in motion
    if robot.evidence is Evidence.IDS and robot.has_stop and known.unnamed is not None:
        return False
    # the plant's evidence judges if what it told of its place may be older than its last stop
    if not beliefs_of(look.world.plant)[robot.name].stillness.is_sure:
        return False
    points = [point for pose in poses for point in (pose.q, pose.above) if point is not None]
    here = known.node if known.q is None else known.q
    return here is not None and any(
        robot.motion.stands_at(here, robot.motion.held_at(point)) for point in points
    )


@invariant(Trigger.WAITING)
def zone_requests_end(look: Look) -> Iterable[str]:
    """A request for a zone is granted or refused within zone_wait_s of the cell's own time; that of a
    recovery within as long since those before it were at work.
    """
    return _overdue(look)


def _overdue(look: Look) -> Iterator[str]:
    """Sentences on arms that wait for too long; no tree is asked while its cell is held."""
    for user in look.record.waiting.users:
        cell = look.record.cells[user.cell]
        if cell.state is CellState.EXECUTE and user.waited_s > cell.cell.zone_wait_s + SLACK_S:
            yield f"{user.robot} waits for its zones for {user.waited_s:.3f} s"


@invariant(Trigger.END)
def at_rest_at_end(look: Look) -> Iterable[str]:
    """At the end each task has ended, each cell is idle, each robot at rest, and no zone held."""
    plant, record, zones = look.world.plant, look.record, look.world.plant.zones
    for task in record.tasks.open.values():
        yield f"task {task.id} of {task.cell} is {task.state.value}"
    for name, cell in plant.cells.items():
        if cell.state is not CellState.IDLE or cell.tree is not None:
            yield f"{name} is {cell.state.value}; {why_held(cell) or 'its tree runs'}"
    for sent in record.commands.open.values():
        yield f"{sent} is open"
    for zone in look.world.model.zones:
        if (robot := zones.holder(zone)) is not None and not _is_in_the_way(look, robot, zone):
            yield f"{robot} holds {zone}{', quarantined' if zones.is_quarantined(zone) else ''}"
    for robot, _ in zones.queue.waiting:
        yield f"{robot} waits for zones"
    yield from _restless(look)


def _is_in_the_way(look: Look, device: str, zone: str) -> bool:
    """True if a machine at rest keeps a zone because it is in the way there: its door is shut."""
    locked = any(device in cell.interlocked for cell in look.world.model.cells)
    there = locked and zone in look.truth.robot(device).zones
    return there and not look.world.plant.zones.is_quarantined(zone)


def _restless(look: Look) -> Iterator[str]:
    """Sentences on robots that are not at rest, by what the plant heard or by the state of their boards."""
    plant, boards = look.world.plant, look.record.boards.of_robot
    for name, known in look.record.robots.items():
        if known.robot.link is Link.SCREEN:
            continue
        for obstacle in sorted(known.obstacles(plant.now, plant.epoch)):
            yield f"{name} is {obstacle.value}"
        if known.state is MotionState.MOVING:
            yield f"{name} says that it moves"
        if known.stop is not None:
            yield f"the stop of {name} is not over"
        if (board := boards.get(name)) is not None and (words := ", ".join(_troubles(board.board))):
            yield f"the board of {name} is {words}"


def _troubles(board: Board) -> Iterator[str]:
    rows = {
        "moving": board.body.moving,
        "unhomed": not board.homed,
        "faulted": board.faulted,
        "latched": board.latched,
    }
    return (word for word, is_so in rows.items() if is_so)


@invariant(Trigger.END)
def nothing_waits_at_end(look: Look) -> Iterable[str]:
    """At the end every queue is empty, none is paused, and no arm holds anything."""
    for name, cell in look.world.plant.cells.items():
        if cell.queue:
            yield f"{len(cell.queue)} tasks wait in {name}: {why_waiting(cell)}"
        if cell.queue.paused:
            yield f"the queue of {name} is paused"
        for robot in parts_of(cell).holding:
            yield f"{robot} may hold a part"


LIVENESS = (
    running_tree_has_waker,
    time_stands_still_only_when_held,
    time_stands_still_where_held,
    no_tree_outlives_its_work,
    no_starvation,
    zone_requests_end,
    at_rest_at_end,
    nothing_waits_at_end,
)
