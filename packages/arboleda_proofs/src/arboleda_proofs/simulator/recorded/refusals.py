"""Comparison for a step in which all requests were refused and nothing else happened: nothing may change.

`rejected_input_changes_nothing` finds by it a verb that is in the journal before it is known to be possible.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from arboleda.model.messages import Fact, Heartbeat, OperatorAnswer, Remember, TaskChanged

if TYPE_CHECKING:
    from ..record import Record


def differences(record: Record) -> list[str]:
    """Sentences on what changed; none in a step in which something was done or heard, or may have come due.
    Called before the mirrors of the record are brought up to date.
    """
    if not _only_refused(record) or _something_was_due(record):
        return []
    return list(_found(record))


def _only_refused(record: Record) -> bool:
    moment, tasks = record.world.moment, record.tasks
    refused = sum(answer.refusal is not None for answer in record.operator_requests.answers)
    repeated = sum(change.answer for change in tasks.changes)
    return not moment.reports and refused + repeated + tasks.refused == len(moment.requests)


def _something_was_due(record: Record) -> bool:
    now = record.world.plant.now
    if record.step.away or record.step.begins:  # what an earlier start left is found in the first step
        return True
    # an arm whose tree has ended gives its zones back in the next step, whatever happens in that
    if any(isinstance(each, Remember) and each.fact is Fact.QUARANTINE for each in record.world.moment.sent):
        return True
    if any(cell.woke() for cell in record.cells.values()):
        return True
    if any(record.step.at < robot.stale_at <= now for robot in record.robots.values()):
        return True
    commands = [*record.commands.open.values(), *(sent for sent, _ in record.commands.moved)]
    return any(sent.entry.next_deadline <= now for sent in commands if sent.entry is not None)


def _found(record: Record) -> Iterator[str]:
    for message in record.world.moment.sent:
        if not isinstance(message, TaskChanged | OperatorAnswer | Heartbeat):
            yield f"{type(message).__name__} was sent"
    if any(not change.answer for change in record.tasks.changes):
        yield "a task changed"
    for sent, _ in record.commands.moved:
        yield f"{sent} changed"
    for cell in record.cells.values():
        yield from cell.changes()
