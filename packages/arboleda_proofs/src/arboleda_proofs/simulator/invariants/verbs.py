"""Operators' verbs by a table of our own: when each may be refused, and what it must have done."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from arboleda.drivers import Command, Evidence, Home, Stop, StopMode, Switch
from arboleda.engine import OPEN, State
from arboleda.engine.inspection import RELEASING, grips_of, places_of
from arboleda.model.cell_states import CellState
from arboleda.model.common_places import with_common_places
from arboleda.model.messages import Fact, Journal, OperatorAnswer, OperatorRequest, Outcome, TaskState, Verb
from arboleda.model.plant_model import Link, is_homed_by_word

from ..recorded.cells import KnownCell
from ..recorded.commands import SentCommand
from ..recorded.robots import StopProgress
from ..recorded.scopes import UNSENT
from ..recorded.verbs import CellSnapshot
from .invariant import Look, Trigger, invariant

Can = Callable[[CellSnapshot], bool]  # whether a verb can be done in a cell, as the cell was before
S = CellState


def _resumable(cell: CellSnapshot) -> bool:
    if cell.state is S.IDLE:
        return cell.paused
    held = cell.state is S.HELD and cell.has_task
    return held and not (cell.troubled or cell.stranded or cell.waits)


CAN: dict[Verb, Can] = {
    Verb.STOP: lambda cell: True,
    Verb.RESET: lambda cell: cell.state is S.STOPPED,
    Verb.HOLD: lambda cell: cell.state is S.EXECUTE,
    Verb.RESUME: _resumable,
    Verb.CANCEL: lambda cell: cell.has_task and cell.state in (S.EXECUTE, S.HELD),
    Verb.RETRY: lambda cell: (
        cell.state is S.HELD and not (cell.stranded or cell.waits) and (cell.troubled or not cell.has_task)
    ),
    Verb.ABANDON: lambda cell: cell.state is S.HELD and (cell.has_task or not cell.holding),
}
# Verbs whose refusal also hangs on what robots say: in these states of a cell it is sure.
CANNOT: dict[Verb, Can] = {
    Verb.CLEAR: lambda cell: cell.state not in (S.ABORTED, S.CLEARING),
    Verb.RELEASE: lambda cell: cell.state in (S.EXECUTE, S.HOLDING, S.ABORTING),
    Verb.HOME: lambda cell: cell.state not in (S.IDLE, S.HELD),
    Verb.DO: lambda cell: cell.state not in (S.IDLE, S.HELD),
}


@invariant(Trigger.ASKED)
def verbs_are_refused_rightly(look: Look) -> Iterator[str]:
    """A verb is refused where it can be done nowhere in its scope, and only there."""
    for request, answer in _alone(look):
        expected = _refused(look, request)
        if expected is not None and expected is not (answer.refusal is not None):
            what = f"{request.verb.value} {request.scope!r}"
            states = {cell.name: cell.state.value for cell in _found(look)}
            yield f"{what} was {'not ' if expected else ''}refused ({answer.refusal}); before it {states}"
        zones = look.world.model.zones
        if request.verb is Verb.OVERRIDE and request.scope not in zones:
            unsaid = [zone for zone in zones if zone not in str(answer.refusal)]
            if unsaid:
                yield f"{request.scope!r} is no zone, and nobody says that there are {unsaid}"


def _alone(look: Look) -> Iterator[tuple[OperatorRequest, OperatorAnswer]]:
    """The verb of a step and its answer, if nothing but an absence came before it in that step. A plant's
    first step has none, as the plant looks there first what became of the tasks that it found.
    """
    requests, answers = look.moment.requests, look.record.operator_requests.answers
    alone = len(requests) == len(answers) == 1 and not look.moment.reports and not look.record.step.begins
    if alone and isinstance(requests[0], OperatorRequest) and not _is_shared(look, requests[0]):
        yield requests[0], answers[0]


def _is_shared(look: Look, request: OperatorRequest) -> bool:
    """True if a verb is for a device that cells share: it goes to the cell that holds the device."""
    return request.scope.strip().lower() in look.world.model.shared


def _found(look: Look) -> list[CellSnapshot]:
    """The cells as the verb found them: a plant that was away first holds those at work."""
    cells = look.record.before_requests.cells
    return [_held_after_absence(cell) for cell in cells] if look.record.step.away else cells


def _held_after_absence(cell: CellSnapshot) -> CellSnapshot:
    worked = cell.state is S.EXECUTE
    state, paused = S.HOLDING if worked else cell.state, cell.paused or worked
    return replace(cell, state=state, paused=paused, troubled=cell.troubled or worked)


def _refused(look: Look, request: OperatorRequest) -> bool | None:
    """The refusal that the verb must get; None if the record does not have enough to say."""
    record, verb, scope = look.record, request.verb, request.scope
    if verb not in (*CAN, *CANNOT, Verb.UNLOAD, Verb.OVERRIDE):
        return None
    if verb is Verb.UNLOAD and _ended_a_grip(look):
        return None
    if verb is Verb.UNLOAD:
        named = record.scopes.parts(request)
        return not any(
            cell.parts[place] for cell in record.before_requests.cells for place in named.get(cell.name, ())
        )
    if verb is Verb.OVERRIDE:
        quarantined = record.before_requests.quarantined.get(scope.strip().lower())
        return True if quarantined is None else None
    task = record.before_requests.tasks.get(scope.strip().lstrip("#")) if verb is Verb.CANCEL else None
    if task is not None:
        return None if task is TaskState.RUNNING else False
    if scope not in record.scopes:
        return True
    names = record.scopes.cells(scope)
    cells = [cell for cell in _found(look) if cell.name in names]
    if verb is Verb.HOME:
        cannot = any(CANNOT[verb](cell) for cell in cells if _homes_its_own(look, cell.name))
        return True if cannot or _not_so(look, request) else None
    if verb is Verb.CLEAR and any(cell.state is S.ABORTING for cell in cells):
        return True
    if verb in CANNOT:
        return True if all(map(CANNOT[verb], cells)) else None
    if record.step.away and verb in (Verb.RESUME, Verb.RETRY) and any(_is_at_a_step(cell) for cell in cells):
        return None  # robots are offline until they are heard again: what became of the step may not be known
    return not any(map(CAN[verb], cells))


def _is_at_a_step(cell: CellSnapshot) -> bool:
    return cell.state is S.HELD and cell.has_task


def _homes_its_own(look: Look, cell: str) -> bool:
    """False for a cell of which only shared robots are homed: one that another cell has is none of its."""
    of_cell = look.world.model.cell(cell)
    return not of_cell.shared_movers or any(look.world.model.robots[name].homes for name in of_cell.own)


def _not_so(look: Look, request: OperatorRequest) -> bool:
    """True if a robot of the scope is not homed in this way, by hand or by its routine.

    What has no homing is left out, unless there is nothing else.
    """
    robots = [look.world.model.robots[name] for name in look.record.scopes.robots(request.scope)]
    robots = [robot for robot in robots if robot.homes and robot.link is not Link.NONE] or robots
    if request.by_hand:
        return any(robot.says_homed and not is_homed_by_word(robot) for robot in robots)
    return any(robot.evidence is not Evidence.IDS or is_homed_by_word(robot) for robot in robots)


@invariant(Trigger.ASKED)
def verbs_do_what_they_say(look: Look) -> Iterator[str]:
    """A verb that is not refused is in the journal and has done its work, in its scope and nowhere else."""
    entries = (each for each in look.moment.sent if isinstance(each, Journal) and each.verb is not None)
    journalled = sum(each.outcome is None for each in entries)
    done = sum(answer.refusal is None for answer in look.record.operator_requests.answers)
    if journalled != done:
        yield f"{done} verbs were done, {journalled} are in the journal"
    for request, answer in _alone(look):
        effect = EFFECTS.get(request.verb)
        if answer.refusal is None and effect is not None and not _is_task(look, request):
            for wrong in effect(look, request):
                yield f"{request.verb.value} {request.scope or 'plant'}: {wrong}"


def _is_task(look: Look, request: OperatorRequest) -> bool:
    return request.scope.partition(" ")[0] not in look.record.scopes  # a station has its number behind it


def _cells(look: Look, request: OperatorRequest, can: Can) -> list[tuple[CellSnapshot, KnownCell]]:
    """The cells of its scope in which the verb could be done."""
    names = look.record.scopes.cells(request.scope)
    cells = [cell for cell in _found(look) if cell.name in names and can(cell)]
    return [(cell, look.record.cells[cell.name]) for cell in cells]


def _kept_stopped(look: Look, request: OperatorRequest) -> set[str]:
    """The shared devices that a clear leaves stopped, as a stopped cell of theirs is not cleared."""
    scope, record = set(look.record.scopes.robots(request.scope)), look.record
    kept = set()
    for device in look.world.model.shared:
        for cell in look.world.model.cells_of[device]:
            others = [name for name in cell.own if record.robots[name].stop is StopProgress.LATCHED]
            aborted = record.cells[cell.name].state in (S.ABORTING, S.ABORTED)
            if aborted and not scope.issuperset(others):
                kept.add(device)
    return kept


def _stops(look: Look, mode: StopMode) -> set[str]:
    sent = (each for each in look.moment.sent if isinstance(each, Stop))
    return {each.robot for each in sent if each.mode is mode}


def _stopped(look: Look, request: OperatorRequest) -> Iterator[str]:
    scope = look.record.scopes.commanded(request.scope)
    if _stops(look, StopMode.LATCH) != scope:
        yield f"{sorted(scope)} had to be stopped, {sorted(_stops(look, StopMode.LATCH))} were"
    for _, cell in _cells(look, request, CAN[Verb.STOP]):
        if cell.state not in (S.ABORTING, S.ABORTED) or cell.task is not None or not cell.paused:
            yield f"{cell.name} is {cell.state.value}, its queue {'is' if cell.paused else 'is not'} paused"
        yield from _uncancelled(look, cell.name)


def _uncancelled(look: Look, cell: str, *, motions: bool = False) -> Iterator[str]:
    for sent in look.record.commands.open.values():
        if sent.entry is None or sent.entry.cell != cell or (motions and not sent.can_be_halted):
            continue
        if sent.state is not State.CANCELLING and not sent.finishes:
            yield f"{sent} goes on"


def _cleared(look: Look, request: OperatorRequest) -> Iterator[str]:
    record = look.record
    could = _cells(look, request, lambda cell: not CANNOT[Verb.CLEAR](cell))
    names = {robot.name for _, cell in could for robot in cell.cell.robots}
    wanted = names & record.scopes.commanded(request.scope) - _kept_stopped(look, request)
    cleared = _stops(look, StopMode.CLEAR)
    wanted -= {*look.world.model.shared} - cleared  # a shared device is cleared only if it was stopped, too
    if not cleared <= wanted or (len(could) == 1 and cleared != wanted):
        yield f"{sorted(wanted)} could be cleared, {sorted(cleared)} were"
    for before, cell in could:
        kept = _kept_stopped(look, request)
        mine = [r.name for r in cell.cell.robots if r.name not in kept]
        latched = [name for name in mine if _is_stopped(look, name)]
        if latched and before.state is S.ABORTED and cell.state is not S.ABORTED:
            yield f"{cell.name} is {cell.state.value}, and {latched} are still stopped"
        if not latched and cell.state is S.ABORTED and len(could) == 1:
            yield f"{cell.name} is still aborted, and none of its robots is stopped"


def _is_stopped(look: Look, name: str) -> bool:
    """True while a stop of a robot holds; to a person nothing is sent, so what is kept says it of them."""
    if look.world.model.robots[name].link in UNSENT:
        return look.world.disk.facts.get(Fact.LATCH, {}).get(name) == "on"
    return look.record.robots[name].stop is StopProgress.LATCHED


def _reset(look: Look, request: OperatorRequest) -> Iterator[str]:
    for _, cell in _cells(look, request, CAN[Verb.RESET]):
        if cell.state in (S.STOPPED, S.RESETTING):
            yield f"{cell.name} is still {cell.state.value}"


def _held(look: Look, request: OperatorRequest) -> Iterator[str]:
    for _, cell in _cells(look, request, CAN[Verb.HOLD]):
        if cell.state not in (S.HOLDING, S.HELD) or not cell.paused:
            yield f"{cell.name} is {cell.state.value}, its queue {'is' if cell.paused else 'is not'} paused"
        yield from _uncancelled(look, cell.name, motions=True)


def _gone_on(look: Look, request: OperatorRequest) -> Iterator[str]:
    for before, cell in _cells(look, request, CAN[Verb.RESUME]):
        if before.state is S.IDLE and cell.state is S.IDLE and cell.paused:
            yield f"the queue of {cell.name} is still paused"
        if before.state is S.HELD and cell.state is S.HELD and cell.task is not None and not cell.run.trouble:
            yield f"{cell.name} is still held"


def _given_up(look: Look, request: OperatorRequest) -> Iterator[str]:
    for before, cell in _cells(look, request, CAN[Verb.ABANDON]):
        if before.has_task and cell.run.tree is not None and not cell.run.run.recovering:
            yield f"{cell.name} goes on with its task"


def _released(look: Look, request: OperatorRequest) -> Iterator[str]:
    if request.by_hand:
        yield from _emptied(look, request)
        return
    sent = [each.command for each in look.record.commands.new if _is_release(each)]
    if not sent:
        yield "no effector was opened"
    yield from _outside(look, request, sent)


def _emptied(look: Look, request: OperatorRequest) -> Iterator[str]:
    scope = look.record.scopes.robots(request.scope)
    held = [name for name in scope if look.world.model.robots[name].held_fact is not None]
    left = [name for name in held if grips_of(look.world.plant).holding(name)]
    if left:
        yield f"{left} may still hold a part"
    for each in look.moment.sent:
        if isinstance(each, Command) and each.robot in scope:
            yield f"{each.robot} was commanded"


def _homed(look: Look, request: OperatorRequest) -> Iterator[str]:
    sent = [each for each in look.moment.sent if isinstance(each, Home)]
    scope = look.record.scopes.robots(request.scope)
    if not {each.robot for each in sent} <= set(scope):
        yield f"{[each.robot for each in sent]} were sent to their reference"
    if request.by_hand and sent:
        yield f"{[each.robot for each in sent]} move by themselves"


def _ended_a_grip(look: Look) -> bool:
    """True where a grip ended in this step: nobody knows whether that was before the verb or after it."""
    ended = (sent.command for sent, _ in look.record.commands.moved if sent.state not in OPEN)
    return any(isinstance(each, Switch) and each.grips is not None for each in ended)


def _booked(look: Look, request: OperatorRequest) -> Iterator[str]:
    if _ended_a_grip(look):
        return
    named = with_common_places(look.record.scopes.parts(request), look.world.model.cells)
    begun = {
        change.message.cell
        for change in look.record.tasks.changes
        if change.message.state is TaskState.RUNNING and not change.answer
    }
    for before in look.record.before_requests.cells:
        cell = look.record.cells[before.name]
        seen_to = {each.target for each in cell.cell.places if each.by_people and before.name in begun}
        wanted = before.parts | named.get(before.name, {})
        booked = places_of(cell.run).counts
        if any(booked[each] != wanted[each] for each in wanted.keys() - seen_to):
            yield f"{before.name} has the parts {booked}, and had to have {wanted}"


def _outside(look: Look, request: OperatorRequest, sent: Iterable[Command]) -> Iterator[str]:
    scope = look.record.scopes.robots(request.scope)
    for each in sent:
        if each.robot not in scope or look.world.model.robots[each.robot].held_fact is None:
            yield f"{each} is not in its scope"


Effect = Callable[[Look, OperatorRequest], Iterator[str]]
EFFECTS: dict[Verb, Effect] = {
    Verb.STOP: _stopped,
    Verb.CLEAR: _cleared,
    Verb.RESET: _reset,
    Verb.HOLD: _held,
    Verb.RESUME: _gone_on,
    Verb.ABANDON: _given_up,
    Verb.RELEASE: _released,
    Verb.HOME: _homed,
    Verb.UNLOAD: _booked,
    Verb.LOAD: _booked,
}


@invariant(Trigger.SENT)
def acts_end_as_told(look: Look) -> Iterator[str]:
    """An act of devices for an operator is told when it has ended, and as done if each device has done it."""
    ends = [each for each in look.moment.sent if isinstance(each, Journal) and each.outcome is not None]
    ended = [sent for sent, _ in look.record.commands.moved if sent.state not in OPEN]
    for end in ends:
        scope = look.record.scopes.robots(end.scope)
        mine = [sent for sent in ended if sent.robot in scope and end.verb and _is_of(sent, end.verb)]
        undone = [str(sent) for sent in mine if sent.state is not State.DONE]
        if undone and end.outcome is not Outcome.FAILED:
            yield f"{end.sentence} is told, and {undone} were not done"
        if mine and not undone and end.outcome is Outcome.FAILED and len(scope) == 1:
            yield f"{end.sentence} is told, and {[*map(str, mine)]} were done"
    for sent in ended:
        for verb in (Verb.RELEASE, Verb.HOME):
            waits = any(_is_of(other, verb) for other in look.record.commands.open.values())
            if _is_of(sent, verb) and not waits and not any(end.verb is verb for end in ends):
                yield f"{sent} has ended, and nobody is told what became of {verb.value}"


def _is_of(sent: SentCommand, verb: Verb) -> bool:
    """True if a command comes from an operator's verb; one that a task gave in the same step may not."""
    if verb not in sent.verbs:
        return False
    if verb is Verb.HOME:
        return isinstance(sent.command, Home)
    return _is_release(sent)


def _is_release(sent: SentCommand) -> bool:
    """True for a command to let go on an operator's word; a task may give one by itself in the same step."""
    lets_go = isinstance(sent.command, Switch) and sent.command.grips is False
    return lets_go and (sent.entry is None or sent.entry.doing.key == RELEASING.key)


VERBS = (verbs_are_refused_rightly, verbs_do_what_they_say, acts_end_as_told)
