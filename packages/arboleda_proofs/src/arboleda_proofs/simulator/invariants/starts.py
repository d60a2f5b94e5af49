"""Invariants over all starts of a plant that dies: nothing accepted is lost, nothing is done twice."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from arboleda.drivers import Stop, StopMode
from arboleda.engine.inspection import tasks_of
from arboleda.model import text
from arboleda.model.messages import Heartbeat, TaskChanged, TaskRequest, TaskState
from arboleda.recipes import TextError
from arboleda.wire.hop import shown

from ..recorded.tasks import SURE
from .invariant import Look, Trigger, invariant


@invariant(Trigger.BORN)
def accepted_is_found_again(look: Look) -> Iterator[str]:
    """Whatever was told of a task and of a stop is so for the plant that starts next."""
    starts, known = look.record.starts, tasks_of(look.world.plant)
    found = look.world.plant_process.found.tasks
    for id, said in [*starts.before.items()][-SURE:]:
        row, end = found.get(id), starts.ended.get(id)
        if row is None or id not in known:
            yield f"task {id} was told to be {said.state.value}, and who starts knows nothing of it"
        elif end is not None and known[id].state is not end.state:
            yield f"task {id} was told to have ended as {end.state.value}, and is {known[id].state.value}"
        elif said.state is TaskState.RUNNING and row.state is TaskState.QUEUED:
            yield f"task {id} was told to run, and waits again"
    for name in look.record.stops.lost:
        yield f"{name} was stopped, and the plant that starts does not know it"


@invariant(Trigger.ASKED)
def asked_again_is_the_same_task(look: Look) -> Iterator[str]:
    """Whoever asks again for an id that was accepted gets that task, in whichever start."""
    answers = {each.request: each for each in look.moment.sent if isinstance(each, TaskChanged)}
    for request in look.moment.requests:
        if not isinstance(request, TaskRequest) or "#" not in request.text or request.request not in answers:
            continue
        id, answer = request.text.rpartition("#")[2], answers[request.request]
        change = look.record.starts.changes.get(id)
        if (
            change is not None
            and answer.task != id
            and not answer.for_now
            and _asks_for(look, request, change)
        ):
            yield f"task {id} was accepted, and is now {answer.state.value}: {answer.sentence}"


def _asks_for(look: Look, request: TaskRequest, change: TaskChanged) -> bool:
    try:
        allowed = text.alternatives(request.text, look.world.offers)
        return any(order.text == change.text for order in allowed)
    except TextError:
        return False


@invariant(Trigger.UNKEPT)
def nothing_unkept_leaves(look: Look) -> Iterator[str]:
    """From the first thing that a plant cannot keep to its next start only stops and its beat leave it."""
    for message in look.moment.unkept:
        is_stop = isinstance(message, Stop) and message.mode is not StopMode.CLEAR
        if not is_stop and not isinstance(message, Heartbeat):
            yield f"the plant can keep nothing more, and {message} leaves"


@invariant(Trigger.TOLD_OTHERWISE)
def ends_once_over_all_starts(look: Look) -> Iterable[str]:
    """The end of a task is told once as news, whichever start tells it, and is the same ever after."""
    return look.record.starts.wrong


@invariant(Trigger.DONE_TWICE)
def no_step_is_done_twice(look: Look) -> Iterable[str]:
    """A step that a board has carried out for a task is not carried out again for a later start, but for a
    way that may have been cut short, and a step that an operator wants tried again.
    """
    return look.record.starts.twice


@invariant(Trigger.KEPT_WRONGLY)
def tasks_go_on_from_what_was_kept(look: Look) -> Iterable[str]:
    """The record of a task at work says which of its commands are done; and it goes on for a later start
    only where no device has booted since, which is said of that device and nothing else.
    """
    return look.record.trails.wrong


@invariant(Trigger.COMMANDED)
def nothing_moves_after_a_restart(look: Look) -> Iterator[str]:
    """After a start no robot is told to move before an operator gets its cell going, or somebody brings a
    task to a cell that had nothing to do; but where the plant file says so and no task was at work.
    """
    for command in look.record.unattended.stirring:
        yield f"the plant has started, and by itself sends {shown(command)} to {command.robot}"


STARTS = (
    accepted_is_found_again,
    asked_again_is_the_same_task,
    ends_once_over_all_starts,
    no_step_is_done_twice,
    tasks_go_on_from_what_was_kept,
    nothing_unkept_leaves,
    nothing_moves_after_a_restart,
)
