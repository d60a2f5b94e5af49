"""Bounded books: nothing that a plant, a bridge or a board keeps grows with time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from arboleda.engine import HISTORY
from arboleda.engine.inspection import (
    Feed,
    asking_of,
    beliefs_of,
    latches_of,
    ledger_of,
    outbox_of,
    reached_of,
    tasks_of,
    time_of,
)
from arboleda.wire.labels import REMEMBERED

from .invariant import Look, Trigger, invariant

NOTHING: tuple[str, ...] = ()
EVERY_S = 5.0
PER_ROBOT = 8  # open commands; an operator may ask for the same thing a few times
WAKES = 100
INBOX = 20_000  # messages for a process that stalls for 15 s while everybody says everything twice


@invariant(Trigger.LEFT_OVER, every_s=EVERY_S)
def bounded_books(look: Look) -> Iterable[str]:
    """The books that the plant, the bridge and the boards keep stay below fixed bounds."""
    if look.record.step.stepped and outbox_of(look.world.plant):
        return ["the plant kept a message after its step"]
    return _long(look) if look.whole else NOTHING


def _long(look: Look) -> Iterator[str]:
    for what, length, most in (*_plant(look), *_bridge(look), *_network(look)):
        if length > most:
            yield f"{what}: {length}, at most {most}"


Row = tuple[str, int, int]


def _plant(look: Look) -> Iterator[Row]:
    plant, robots = look.world.plant, len(look.world.model.robots)
    ledger, latches = ledger_of(plant), latches_of(plant)
    waiting = sum(cell.cell.queue_limit + 1 for cell in plant.cells.values())
    yield "open commands", len(ledger.entries), PER_ROBOT * robots
    yield "cells to wake", len(ledger.changed), 0
    yield "kinds of ignored feeds", len(ledger.ignored), len(Feed)
    yield "beliefs", len(beliefs_of(plant)), robots
    yield "reached goals", len(reached_of(plant)), robots
    yield "latched robots", len(latches.stopped | latches.cleared), robots
    yield "tasks", len(tasks_of(plant)), HISTORY + waiting
    cells = look.world.model.cells
    users = sum(len(cell.zone_users) + len(cell.interlocked) + bool(cell.shared) for cell in cells)
    yield "waiting for zones", len(asking_of(plant)), users
    for name, cell in plant.cells.items():
        yield f"queue of {name}", len(cell.queue), cell.cell.queue_limit
        yield f"wakes of {name}", len(time_of(cell).wakes), WAKES


def _bridge(look: Look) -> Iterator[Row]:
    bridge = look.world.bridge
    boards = bridge._boards.items() if bridge is not None else ()  # what it keeps is no part of its interface
    for name, board in boards:
        yield f"labels of {name}", len(board.labels._issued), REMEMBERED
        yield f"known ids of {name}", len(board.labels._ids), REMEMBERED


def _network(look: Look) -> Iterator[Row]:
    for name, client in look.world.broker.clients.items():
        yield f"inbox of {name}", len(client.inbox), INBOX


BOOKS = (bounded_books,)
