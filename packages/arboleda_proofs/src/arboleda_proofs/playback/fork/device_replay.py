"""Troubles of a record, repeated on the virtual devices of a fork at the same times."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

from arboleda.drivers import Evidence
from arboleda.model.messages import Event, OperatorRequest, RestartRequest, Revision, Shutdown, TaskRequest
from arboleda.model.plant_model import Link
from arboleda.rig.network import keeps_its_place
from arboleda.rig.world import World
from arboleda.wire.transport import Publication
from arboleda_proofs.playback.troubles import ALARM, BOOT, BRIDGE, Trouble

# What comes from people; devices are virtual.
INPUTS = (TaskRequest, OperatorRequest, Shutdown, Revision, RestartRequest)
ONE_RESTART_S = 1.0  # all robots of a bridge report its restart
INSIDE_S = 0.001  # a silence begins after one report and ends before another
TOO_LATE_S = 1e6  # a last will that nobody waits for


def ask(world: World, at: float, events: Iterable[Event]) -> None:
    """Have people make the same requests at the same times."""
    for event in events:
        if isinstance(event, INPUTS):
            world.at(max(event.at, at), world.tell, event)


def befall(world: World, troubles: Iterable[Trouble]) -> None:
    """Repeat the troubles, or continue those that have begun; those that ended before now are left out."""
    restarted_at = -math.inf
    for trouble in troubles:
        robot = world.model.robots.get(trouble.robot)
        if robot is None or robot.link is not Link.MQTT or trouble.ends <= world.now:
            continue
        if trouble.kind == BRIDGE:
            if trouble.at - restarted_at > ONE_RESTART_S:
                world.at(_off_at(trouble), lambda _: _restart_bridge(world))
            restarted_at = trouble.at
        elif trouble.kind == ALARM:
            world.at(trouble.at, _at_board(_alarm, world, robot.mqtt))
            _later(world, trouble.ends, _at_board(_repair, world, robot.mqtt))
        elif trouble.kind == BOOT and robot.evidence is Evidence.IDS and trouble.at >= world.now:
            _boot(world, robot.mqtt, trouble)
        else:
            _silence(world, robot.mqtt, trouble)


def _later(world: World, at: float, call: Callable[[None], None]) -> None:
    if at < math.inf:
        world.at(at, call)


def _at_board(act: Callable[[World, str], None], world: World, board: str) -> Callable[[None], None]:
    return lambda _: act(world, board)


def _silence(world: World, board: str, trouble: Trouble) -> None:
    """Silence a board; if its connection broke, the broker reports that when it did."""
    line = world.broker.clients[board].up

    def lose(message: object) -> tuple[float, ...]:
        return (0.0,) if keeps_its_place(message) else ()

    def begin(_: object) -> None:
        line.troubles.append(lose)

    world.at(trouble.at + INSIDE_S, begin)
    _later(
        world, max(trouble.at, trouble.ends - 2 * INSIDE_S) + INSIDE_S, lambda _: line.troubles.remove(lose)
    )
    if trouble.cut:
        world.at(_off_at(trouble), lambda _: _present(world, board, b"0"))
        _later(world, trouble.ends, lambda _: _present(world, board, b"1"))


def _present(world: World, board: str, payload: bytes) -> None:
    world.publish(Publication(topic=f"{board}/conexion", payload=payload, retain=True))


def _boot(world: World, board: str, trouble: Trouble) -> None:
    off_at = _off_at(trouble)
    will_s = 0.0 if trouble.cut else TOO_LATE_S
    world.at(off_at, lambda _: world.power_off(board, will_after_s=will_s))
    _later(world, max(off_at, trouble.ends - INSIDE_S), lambda _: world.power_on(board))


def _off_at(trouble: Trouble) -> float:
    """The time at which a board went off: the one reported at once, else shortly after its last report."""
    return trouble.lost_at if trouble.cut and trouble.lost_at is not None else trouble.at + INSIDE_S


def _alarm(world: World, board: str) -> None:
    world.boards[board].fail(round(world.now * 1e6))
    world.wake(board)


def _repair(world: World, board: str) -> None:
    world.boards[board].repair(round(world.now * 1e6))
    world.wake(board)


def _restart_bridge(world: World) -> None:
    world.stop_bridge()
    world.start_bridge()
