"""Tasks and cells: nothing accepted is lost, everything ends once, states change by their tables."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from arboleda.drivers import Command, Evidence, Stop, StopMode
from arboleda.engine.inspection import is_ending, tasks_of
from arboleda.model.cell_states import TABLE, Cause, CellState
from arboleda.model.messages import (
    ENDED,
    Fact,
    OperatorAnswer,
    OperatorRequest,
    Reason,
    Remember,
    TaskChanged,
    TaskRequest,
    TaskState,
    Verb,
)
from arboleda.model.plant_model import Cell, Workspace
from arboleda.recipes import Sentence
from arboleda.wire.hop import shown

from ..recorded.cells import KnownCell
from ..recorded.robots import STOPS, StopProgress
from ..recorded.scopes import UNSENT
from ..truth.mobile import MobileTruth
from .invariant import Look, Trigger, invariant
from .revisions import is_offered

LONGEST_WAIT_S = 1.5  # s in which robots wait for the plant before they stop by themselves
LEGAL: dict[TaskState | None, frozenset[TaskState]] = {
    None: frozenset({TaskState.QUEUED}),
    TaskState.QUEUED: frozenset({TaskState.RUNNING, TaskState.CANCELLED}),
    TaskState.RUNNING: ENDED,
}
NONE: frozenset[TaskState] = frozenset()
# Causes that change a cell's state without an operator, and those of each verb.
BY_ITSELF = frozenset({Cause.TASK, Cause.ENDED, Cause.STUCK, Cause.HALTED, Cause.CLEARED})
BY_VERB: dict[Verb, frozenset[Cause]] = {
    Verb.STOP: frozenset({Cause.STOP}),
    Verb.CLEAR: frozenset({Cause.CLEAR}),
    Verb.RESET: frozenset({Cause.RESET, Cause.READY}),
    Verb.HOLD: frozenset({Cause.HOLD}),
    Verb.RESUME: frozenset({Cause.RESUME}),
    Verb.RETRY: frozenset({Cause.RETRY}),
    Verb.ABANDON: frozenset({Cause.ABANDON}),
    Verb.CANCEL: frozenset({Cause.ABANDON}),
}
ROWS = tuple(TABLE.items())
ONLY_BY_FAULTS = frozenset(
    {
        Reason.LINK_LOST,
        Reason.REBOOTED,
        Reason.STOPPED_SHORT,
        Reason.NOT_REACHED,
        Reason.DEVICE_FAULT,
        Reason.STOP_UNCONFIRMED,
        Reason.STOPPED,
        Reason.INTERRUPTED,
    }
)
"""The reasons for which no recipe fails a task by itself."""
PIECES = frozenset({Reason.NO_PIECE, Reason.NOT_GRIPPED, Reason.PART_LOST})
TECHNICAL = ("Traceback", "object at 0x", "\n", "Error(")


@invariant(Trigger.TOLD)
def each_task_ends_once(look: Look) -> Iterable[str]:
    """Each accepted task is told to have ended once, and only after it was accepted."""
    for change in look.record.tasks.changes:
        if not change.answer and change.message.state in ENDED and change.before in (None, *ENDED):
            was = change.before.value if change.before else "never accepted"
            yield f"task {change.message.task} ended as {change.message.state.value}, and was {was}"


@invariant(Trigger.TOLD)
def nothing_of_an_ended_task_moves(look: Look) -> Iterable[str]:
    """All work for a task that has ended is over or was told to halt, but for what has to finish."""
    commands = look.record.commands
    for change in look.record.tasks.changes:
        if change.answer or change.before is not TaskState.RUNNING or change.message.state not in ENDED:
            continue
        for sent in commands.open.values():
            entry = sent.entry
            if entry is None or entry.cell != change.message.cell or sent in commands.new:
                continue
            if sent.can_be_halted and not sent.verbs and entry.cancelled_at is None:
                yield f"{change.message.task} has ended, and {sent} is under way"


@invariant(Trigger.TOLD)
def ended_tasks_stay_ended(look: Look) -> Iterable[str]:
    """A task that has ended never changes, and to cancel it is refused."""
    for change in look.record.tasks.changes:
        if not change.answer and change.before in ENDED:
            yield f"task {change.message.task} had ended, and became {change.message.state.value}"
    for answer in look.record.operator_requests.answers:
        if answer.verb is Verb.CANCEL and answer.refusal is None and _had_ended(look, answer):
            yield f"to cancel {answer.scope}, which had ended, was not refused"


def _had_ended(look: Look, answer: OperatorAnswer) -> bool:
    """True if the scope means a task that had ended before, and no cell or robot."""
    id = answer.scope.strip().lstrip("#")
    task = look.record.tasks.known(id)
    ended = task is not None and task.state in ENDED and task.since < look.world.plant.now
    return ended and id not in look.record.scopes


@invariant(Trigger.TOLD)
def only_legal_task_states(look: Look) -> Iterable[str]:
    """A task is queued, then runs, then ends; only a queued one may be cancelled before it runs."""
    for change in look.record.tasks.changes:
        if not change.answer and change.message.state not in LEGAL.get(change.before, NONE):
            was = change.before.value if change.before else "unknown"
            yield f"task {change.message.task} became {change.message.state.value}, and was {was}"


@invariant(Trigger.TOLD)
def first_come_first_served(look: Look) -> Iterable[str]:
    """The task of a cell that starts is the one that has waited longest."""
    for change in look.record.tasks.changes:
        if (
            change.message.state is TaskState.RUNNING
            and not change.answer
            and change.first != change.message.task
        ):
            yield f"task {change.message.task} started before {change.first}"


@invariant(Trigger.TOLD)
def tasks_start_where_all_is_ready(look: Look) -> Iterable[str]:
    """A task starts only where each robot of its cell takes commands and stands outside the shared zones by
    its last word, and no effector may hold a part, but for what another cell has that shares it.
    """
    record, zones = look.record, look.world.plant.zones
    for change in record.tasks.changes:
        if change.message.state is not TaskState.RUNNING or change.answer or change.message.cell is None:
            continue
        cell = record.cells[change.message.cell].cell
        for robot in cell.robots:
            known = record.robots[robot.name]
            if robot.link not in UNSENT and known.is_unfit(record.step.at, look.world.plant.epoch):
                yield f"task {change.message.task} starts, and {robot.name} takes no command"
        for name in (each for each in cell.zone_users if each not in cell.shared):
            if not _seen_outside(look, cell.workspaces[name]):
                yield f"task {change.message.task} starts, and {name} is not seen outside the zones"
        keepers = {name: zones.holder(name) or look.world.model.cell_of[name].name for name in cell.shared}
        with_others = {name for name, keeper in keepers.items() if keeper != cell.name}
        for name in (each for each in cell.holders if each not in with_others):
            kept = record.facts.before.get(Fact.EFFECTOR, {}).get(name, "off")
            if "off" not in (kept, record.facts.effector(name)) and not _let_go(look, name):
                yield f"task {change.message.task} starts, and the effector of {name} is {kept}"


def _seen_outside(look: Look, space: Workspace) -> bool:
    """True for a robot that stood at a zone-free pose by its last word, or by one of this step; and for one
    that tells no position.
    """
    robot, key = space.robot, space.robot.position_key
    if key is None or robot.evidence is Evidence.STATE:
        return True
    said = [report for report in look.moment.reports if report.robot == robot.name]
    places = [getattr(each, key) for each in (look.record.robots[robot.name], *said)]
    free = [spot for spot, _ in space.free_spots]
    return any(here is not None and robot.motion.stands_at(here, spot) for here in places for spot in free)


def _let_go(look: Look, name: str) -> bool:
    """True if an effector was off within this step: one task ended with that, the next has begun to grip."""
    kept = (each for each in look.moment.sent if isinstance(each, Remember))
    return any((each.fact, each.name, each.value) == (Fact.EFFECTOR, name, "off") for each in kept)


@invariant(Trigger.TOLD)
def cancelled_tasks_end_cancelled(look: Look) -> Iterable[str]:
    """A task ends as cancelled where an operator has cancelled it, as failed with a reason, or as done."""
    for change in look.record.tasks.changes:
        if change.message.state not in ENDED or change.answer:
            continue
        cancelled = change.message.state is TaskState.CANCELLED
        known = change.cancelled is not None and not (cancelled and _cancel_is_requested(look))
        if cancelled and look.world.versions and not is_offered(look.world.offers, change.message.text):
            continue  # another version was put to work, which has no such task
        if known and cancelled is not change.cancelled:
            word = "cancelled" if change.cancelled else "never cancelled"
            yield f"task {change.message.task} was {word}, and ended as {change.message.state.value}"
        ended = change.message
        if (ended.reason is None) is not (ended.state is TaskState.DONE):
            yield f"task {ended.task} ended as {ended.state.value} for {ended.reason}"


def _cancel_is_requested(look: Look) -> bool:
    """True if somebody asks for a cancel in this step: the plant reports the task before it answers."""
    requests = (each for each in look.moment.requests if isinstance(each, OperatorRequest))
    return any(each.verb is Verb.CANCEL for each in requests)


@invariant(Trigger.NEWS)
def accepted_tasks_are_kept(look: Look) -> Iterable[str]:
    """Each accepted task is in its cell's queue, runs there, or has ended."""
    return _unkept(look) if look.world.plant_process.has_stepped else ()


def _unkept(look: Look) -> Iterator[str]:
    tasks, remembered = look.record.tasks, tasks_of(look.world.plant)
    for id in tasks.open:
        if id not in remembered:
            yield f"task {id} has not ended, and is forgotten"
    for name, cell in look.record.cells.items():
        run, queue = cell.run, tasks.queues[name]
        runs = run.task.id if run.task is not None else None
        if runs != tasks.running.get(name):
            yield f"{name} runs {runs}; by what was told it runs {tasks.running.get(name)}"
        if len(run.queue) != len(queue) or (tasks.changes and [each.id for each in run.queue] != list(queue)):
            yield f"{name} has {len(run.queue)} tasks in its queue; by what was told {len(queue)}, or others"
    for change in tasks.changes:
        known = tasks_of(look.world.plant).get(change.message.task)
        recorded = tasks.known(change.message.task)
        if known is not None and recorded is not None and known.state is not recorded.state:
            yield f"task {known.id} is {known.state.value}, and was told to be {recorded.state.value}"
        retried = look.world.plant_process.starts > 1 or look.record.cells[change.message.cell or ""].retries
        if known is not None and not retried and known.attempts != (known.started_at is not None):
            yield f"task {known.id} began at {known.started_at}, and that was attempt {known.attempts}"


@invariant(Trigger.NEWS)
def only_legal_cell_states(look: Look) -> Iterable[str]:
    """A cell changes its state along the rows of its table, by itself, as an operator asked then, or as its
    plant ends.
    """
    return _at_birth(look) if look.record.step.born else _illegal(look)


def _illegal(look: Look) -> Iterator[str]:
    for cell, before, after in look.record.states.transitions:
        if after not in _reachable(before, _causes(look, cell)):
            yield f"{cell.name} went from {before.value} to {after.value}, and nobody asked for that"


def _causes(look: Look, cell: KnownCell) -> frozenset[Cause]:
    """The causes for which a cell may change its state in this step."""
    by_itself = BY_ITSELF | {Cause.AWAY} if look.record.step.away else BY_ITSELF
    if is_ending(look.world.plant):  # a plant that ends in order holds what is at work
        by_itself |= {Cause.HOLD}
    return by_itself.union(*(BY_VERB.get(verb, frozenset()) for verb in _verbs(look, cell)))


def _verbs(look: Look, cell: KnownCell) -> Iterator[Verb]:
    """The verbs done in this step whose scope has the cell, or is no robot and so may be its task."""
    scopes = look.record.scopes
    for answer in look.record.operator_requests.answers:
        if answer.refusal is None and (answer.scope not in scopes or cell.name in scopes.cells(answer.scope)):
            yield answer.verb


def _reachable(before: CellState, causes: frozenset[Cause]) -> set[CellState]:
    reached: set[CellState] = set()
    frontier = {before}
    while frontier:
        rows = ((state, cause, after) for (state, cause), after in ROWS if state in frontier)
        frontier = {after for _, cause, after in rows if cause in causes} - reached
        reached |= frontier
    return reached


def _stopped_alone(look: Look, cell: Cell) -> Iterator[str]:
    """The devices that a cell shares and no stop of another one has stopped."""
    cells_of = look.world.model.cells_of
    for name in cell.shared:
        if not any(_stop_of(look, own) for other in cells_of[name] for own in other.own):
            yield name


def _stop_of(look: Look, name: str) -> StopProgress | None:
    """The stop of a device; to whom nothing is sent, as to a person, it is known from memory alone."""
    known = look.record.robots[name]
    if known.robot.link not in UNSENT:
        return known.stop
    return STOPS.get(look.world.plant_process.found.facts.get(Fact.LATCH, {}).get(name, ""))


def _at_birth(look: Look) -> Iterator[str]:
    """Sentences on cells that start in a wrong state: a stop lasts until clear and reset."""
    for cell in look.record.cells.values():
        stops = {_stop_of(look, name) for name in (*cell.cell.own, *_stopped_alone(look, cell.cell))}
        uncleared, unreset = StopProgress.LATCHED in stops, cell.stopped or any(stops)
        state = CellState.ABORTED if uncleared else CellState.STOPPED if unreset else None
        if state is not None and cell.run.state is not state:
            yield f"{cell.name} starts {cell.run.state.value}; its stop was not over"
        if state is None and cell.run.state not in _first_states(look, cell):
            yield f"{cell.name} starts {cell.run.state.value}; it was not stopped"


def _first_states(look: Look, cell: KnownCell) -> set[CellState]:
    """The states that a cell without a stop may have after the step in which its plant starts.

    It starts at rest. Where its tasks may start by themselves, or somebody asks for something, that step
    goes on from there, as a device may have reported already.
    """
    resting = {CellState.IDLE, CellState.HELD}
    if cell.name in look.record.unattended.cells:
        return resting
    return resting.union(*(_reachable(state, _causes(look, cell)) for state in resting))


@invariant(Trigger.ASKED)
def rejected_input_changes_nothing(look: Look) -> Iterable[str]:
    """A step in which everything asked is refused, and nothing is heard or due, changes nothing."""
    return look.record.differences


@invariant(Trigger.ASKED)
def every_request_is_answered(look: Look) -> Iterable[str]:
    """Each task text and each verb has its answer in the step that takes it in."""
    record, requests = look.record, look.moment.requests
    verbs = sum(isinstance(each, OperatorRequest) for each in requests)
    if verbs != len(record.operator_requests.answers):
        yield f"{verbs} verbs were asked for, {len(record.operator_requests.answers)} answered"
    tokens = [each.request for each in requests if isinstance(each, TaskRequest) and each.request is not None]
    answered = [each.request for each in look.moment.sent if isinstance(each, TaskChanged)]
    if tokens != [token for token in answered if token is not None]:
        yield f"task requests {tokens} were answered as {answered}"


@invariant(Trigger.COMMANDED)
def nothing_moves_after_an_absence(look: Look) -> Iterator[str]:
    """After the plant was away for longer than a robot may be silent, no robot is told to move before an
    operator gets its cell going, or where nothing was under way in it, for a task.
    """
    for command in look.record.unattended.unasked:
        yield f"the plant was away, and by itself sends {shown(command)} to {command.robot}"


@invariant(Trigger.LATE)
def nothing_late_leaves(look: Look) -> Iterator[str]:
    """A decision of the plant that its disk held back for longer than robots wait is not sent any more,
    unless it is a stop.
    """
    for message, late_s in look.moment.late:
        is_stop = isinstance(message, Stop) and message.mode is not StopMode.CLEAR
        if isinstance(message, Command) and not is_stop and late_s > LONGEST_WAIT_S:
            yield f"{message} leaves {late_s:.1f} s after it was decided"


@invariant(Trigger.TOLD)
def no_internal_failure(look: Look) -> Iterable[str]:
    """No task fails, and no cell is held, for a defect of the plant itself."""
    for change in look.record.tasks.changes:
        if change.message.reason is Reason.INTERNAL:
            yield f"task {change.message.task}: {change.message.sentence}"
    for defect in look.record.errors:
        yield f"{defect.cell or 'the plant'} raised {type(defect.error).__name__}: {defect.error}"
    for cell, _, after in look.record.states.transitions:
        trouble = cell.run.trouble
        if after is CellState.HELD and trouble is not None and trouble.reason is Reason.INTERNAL:
            yield f"{cell.name} is held: {trouble.sentence}"


@invariant(Trigger.TOLD)
def no_task_fails_without_a_fault(look: Look) -> Iterable[str]:
    """As long as nothing has gone wrong and no operator has acted, no task fails, but for what its plant file
    asks for and robots cannot do, for a zone in which another arm works for longer than `zone_wait_s`, and,
    of recipes that do not come with Arboleda, for what a recipe may fail by itself: a check, a time that is
    up, an answer.
    """
    world, record = look.world, look.record
    if world.last_fault_at > -math.inf or world.recipes or not record.operator_requests.undisturbed:
        return
    for change in record.tasks.changes:
        if change.message.state is TaskState.FAILED and not _may_fail(look, change.message):
            yield f"task {change.message.task} ({change.message.text}) failed: {change.message.sentence}"


def _may_fail(look: Look, change: TaskChanged) -> bool:
    order = tasks_of(look.world.plant)[change.task].order
    if look.world.model.cell(order.cell).recipe(order.recipe).is_shipped:
        return _cannot_be_done(look, change)
    return change.reason not in ONLY_BY_FAULTS


def _cannot_be_done(look: Look, change: TaskChanged) -> bool:
    """True if the plant file asks for what its robots, as they are simulated, cannot do.

    A virtual board without ids has no piece sensor. A path may begin where the mobile robot is not: the board
    refuses it if the plant may not drive there, or at `state` does not know the place.
    """
    order = tasks_of(look.world.plant)[change.task].order
    cell = look.world.model.cell(order.cell)
    mobile = look.truth.robot(cell.giver.robot.name)
    if change.reason is Reason.ZONE_UNAVAILABLE:
        return any(each.behind_work for each in look.record.cells[order.cell].zone_users.values())
    if change.reason in PIECES and cell.taker.robot.evidence is not Evidence.IDS:
        return True
    led_there = cell.drive_to_start and cell.giver.robot.evidence is not Evidence.STATE
    if led_there or "path" not in order.values or not isinstance(mobile, MobileTruth):
        return False
    return mobile.node != cell.paths[order.values["path"]].nodes[0]


@invariant(Trigger.TOLD)
def sentences_are_for_people(look: Look) -> Iterable[str]:
    """Every sentence for people is one line without a traceback, and a failure always has one."""
    for message in look.moment.sent:
        if isinstance(message, TaskChanged):
            failed = message.reason is not None or message.state is TaskState.REFUSED
            yield from _technical(message.sentence if failed else message.sentence or None)
        elif isinstance(message, OperatorAnswer):
            yield from _technical(message.refusal)


def _technical(sentence: Sentence | None) -> Iterator[str]:
    if sentence is not None and (not sentence or any(word in str(sentence) for word in TECHNICAL)):
        yield f"people are told {sentence!r}"


TASKS = (
    tasks_start_where_all_is_ready,
    each_task_ends_once,
    nothing_of_an_ended_task_moves,
    ended_tasks_stay_ended,
    only_legal_task_states,
    first_come_first_served,
    cancelled_tasks_end_cancelled,
    accepted_tasks_are_kept,
    only_legal_cell_states,
    rejected_input_changes_nothing,
    every_request_is_answered,
    nothing_moves_after_an_absence,
    nothing_late_leaves,
    no_internal_failure,
    no_task_fails_without_a_fault,
    sentences_are_for_people,
)
