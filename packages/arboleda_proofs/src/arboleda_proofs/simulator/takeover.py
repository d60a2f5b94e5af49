"""Handover of a plant at work to virtual robots, which go on from where it believes the real ones to be."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from arboleda.drivers import Command, MotionState, Position, Report, Robot, Stop, StopMode
from arboleda.engine import Belief, Entry, Plant, State
from arboleda.engine.inspection import HEARTBEAT_S, beliefs_of, grips_of, latches_of, ledger_of
from arboleda.model.messages import Heartbeat
from arboleda.model.plant_model import PlantModel
from arboleda.rig.world import BRIDGE, World
from arboleda.sim.body import SeenState
from arboleda.wire.hop import FromPlant
from arboleda.wire.transport import Publication

Given = tuple[float, Command | Heartbeat]
APART_S = 0.3  # a virtual robot may be as far away as the real one moves in this time


def taken_over(plant: Plant, model: PlantModel) -> World:
    """A world at the time of the plant's last step, in which virtual boards do what is under way.

    `model` is the plant's own, in which each robot that has a board in simulations has one on MQTT. The
    boards repeat their open commands from where and when they began, so that they are in the middle of them.
    Where that ends elsewhere than the real robot was heard last, they do the rest from that place instead.
    """
    entries = list(ledger_of(plant).entries.values())
    world = _played(plant, model, entries, {entry.command.robot: entry.origin for entry in entries})
    astray = {name for name in beliefs_of(plant) if _is_astray(world, plant, name)}
    if astray:
        rest = [_rest_of(plant, entry) if entry.command.robot in astray else entry for entry in entries]
        began = {entry.command.robot: entry.origin for entry in rest}
        world = _played(plant, model, rest, began)
    _finish(world, plant)
    return world


def _played(
    plant: Plant, model: PlantModel, entries: Iterable[Entry], began: dict[str, Position | None]
) -> World:
    """Boards that were given these commands at their times; the plant of this world only sends heartbeats."""
    given = sorted(_given(plant, entries), key=lambda each: each[0])
    world = World(model, now=min([plant.now, *(at for at, _ in given)]), epoch=plant.epoch)
    world.plant_process.stop()
    for robot in model.robots.values():
        if robot.mqtt in world.boards:
            _place(world, plant, robot, began.get(robot.name))
    world.settle()
    for at, message in given:
        world.advance(max(0.0, at - world.now))
        _give(world, message)
        world.settle()
    world.advance(max(0.0, plant.now - world.now))
    return world


def _place(world: World, plant: Plant, robot: Robot, began: Position | None) -> None:
    """Put a virtual robot where its open command began; without one, where the real robot was heard last."""
    belief, board = beliefs_of(plant)[robot.name], world.boards[robot.mqtt]
    q = began if isinstance(began, tuple) else belief.q
    node = began if isinstance(began, int) else belief.node
    seen = SeenState(q, node, belief.effector, tuple(belief.facts.items()) or None)
    holds = robot.held_fact is not None and grips_of(plant).holding(robot.name) and belief.piece is not False
    latched = belief.state is MotionState.STOP_LATCHED
    board.place(seen, holds=holds, homed=not belief.says_unhomed, latched=latched)
    world.wake(robot.mqtt)


def _given(plant: Plant, entries: Iterable[Entry]) -> Iterator[Given]:
    """The open commands of robots, the stops that they got since, and heartbeats, each with its time.

    The ids of these stops have the plant's epoch, which fences others off, and numbers that it never gives.
    """
    first = plant.now
    for entry in entries:
        first = min(first, entry.sent_at)
        yield entry.sent_at, entry.command
        if entry.state is State.CANCELLING and entry.halts and entry.cancelled_at is not None:
            halt = Stop(id=f"{plant.epoch}-0", robot=entry.command.robot, mode=StopMode.HALT)
            yield entry.cancelled_at, halt
    for robot in sorted(latches_of(plant).stopped):
        yield plant.now, Stop(id=f"{plant.epoch}-00", robot=robot, mode=StopMode.LATCH)
    while first < plant.now:
        yield first, Heartbeat(epoch=plant.epoch)
        first += HEARTBEAT_S


def _give(world: World, message: Command | Heartbeat) -> None:
    """Have the bridge send a command to a board, and drop the answers."""
    assert world.bridge is not None
    bridge = world.broker.clients[BRIDGE]
    for order in world.bridge.step(world.now, [FromPlant(at=world.now, message=message)]):
        if isinstance(order, Publication):
            world.publish(order, bridge)


def _is_astray(world: World, plant: Plant, name: str) -> bool:
    """True if a virtual robot is further from where the real one was heard last than it could have moved."""
    belief, robot = beliefs_of(plant)[name], plant.model.robots[name]
    board = world.boards.get(robot.mqtt)
    place = None if board is None else board.body.true_place
    if place is None or belief.position is None:
        return False
    apart_s = plant.now - belief.stillness.position_at + APART_S
    return not robot.motion.can_have_moved(belief.position, place, apart_s)


def _rest_of(plant: Plant, entry: Entry) -> Entry:
    """The same command, given now where its robot was heard last."""
    rest = Entry(
        entry.command, cell=entry.cell, doing=entry.doing, sent_at=plant.now, deadline=entry.deadline
    )
    rest.state, rest.cancelled_at = entry.state, plant.now
    rest.origin = beliefs_of(plant)[entry.command.robot].position
    return rest


def _finish(world: World, plant: Plant) -> None:
    """Have the boards speak to this plant from now on, in place of the real ones."""
    for name, belief in beliefs_of(plant).items():
        world.partings[name] = Dress(belief)
        belief.number = None  # the boards that replace them count from 1
        if belief.state is MotionState.FAULT and belief.robot.mqtt in world.boards:
            world.boards[belief.robot.mqtt].fail(round(world.now * 1e6))
            world.wake(belief.robot.mqtt)
    world.plant = plant
    world.plant_process.start()


class Dress:
    """Makes the reports of a virtual robot those of the real one: with its bridge's and its boot's numbers.

    Later bridges and boots of the virtual robot become as many later ones of the real one.
    """

    def __init__(self, belief: Belief) -> None:
        self._epoch, self._boot_id = belief.epoch, belief.boot_id
        self._first: Report | None = None

    def __call__(self, report: Report) -> list[Report]:
        if self._first is None and report.state is not MotionState.NO_LINK:
            self._first = report
        first = self._first or report
        epoch = _later(self._epoch, first.epoch, report.epoch)
        return [replace(report, epoch=epoch, boot_id=_later(self._boot_id, first.boot_id, report.boot_id))]


def _later(ours: int | None, first: int | None, now: int | None) -> int | None:
    """The number that is as much later than ours as `now` is than the first."""
    return now if None in (ours, first, now) else ours + now - first  # type: ignore[operator]
