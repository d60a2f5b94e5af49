"""Invariants of parts: where they are, and what a task leaves behind."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from arboleda.drivers import Value, shown
from arboleda.engine.inspection import ledger_of, places_of, tasks_of
from arboleda.model import text
from arboleda.model.messages import Check, Fact
from arboleda.model.plant_model import Cell
from arboleda.model.recipe import nearest

from ..truth.part_places import kept_parts
from .invariant import Look, Trigger, invariant


@invariant(Trigger.MISPLACED)
def parts_are_taken_and_put_where_they_can_be(look: Look) -> Iterator[str]:
    """No hand takes hold of a part at a place where none is, or lets go of one at a place that is full."""
    yield from look.truth.places.wrong


@invariant(Trigger.MISSED)
def parts_and_room_are_missed_where_there_are_none(look: Look) -> Iterator[str]:
    """A command is refused for a place that has no part, or no room, only where that is so."""
    yield from look.truth.places.missed


@invariant(Trigger.DONE_TASKS)
def books_of_parts_are_true(look: Look) -> Iterator[str]:
    """Each place of a cell whose task is called done has as many parts as the plant has booked there, and
    has kept for its next start. Where the plant died as it said so, the next task may have begun in its
    books: what people fill and empty is left out then.
    """
    for cell, task, _ in look.truth.done_tasks:
        places = look.truth.places.cells.get(cell)
        if places is None:
            continue
        booked = places_of(look.world.plant.cells[cell]).counts
        kept = look.world.disk.facts.get(Fact.PARTS, {}).get(cell, "")
        known = places.parts.keys() - (places.by_people if look.moment.last_words else ())
        wrong = {each: booked[each] for each in known if booked[each] != places.parts[each]}
        if wrong and not places.is_doubtful:
            truly = {each: places.parts[each] for each in wrong}
            yield f"{task} is called done; by the books there are {wrong}, and truly {truly}"
        parts = kept_parts(kept)
        if any(parts.get(each, 0) != booked[each] for each in known):
            yield f"{task} is called done; by the books there are {booked}, and kept is {kept!r}"


@invariant(Trigger.DONE_TASKS)
def done_tasks_leave_nothing_behind(look: Look) -> Iterator[str]:
    """A task that is called done leaves no part in a hand, and none in a device where there was none before,
    unless its recipe says so, people fill and empty that place, or the task says that nobody checked the
    grip; in a cell without places, and in a device that is no hand of one, as long as nothing has gone
    wrong: an alternative may leave it closed. What a device holds that cells share is left by the cell that
    commanded it last, and a hand that closes late, on a command of before the task, by nobody.
    """
    for cell, task, began in look.truth.done_tasks:
        model = look.world.model.cell(cell)
        if not _is_known(look, cell) or task not in tasks_of(look.world.plant):
            continue
        wanted = _wanted(look, model, task, began)
        for name in model.holders if _is_calm(look) else _hands(look, model):
            robot = look.truth.robot(name)
            if name in wanted or _closed_late(look, model, name, began):
                continue
            if name in model.shared and not _was_commanded(look, name, cell, since=began):
                continue
            if robot is not None and robot.body.true_facts.get(robot.robot.held_fact):
                yield f"{task} is called done, and {name} still holds a part"
        if Check.GRIP not in tasks_of(look.world.plant)[task].unchecked:
            yield from _left_in_devices(look, model, task, wanted)


def _was_commanded(look: Look, robot: str, cell: str, *, since: float) -> bool:
    """True where the last command to a robot is of this cell, and not older than `since`, in s."""
    last = ledger_of(look.world.plant).last_sent.get(robot)
    return last is not None and last.cell == cell and last.sent_at >= since


def _left_in_devices(look: Look, cell: Cell, task: str, wanted: Mapping[str, Value]) -> Iterator[str]:
    for place in cell.places:
        places = look.truth.places.cells[cell.name]
        now, before = places.at_end[place.target], places.at_begin[place.target]
        is_of_task = place.device is not None and not place.by_people
        if is_of_task and now != before and place.target not in wanted:
            yield f"{task} is called done, with {now} parts at {place.target}, and began with {before}"


@invariant(Trigger.DONE_TASKS)
def recipes_end_as_they_say(look: Look) -> Iterator[str]:
    """The end of a task that is called done is as its recipe says, and what cells share as it left it."""
    for cell, task, began in look.truth.done_tasks:
        model = look.world.model.cell(cell)
        if not _is_known(look, cell) or task not in tasks_of(look.world.plant):
            continue
        for what, value in _wanted(look, model, task, began).items():
            found = _found(look, model, what, began)
            if found is not None and found != value:
                yield f"{task} is called done, and {what} is {shown(found)}, not {shown(value)}"


def _is_known(look: Look, cell: str) -> bool:
    """True where somebody can know what a task of the cell did."""
    if look.world.model.cell(cell).counted:
        return not look.truth.places.cells[cell].end_is_doubtful
    return _is_calm(look)


def _is_calm(look: Look) -> bool:
    """True as long as nothing has gone wrong."""
    return look.world.last_fault_at == -math.inf and look.record.operator_requests.undisturbed


def _hands(look: Look, cell: Cell) -> list[str]:
    """The holders that move parts between the places of a cell."""
    return [name for name in cell.holders if look.truth.places.cells[cell.name].has(name)]


def _closed_late(look: Look, cell: Cell, hand: str, began: float) -> bool:
    """True for a hand that was in the middle of a grip as the task began, and was told nothing since."""
    places = look.truth.places.cells.get(cell.name)
    is_late = places is not None and hand in places.late_hands
    return is_late and not _was_commanded(look, hand, cell.name, since=began)


def _wanted(look: Look, cell: Cell, task: str, began: float) -> Mapping[str, Value]:
    """The end of a task that its recipe states; of several the one that is meant by what is found."""
    order = text.parse(tasks_of(look.world.plant)[task].order.text, look.world.model)

    def differs(what: str, value: Value) -> bool:
        return _found(look, cell, what, began) not in (None, value)

    return nearest(cell.recipe(order.recipe).ends_of(order.values), differs)


def _found(look: Look, cell: Cell, what: str, began: float) -> Value | None:
    """The true value of a fact, as `reader.lid`, the last answer of a device to this task, as `camera.look`,
    or the true number of parts at a place, as the task left it; None of a shared device that the task never
    had, and where it did not ask.
    """
    role, dot, fact = what.partition(".")
    if not dot:
        return look.truth.places.cells[cell.name].as_left.get(what)
    device = cell.roles[role]
    if fact not in device.fact_names:
        return look.truth.last_answers.since(began, cell.name).get(f"{device.name}.{fact}")
    if device.name in cell.shared:
        return look.truth.shared.as_left_by(cell, device.name, since=began).get(fact)
    return look.truth.robot(device.name).body.true_facts[fact]  # type: ignore[no-any-return]


PLACES = (
    parts_are_taken_and_put_where_they_can_be,
    parts_and_room_are_missed_where_there_are_none,
    books_of_parts_are_true,
    done_tasks_leave_nothing_behind,
    recipes_end_as_they_say,
)
