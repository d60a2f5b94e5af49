"""Verbs of the operator: carries each out, or refuses it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial, reduce

from arboleda.dispatch.belief import ONLY_DRAWN
from arboleda.dispatch.dispatcher import Dispatcher, was_broken_off
from arboleda.dispatch.ledger import Entry, State
from arboleda.dispatch.zones import NONE, Zones
from arboleda.model.commands import Home, Question
from arboleda.model.common_places import with_common_places
from arboleda.model.errors import ArboledaError, IllegalTransition
from arboleda.model.messages import (
    Fact,
    Failure,
    Journal,
    OperatorAnswer,
    OperatorRequest,
    Outcome,
    Reason,
    TaskState,
    Verb,
)
from arboleda.model.outside import quoted
from arboleda.model.plant_model import Evidence, Link, PlantModel
from arboleda.model.recipe import known
from arboleda.model.sentence import Phrase, Sentence, Value
from arboleda.model.verbs import Arguments, Scope, as_text, lasting

from . import losses, reasons
from .acts import ENDED, Acts, OperatorAct, outcome_of
from .advice import AND, DO, OR, sentence
from .cell import NOT_YET, CellRun
from .cell_states import Cause, CellState
from .intake import Intake
from .readiness import STILL_DOING
from .teaching import NOT_TAUGHT, OTHER_TEACHES, ZONE_OF_OTHER, Teaching


class VerbRefusal(ArboledaError):
    """A verb that changes nothing now; the sentence says why and what is possible."""


PLANT = Phrase("scope.plant", "plant")
DID = Phrase("did.verb", "{verb}")
DID_BY_HAND = Phrase("did.by_hand", "{verb} by hand")  # only read, in journals
DECLARED_HOMED = Phrase("did.declared_homed", "home {scope} by hand")
DECLARED_EMPTY = Phrase("did.declared_empty", "release {scope} by hand: the part was taken out")
DID_BY_CLIENT = Phrase("did.by_client", "{verb} by its client")
NO_TASK = Phrase(
    "refusal.no_task",
    "there is no task {task}; open tasks: {open}; cells and robots of this plant: {known}",
)
AND_MORE = Phrase("and_more", "{first} and {more} more")
NO_SCOPE = Phrase(
    "refusal.no_scope", "{scope} is neither a cell nor a robot of this plant; there are {known}"
)
STILL_WORKS = Phrase(
    "refusal.still_works",
    "{robot} has not given up its work in {zone}; stop {cell}, then override {zone}",
)
STILL_USES = Phrase(
    "refusal.still_uses",
    "{cell} has not given up its work with {device}; stop {cell}, then override {device}",
)
GOES_BACK = Phrase(
    "refusal.goes_back",
    "{device} stays with {cell} until it is heard, holds no part and is at home; "
    "then it is free without an override",
)
WITH_OTHER = Phrase("refusal.with_other", "{device}, which cells share, is with {cell} now")
NOT_HELD = Phrase("refusal.device_not_held", "no cell holds {device} now; say which one, {cells}")
STAYS_STOPPED = Phrase(
    "refusal.stays_stopped", "{device} stays stopped while {cells} is; clear {cells} first"
)
STOPS_SHARED = Phrase(
    "did.stops_shared", "{did}; {devices}, shared with {cells}, stops too and stays so until reset {scope}"
)
NO_STATION = Phrase("refusal.no_station", "{station} is not a station of {cell}")
STATION_EMPTY = Phrase("refusal.station_empty", "no part is known to be in station {station} of {cell}")
NO_PLACE = Phrase("refusal.no_place", "{place} is no place of {cell}; there are {known}")
NO_PLACES = Phrase("refusal.no_places", "{cell} has no places for parts; its plant file names none")
PLACE_EMPTY = Phrase("refusal.place_empty", "no part is known to be at {place} of {cell}")
PARTS_OF_PLACE = Phrase("refusal.parts_of_place", "{place} of {cell} holds 1 to {most} parts, not {parts}")
RACK_EMPTY = Phrase("refusal.rack_empty", "no part is known to be in the rack of {cell}")
TASK_ENDED = Phrase("refusal.task_ended", "task {task} has ended already ({state})")
TASK_STATES = {state: Phrase(f"task_state.{state.value}", state.value) for state in TaskState}
MAY_CROSS = Phrase(
    "refusal.may_cross",
    "{arm} may cross zone {zone}, which {holder} holds; home it once the zone is free",
)
SAYS_ITSELF = Phrase(
    "refusal.says_itself", "{robot} says itself whether it is homed; home {robot} runs its routine"
)
SAYS_UNHOMED = Phrase(
    "refusal.says_unhomed", "{robot} says that it is not homed; home {robot} runs its routine"
)
SAYS_UNHOMED_BY_HAND = Phrase(
    "refusal.says_unhomed_by_hand",
    "{robot} says that it is not homed; home {robot} at its own controls first",
)
NO_HOMING = Phrase("refusal.no_homing", "{robot} has no homing")
CANNOT_REPORT = Phrase(
    "refusal.cannot_report",
    "{robot} cannot report a homing; put it at its reference and say: home {robot} --by-hand",
)
ONLY_ABORTED = Phrase("refusal.only_aborted", "{cell} is {state}; only an aborted cell can be cleared")
NOT_STILL = Phrase("refusal.not_still", "{robots} is not still yet")
QUEUE_RUNS = Phrase("refusal.queue_runs", "{cell} is idle and its queue runs")
ONLY_HELD = Phrase(
    "refusal.only_held", "{cell} is {state}; only a held cell or a paused queue can be resumed"
)
RELEASING = Phrase("doing.release", "letting go on the operator's word")
NOT_OPENED = Phrase("refusal.not_opened", "{why}: it cannot let go")
HOLD_FIRST = Phrase("refusal.hold_first", "{cell} is {state}; hold or stop it first")
NO_EFFECTOR = Phrase("refusal.no_effector", "{robot} has no effector")
CLEAR_FIRST = Phrase("refusal.clear_first", "{cell} is not cleared after its stop yet; clear {cell} first")
NOT_STOPPED = Phrase(
    "refusal.not_stopped", "{cell} is {state}; a cell is reset after a stop, once it has been cleared"
)
NOT_AT_WORK = Phrase("refusal.not_at_work", "{cell} is {state}; only a cell at work can be held")
OTHER_STATE = Phrase("refusal.other_state", "{cell} is {state}; this needs a cell that is {allowed}")
NO_FAULT = Phrase("refusal.no_fault", "{cell} is held without a fault; resume {cell} goes on")
RELEASE_FIRST = Phrase("refusal.release_first", "{arm} may hold a part; release {arm} first")
RELEASE_ALL_FIRST = Phrase("refusal.release_all_first", "{devices} may each hold a part; {releases} first")
HOLDS_NOTHING = Phrase("refusal.holds_nothing", "no part is known to be in {devices}")
HOLDS_NOTHING_ANY_MORE = Phrase(
    "refusal.holds_nothing_any_more",
    "no part is known to be in {devices}, so nothing has to be said of it; go on with {next}",
)
NO_PERSON = Phrase("refusal.no_person", "{person} is no person of this plant; people: {known}")
NOT_ASKED = Phrase("refusal.not_asked", "nobody asks {person} anything now")
NO_ANSWER = Phrase("refusal.no_answer", "{word} is no answer to what {person} is asked; answers: {known}")
OTHER_QUESTION = Phrase(
    "refusal.other_question", "question {question} to {person} is over; now it is asked: {text}"
)
QUESTION_OVER = Phrase(
    "refusal.question_over", "question {question} to {person} is over; nobody asks {person} anything now"
)
NO_ARGUMENT = Phrase("refusal.no_argument", "{verb} takes no argument {argument}")
NOT_AT_REST = Phrase(
    "refusal.not_at_rest",
    "{cell} is {state}; only a cell that is idle, or held without a task, can be taught",
)
NO_TEACHER = Phrase("refusal.no_teacher", "say who teaches {cell}, in 1 to {most} letters")
TEACHING_ENDED = Phrase("teach.ended", "teaching of {cell} by {teacher} ended: {why}")
NO_RUNNING_TASK = Phrase("refusal.no_running_task", "{cell} has no running task")

BROKE = Phrase("act.broke", "{cell} failed on an internal error meanwhile; the log has its details")
LONGEST_NAME = 40
SHOWN = 10  # tasks that a sentence names


class Operator:
    """Carries out verbs wherever in their scope they can be done; refuses those that can be done nowhere."""

    def __init__(
        self,
        cells: dict[str, CellRun],
        dispatcher: Dispatcher,
        zones: Zones,
        intake: Intake,
        clock: Callable[[], float],
        broke: Callable[[str, Exception], None],
    ) -> None:
        self._broke = broke
        self._cells = cells
        self._dispatcher = dispatcher
        self._zones = zones
        self._intake = intake
        self._clock = clock
        self._scopes = scopes(dispatcher.model)
        cells_of = dispatcher.model.cells_of.items()
        self._alone = {name: cells[found[0].name] for name, found in cells_of if len(found) == 1}
        for cell in cells.values():
            cell.manual.when_over = partial(self._teaching_over, cell)
        self.acts = Acts()
        self._sent: list[Entry] = []  # the commands of the act that is being done
        self._defects: list[Sentence] = []  # what broke in it
        reached = [robot for cell in cells.values() for robot in cell.cell.reached]
        self._reached = {robot.name for robot in reached}
        self._homing = {robot.name for robot in reached if robot.homes}

    def act(self, request: OperatorRequest) -> OperatorAct:
        """Do it and journal it; VerbRefusal says why nothing was done."""
        scope = scope_of(request)
        do = self._planned(request, scope)
        self._sent, self._defects = [], []
        do()
        outcome, why = self._at_once(request.verb)
        act = OperatorAct(
            number=self.acts.next_number,
            at=self._clock(),
            verb=request.verb,
            scope=scope,
            arguments=arguments_of(request),
            cell=self._cell_of(request, scope),
            sentence=self._with_shared(request.verb, scope, _did(request, scope)),
            outcome=outcome,
            why=why,
            ended_at=self._clock() if outcome is Outcome.FAILED else None,
        )
        self.acts.add(act, self._sent)
        self._journal(act, act.sentence)
        if outcome is Outcome.FAILED:
            self._journal(act, act.ended, outcome)
        return act

    def _at_once(self, verb: Verb) -> tuple[Outcome, Sentence | None]:
        """The outcome of an act in the step in which it is asked."""
        if self._defects:
            return Outcome.FAILED, self._defects[0]
        return (Outcome.SENT, None) if verb.row.stops else outcome_of(self._sent)

    def look(self) -> bool:
        """Journal what has become of acts that devices carry out; whether one has ended."""
        news = False
        for act, entries in self.acts.ended(self._clock()):
            self._journal(act, act.ended, act.outcome)
            self._learn(act.verb, entries)
            news = True
        return news

    def _learn(self, verb: Verb, entries: Sequence[Entry]) -> None:
        """Note acts that devices could not do: they are advised after other ways, until they succeed."""
        for entry in entries:
            tried = (verb, entry.command.robot)
            if entry.state is State.DONE:
                self._cells[entry.cell].in_vain.discard(tried)
            elif not was_broken_off(entry):
                self._cells[entry.cell].in_vain.add(tried)

    def _journal(self, act: OperatorAct, sentence: Sentence, outcome: Outcome | None = None) -> None:
        entry = Journal(
            verb=act.verb,
            scope=act.scope,
            arguments=act.arguments,
            cell=act.cell,
            sentence=sentence,
            outcome=outcome,
        )
        self._dispatcher.outbox.append(entry)

    def refusal(self, request: OperatorRequest) -> Sentence | None:
        """Why a request would be refused now; None where it would be done."""
        try:
            self._planned(request, scope_of(request))
        except VerbRefusal as refused:
            return refused.sentence
        return None

    def _planned(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """The function that carries out the request; VerbRefusal where something speaks against it."""
        if request.arguments:
            _require_its_own(request)
        procedure = TABLE[request.verb]
        if procedure.plan is not None:
            return procedure.plan(self, request, scope)
        return self._planned_in_cells(procedure, self._robots(scope), self._cells_in(request.verb, scope))

    def _planned_cancelling(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Of one task, or of those that run in a scope."""
        if scope.lstrip("#") in self._intake.tasks:
            return self._planned_cancel(scope.lstrip("#"), _cancelled_by(request))
        scope = self._known_scope(scope)
        cells = self._cells_in(request.verb, scope)
        return self._planned_in_cells(TABLE[request.verb], self._robots(scope), cells)

    def _planned_release(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        robots, cells = self._robots(scope), self._cells_in(request.verb, scope)
        if request.by_hand:
            return self._planned_emptying(robots, cells)
        return self._planned_in_cells(TABLE[request.verb], robots, cells)

    def _cells_in(self, verb: Verb, scope: str) -> list[CellRun]:
        """The cells of a scope; what is no matter of all that share a device is one of who holds it."""
        if scope in self._cells:
            return [self._cells[scope]]
        cells = self._of_robots(self._robots(scope))
        if scope not in self._dispatcher.model.shared or verb.row.of_all_who_share:
            return cells
        holder = self._zones.holder(scope)
        if holder is None and verb is Verb.RELEASE:
            return [cell for cell in cells if cell.context.devices.answers_for(scope)]
        if holder is None:
            raise VerbRefusal(NOT_HELD(device=scope, cells=tuple(cell.cell.name for cell in cells)))
        return [cell for cell in cells if cell.cell.name == holder]

    def _with_shared(self, verb: Verb, scope: str, did: Sentence) -> Sentence:
        """The sentence about an act, and that the stop of one cell stopped what it shares with others."""
        cell = self._cells.get(scope) if verb.row.stops else None
        if cell is None or not cell.cell.shared:
            return did
        cells_of = self._dispatcher.model.cells_of
        others = {other.name: None for name in cell.cell.shared for other in cells_of[name]}
        others.pop(scope)
        return STOPS_SHARED(did=did, devices=cell.cell.shared, cells=tuple(others), scope=scope)

    def _planned_in_cells(self, row: Procedure, robots: set[str], cells: list[CellRun]) -> Callable[[], None]:
        refusals = {}
        for cell in cells:
            if (why := row.check(self, cell, robots)) is not None:
                refusals[cell.cell.name] = why
        firm = [cell.cell.name for cell in cells if cell.state in row.must_all and cell.cell.name in refusals]
        if firm or len(refusals) == len(cells):
            raise VerbRefusal(refusals[firm[0]] if firm else next(iter(refusals.values())))
        able = [cell for cell in cells if cell.cell.name not in refusals]
        acts = [row.do] if row.first is None else [row.first, row.do]
        return partial(self._do_in, able, acts, robots)

    def _of_robots(self, robots: set[str]) -> list[CellRun]:
        """Their cells in the order of the file; one cell, as screens ask about it, comes without a search."""
        cells_of = self._dispatcher.model.cells_of
        names = {cell.name for robot in robots for cell in cells_of[robot]}
        if len(names) == 1:
            return [self._cells[names.pop()]]
        return [cell for name, cell in self._cells.items() if name in names]

    def _do_in(self, cells: list[CellRun], acts: list[Do], robots: set[str]) -> None:
        for act in acts:
            for cell in cells:
                self._do(act, cell, robots)

    def _do(self, act: Do, cell: CellRun, robots: set[str]) -> None:
        """Do it in one cell; what that raises must not keep the others from a stop."""
        try:
            act(self, cell, robots)
        except (VerbRefusal, IllegalTransition):
            raise
        except Exception as error:  # noqa: BLE001 - whatever it is, it ends the work of this cell, not the plant
            self._defects.append(BROKE(cell=cell.cell.name))
            self._broke(cell.cell.name, error)

    def _cell_of(self, request: OperatorRequest, scope: str) -> str | None:
        """The one cell that a request is for; None where it is for more."""
        task = self._intake.tasks.get(scope.lstrip("#")) if Scope.TASK in request.verb.row.scopes else None
        if task is not None:
            return task.order.cell
        name = scope.lower()
        cells = self._dispatcher.model.cells_of.get(name, ())
        return name if name in self._cells else cells[0].name if len(cells) == 1 else None

    def _known_scope(self, scope: str) -> str:
        """The plant, a cell or a robot, where it could be a task; VerbRefusal names the tasks there are."""
        name, names = scope.lower(), self._dispatcher.beliefs
        if name in ("", "plant") or name in self._cells or name in names:
            return name
        known = (*self._cells, *names)
        raise VerbRefusal(NO_TASK(task=quoted(scope), open=self._open_tasks(), known=known))

    def _open_tasks(self) -> Value:
        """The ids of as many as a sentence can name."""
        ids = tuple(id for id, task in self._intake.tasks.items() if task.ended_at is None)
        if len(ids) > SHOWN:
            return AND_MORE(first=ids[:SHOWN], more=len(ids) - SHOWN)
        return ids or NONE()

    def _robots(self, scope: str) -> set[str]:
        """The robots of a scope: the plant, a cell, or one robot."""
        robots = self._scopes.get(scope)
        if robots is None:
            raise VerbRefusal(NO_SCOPE(scope=quoted(scope), known=(*self._cells, *self._dispatcher.beliefs)))
        return set(robots)

    def _planned_override(self, request: OperatorRequest, zone: str) -> Callable[[], None]:
        holder = self._zones.holder(zone)
        cell = self._cells.get(holder or "")
        if cell is not None and cell.tree is not None and self._zones.is_quarantined(zone):
            raise VerbRefusal(STILL_USES(cell=cell.cell.name, device=zone))
        if cell is not None and zone in cell.cell.shared and not self._is_left_anywhere(zone):
            raise VerbRefusal(GOES_BACK(device=zone, cell=cell.cell.name))
        known = self._dispatcher.model.cell_of  # without who is no longer in the plant file
        if holder in known and self._zones.is_quarantined(zone) and self._works(holder):
            name = self.in_charge(holder).cell.name  # what it does there counts on the zone
            raise VerbRefusal(STILL_WORKS(robot=holder, zone=zone, cell=name))
        try:
            self._zones.require_quarantined(zone)
        except IllegalTransition as error:
            raise VerbRefusal(error.sentence) from error
        return partial(self._override, zone)

    def _override(self, zone: str) -> None:
        granted = self._zones.override(zone)
        self._dispatcher.memory.vacate([zone])
        self._dispatcher.wake({*granted, *self._zones.robbed})

    def _is_left_anywhere(self, device: str) -> bool:
        """True for a shared device that goes nowhere and holds no part, so that any cell may have it next."""
        robot = self._dispatcher.model.robots[device]
        return not robot.goes and robot.held_fact is None

    def in_charge(self, robot: str) -> CellRun:
        """The cell of a robot; of a shared one that which holds it, else the first that does not work."""
        if (alone := self._alone.get(robot)) is not None:
            return alone
        runs = [self._cells[cell.name] for cell in self._dispatcher.model.cells_of[robot]]
        idle = [run for run in runs if run.state is CellState.IDLE]
        return next((run for run in runs if run.context.devices.holds(robot)), (idle or runs)[0])

    def _works(self, arm: str) -> bool:
        """True where a tree counts on what an arm has, or the arm moves without one: homing needs none."""
        cell = self.in_charge(arm)
        moves = any(entry.is_work for entry in self._dispatcher.ledger.of_robot(arm))
        return moves or cell.tree is not None

    def _planned_unloading(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Of one place or station; without either, of all places and the whole rack of each cell."""
        robots, station, place = self._robots(scope), request.argument("station"), request.argument("place")
        cells = [cell for cell in self._with_books(scope) if robots & set(cell.cell.holders)]
        if place is not None:
            name = str(place).lower()
            cell = _with_place(cells, _whole(scope), name)
            return self._planned_removal([(cell, [name])], PLACE_EMPTY(place=name, cell=cell.cell.name))
        if station is None:
            every = [(cell, [*cell.context.places.counts]) for cell in cells]
            return self._planned_removal(every, RACK_EMPTY(cell=_whole(scope)))
        racks = [(cell, dict[Value, str](enumerate(cell.cell.station_targets))) for cell in cells]
        found = [(cell, [rack[station]]) for cell, rack in racks if station in rack]
        if not found:
            raise VerbRefusal(NO_STATION(station=quoted(str(station)), cell=_whole(scope)))
        return self._planned_removal(found, STATION_EMPTY(station=station, cell=_whole(scope)))

    def _planned_removal(
        self, places: list[tuple[CellRun, list[str]]], refusal: Sentence
    ) -> Callable[[], None]:
        """Of these places; VerbRefusal where all are empty."""
        full = [cell.context.places.full.intersection(names) for cell, names in places]
        if not any(full):
            raise VerbRefusal(refusal)
        return partial(self._set_parts, [(cell, dict.fromkeys(names, 0)) for cell, names in places])

    def _planned_loading(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Of one place of a cell: with so many parts, else with all that it holds."""
        place, parts = str(request.argument("place") or "").lower(), request.argument("parts")
        cell = _with_place(self._with_books(scope), _whole(scope), place)
        most = next(each.holds for each in cell.cell.counted if each.target == place)
        number = most if parts is None else parts
        if isinstance(number, str) or not 1 <= number <= most:
            amount = quoted(number) if isinstance(number, str) else number
            raise VerbRefusal(PARTS_OF_PLACE(place=place, cell=cell.cell.name, most=most, parts=amount))
        return partial(self._set_parts, [(cell, {place: number})])

    def _with_books(self, scope: str) -> list[CellRun]:
        """The cells whose places a scope means: of a cell its own alone, whatever it shares with others."""
        robots = self._robots(scope)
        return [self._cells[scope]] if scope in self._cells else self._of_robots(robots)

    def _set_parts(self, parts: list[tuple[CellRun, dict[str, int]]]) -> None:
        numbers_by_cell = {cell.cell.name: numbers for cell, numbers in parts}
        everywhere = with_common_places(numbers_by_cell, [cell.cell for cell in self._cells.values()])
        for name, numbers in everywhere.items():
            self._cells[name].set_parts(numbers)
        self._dispatcher.wake([*everywhere])

    def _planned_answer(self, request: OperatorRequest, person: str) -> Callable[[], None]:
        """One of the answers to what is being asked; where it names a question, only to that one."""
        id, word = request.argument("question"), str(request.argument("answer") or "")
        people = [name for name, robot in self._dispatcher.model.robots.items() if robot.link is Link.SCREEN]
        if person not in people:
            raise VerbRefusal(NO_PERSON(person=quoted(person), known=tuple(people) or NONE()))
        entry = self._dispatcher.question(person)
        if entry is None and id is not None:
            raise VerbRefusal(QUESTION_OVER(question=id, person=person))
        if entry is None:
            raise VerbRefusal(NOT_ASKED(person=person))
        assert isinstance(entry.command, Question)
        if id not in (None, entry.command.id):
            raise VerbRefusal(OTHER_QUESTION(question=str(id), person=person, text=entry.command.text))
        answer = known(word, entry.command.answers)
        if answer is None:
            raise VerbRefusal(NO_ANSWER(word=quoted(word), person=person, known=entry.command.answers))
        return partial(self._answer, person, answer)

    def _answer(self, person: str, answer: str) -> None:
        self._dispatcher.answer(person, answer, self._clock())

    def _planned_cancel(self, id: str, failure: Failure) -> Callable[[], None]:
        task = self._intake.tasks[id]
        cell = self._cells[task.order.cell]
        if task.state is TaskState.QUEUED:
            return partial(cell.drop, task, failure)
        if task is not cell.task:
            raise VerbRefusal(TASK_ENDED(task=id, state=TASK_STATES[task.state]()))
        if why := _not_cancellable(self, cell, set()):
            raise VerbRefusal(why)
        return partial(cell.cancel, failure)

    def _planned_emptying(self, robots: set[str], cells: list[CellRun]) -> Callable[[], None]:
        """A person has taken out what devices hold; all of them are still, as far as the plant moves them."""
        for cell in cells:
            if cell.state in AT_WORK:
                raise VerbRefusal(HOLD_FIRST(cell=cell.cell.name, state=cell.state.sentence))
        able = [(cell, name) for cell in cells for name in self._holders(cell, robots)]
        if not able:
            raise VerbRefusal(self._none_able(robots, sorted(robots)[0]))
        holding = [(cell, name) for cell, name in able if name in cell.context.parts.holding]
        if not holding:
            raise VerbRefusal(_nothing_held(able))
        for cell, name in holding:
            if (entry := cell.context.commands.first_of(name)) is not None:
                raise VerbRefusal(STILL_DOING(robot=name, doing=entry.doing))
        return partial(self._empty, holding)

    def _holders(self, cell: CellRun, robots: set[str]) -> list[str]:
        """Those of the robots that hold parts for this cell; what it shares may be with another one."""
        found = [name for name in cell.cell.holders if name in robots]
        return [*filter(cell.context.devices.answers_for, found)] if cell.cell.shared else found

    def _none_able(self, robots: set[str], first: str) -> Sentence:
        """Why nothing can be released: nothing holds parts, or what does is with another cell."""
        for device in sorted(robots.intersection(self._dispatcher.model.shared)):
            holder = self._zones.holder(device)
            if holder is not None and self._dispatcher.model.robots[device].held_fact is not None:
                return WITH_OTHER(device=device, cell=holder)
        return NO_EFFECTOR(robot=first)

    def _empty(self, holding: list[tuple[CellRun, str]]) -> None:
        for cell, name in holding:
            losses.let_go(cell, name)
            self._dispatcher.effectors.declare_empty(self._dispatcher.beliefs[name])
            self._dispatcher.wake([name])

    def _planned_homing(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Robots that are only drawn, or have no homing, are left out; one of them alone is refused."""
        robots, by_hand = self._robots(scope), request.by_hand
        if scope in self._cells and self._cells[scope].cell.shared:
            robots = self._here(scope, robots)
        robots = self._homing & robots or robots
        for name in sorted(robots):
            obstacle = self._not_homeable(name, by_hand=by_hand)
            if obstacle:
                raise VerbRefusal(obstacle)
        if not by_hand and (occupied := self.not_free_for_homing(robots)):
            raise VerbRefusal(occupied)
        return partial(self._home, robots, by_hand=by_hand)

    def _here(self, scope: str, robots: set[str]) -> set[str]:
        """The robots that are homed with a cell: none of those that another one has now."""
        shared = self._cells[scope].cell.shared
        found = {name for name in robots if name not in shared or self._zones.holder(name) in (None, scope)}
        if self._homing.isdisjoint(found) and (others := sorted(self._homing & robots)):
            raise VerbRefusal(WITH_OTHER(device=others[0], cell=self._zones.holder(others[0]) or ""))
        return found

    def _home(self, robots: set[str], *, by_hand: bool) -> None:
        for name in sorted(robots):
            if by_hand:
                self._dispatcher.declare_homed(name)
                self._uproot(name)
            else:
                self._sent.append(self.home(name))

    def home(self, name: str) -> Entry:
        """Have a robot run its homing routine; it keeps everybody out of its zones meanwhile."""
        cell = self.in_charge(name)
        if not self._dispatcher.beliefs[name].is_cleared_by_homing:
            losses.uproot(cell, name)
        users = [run for run in self._of_robots({name}) if name in run.cell.zone_users]
        for run in (each for each in users if each.state in AT_REST):
            run.context.zones.forsake()
        if name in cell.cell.shared:
            cell.context.devices.claim(name)
        for run in users:
            run.context.zones.claim(name)
        return self._dispatcher.home(name, cell.cell.name, self._clock())

    def _uproot(self, name: str) -> None:
        losses.uproot(self.in_charge(name), name)

    def not_free_for_homing(self, robots: set[str]) -> Sentence | None:
        """Why robots may not set out for their reference: from where they stand they may cross any zone."""
        taken: dict[str, str] = {}
        for cell in self._of_robots(robots):
            for name, space in cell.cell.workspaces.items():
                for zone in sorted(space.zones) if name in robots else ():
                    for_task = cell.state in AT_REST and cell.context.zones.is_for_task(zone)
                    kept = None if for_task else self._zones.holder(zone)
                    holder = kept or taken.setdefault(zone, name)
                    if holder != name:
                        return MAY_CROSS(arm=name, zone=zone, holder=holder)
        return None

    def _planned_teaching(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Of one cell that rests, by one person, while nobody else is where its robots may get."""
        cells = self._cells_in(request.verb, scope)
        teacher = str(request.argument("teacher") or "").strip()
        cell = cells[0]
        if len(cells) > 1 or scope not in self._cells:
            raise VerbRefusal(NO_SCOPE(scope=quoted(scope), known=(*self._cells,)))
        if not 0 < len(teacher) <= LONGEST_NAME or not teacher.isprintable():
            raise VerbRefusal(NO_TEACHER(cell=scope, most=LONGEST_NAME))
        if (refusal := self._not_teachable(cell)) is not None:
            raise VerbRefusal(refusal)
        return partial(self._teach, cell, teacher)

    def _not_teachable(self, cell: CellRun) -> Sentence | None:
        name, rests = cell.cell.name, cell.state in AT_REST and cell.task is None
        if cell.manual.teaching is not None:
            return OTHER_TEACHES(cell=name, teacher=cell.manual.teaching.teacher)
        if cell.closed:
            return reasons.ENDING()
        if not rests:
            return NOT_AT_REST(cell=name, state=cell.state.sentence)
        if (busy := cell.readiness.busy()) is not None:
            return busy
        for robot in (each for each in cell.cell.reached if each.goes and each.name in cell.cell.own):
            obstacle = self._dispatcher.beliefs[robot.name].unreachable()
            if obstacle is not None:
                return obstacle.sentence
            if self._dispatcher.beliefs[robot.name].moves:
                return NOT_STILL(robots=(robot.name,))
        return self._zone_of_other(cell)

    def _zone_of_other(self, cell: CellRun) -> Sentence | None:
        """Refusal where a robot of another cell is, or may be, where robots of this one may get."""
        for robot in filter(cell.context.devices.has, cell.cell.zone_users):
            for zone, holder in cell.context.zones.taken_by_others(robot).items():
                if holder not in cell.cell.own and not cell.context.zones.is_for_task(zone):
                    return ZONE_OF_OTHER(robot=robot, zone=zone, holder=holder)
        return None

    def _teach(self, cell: CellRun, teacher: str) -> None:
        cell.context.zones.forsake()
        self._dispatcher.memory.remember(Fact.MANUAL, cell.cell.name, teacher)
        cell.manual.begin(Teaching(cell.context, session=self.acts.next_number, teacher=teacher))

    def _teaching_over(self, cell: CellRun, teaching: Teaching, why: Sentence) -> None:
        """Forget who taught a cell; what no operator has asked for is journalled here."""
        name = cell.cell.name
        self._dispatcher.memory.remember(Fact.MANUAL, name, None)
        if why is not BY_VERB:
            sentence = TEACHING_ENDED(cell=name, teacher=teaching.teacher, why=why)
            entry = Journal(verb=Verb.AUTOMATIC, scope=name, cell=name, sentence=sentence)
            self._dispatcher.outbox.append(entry)

    def _not_homeable(self, name: str, *, by_hand: bool) -> Sentence | None:
        cell = self._alone.get(name) or self.in_charge(name)
        belief = self._dispatcher.beliefs[name]
        if refusal := _at_rest(self, cell, set()):
            return refusal
        if cell.manual.teaching is not None and not by_hand:
            return cell.manual.teaching.sentence
        if name in cell.cell.shared and (stopped := cell.context.devices.not_reset(name)) is not None:
            return stopped.sentence
        if name not in self._reached:
            return ONLY_DRAWN(robot=name)
        if not belief.robot.homes:
            return NO_HOMING(robot=name)
        if work := self._dispatcher.work_of(name):
            return STILL_DOING(robot=name, doing=work.doing)
        robot, has_routine = belief.robot, belief.robot.evidence is Evidence.IDS
        if by_hand and robot.says_homed:
            return SAYS_ITSELF(robot=name)
        if belief.says_unhomed and (by_hand or not has_routine):
            return SAYS_UNHOMED(robot=name) if has_routine else SAYS_UNHOMED_BY_HAND(robot=name)
        if by_hand:
            return None
        if not has_routine:
            return CANNOT_REPORT(robot=name)
        obstacle = self._dispatcher.objection(partial(Home, robot=name))
        return obstacle.sentence if obstacle else None

    def _latch(self, cell: CellRun, robots: set[str]) -> None:
        for robot in cell.cell.robots:
            if robot.name in robots:
                self._dispatcher.latch(robot.name)

    def _not_clearable(self, cell: CellRun, robots: set[str]) -> Sentence | None:
        if cell.state not in (CellState.ABORTED, CellState.CLEARING):
            return ONLY_ABORTED(cell=cell.cell.name, state=cell.state.sentence)
        others = self._kept_stopped(cell, robots)
        if others and others.keys() >= {each.name for each in cell.cell.robots if each.name in robots}:
            device, cells = next(iter(others.items()))
            return STAYS_STOPPED(device=device, cells=cells)
        finishes = self._dispatcher.finishes
        mine = [each.name for each in cell.cell.robots if each.name in robots and not finishes(each.name)]
        beliefs = [self._dispatcher.beliefs[name] for name in mine]
        moving = tuple(belief.robot.name for belief in beliefs if belief.online and not belief.still)
        return NOT_STILL(robots=moving) if moving else None

    def _clear(self, cell: CellRun, robots: set[str]) -> None:
        kept = self._kept_stopped(cell, robots.union(cell.cell.shared))
        was_stopped = cell.context.devices.is_stopped  # also if it was cleared: that may have got lost
        unstopped = {name for name in cell.cell.shared if not was_stopped(name)}
        for robot in cell.cell.robots:
            if robot.name in robots - unstopped and robot.name not in kept:
                self._dispatcher.unlatch(robot.name)
        stopped = self._dispatcher.latched - kept.keys()
        if not any(robot.name in stopped for robot in cell.cell.robots):
            cell.become(Cause.CLEAR)

    def _kept_stopped(self, cell: CellRun, robots: set[str]) -> dict[str, tuple[str, ...]]:
        """Those of the robots that stay stopped when they are cleared in a cell, and for which cells: whoever
        shares them was stopped, too, and is not cleared with them.
        """
        kept, stopped = {}, self._dispatcher.latched - robots
        for name in cell.cell.shared:
            cells = [each for each in self._dispatcher.model.cells_of[name] if stopped & {*each.own}]
            others = tuple(each.name for each in cells if self._cells[each.name].state in STOPPING)
            if name in robots and name in self._dispatcher.latched and others:
                kept[name] = others
        return kept

    def _reset(self, cell: CellRun, robots: set[str]) -> None:
        for robot in cell.cell.robots:
            others = [each for each in self._dispatcher.model.cells_of[robot.name] if each is not cell.cell]
            if not any(self._cells[other.name].state in UNTIL_RESET for other in others):
                self._dispatcher.forget_stop(robot.name)
        cell.become(Cause.RESET)
        cell.become(Cause.READY)

    def _not_resumable(self, cell: CellRun, robots: set[str]) -> Sentence | None:
        if cell.manual.teaching is not None:
            return cell.manual.teaching.sentence
        if cell.state is CellState.IDLE:
            return None if cell.queue.paused else QUEUE_RUNS(cell=cell.cell.name)
        if cell.state is not CellState.HELD:
            return ONLY_HELD(cell=cell.cell.name, state=cell.state.sentence)
        if cell.task is None or cell.trouble is not None or cell.stranded:
            return reasons.of_hold(cell)
        return _not_yet(cell)

    def _not_releasable(self, cell: CellRun, robots: set[str]) -> Sentence | None:
        if cell.state in AT_WORK:
            return HOLD_FIRST(cell=cell.cell.name, state=cell.state.sentence)
        if cell.manual.teaching is not None:
            return cell.manual.teaching.sentence
        able = self._holders(cell, robots)
        if not able:
            first = next(each.name for each in cell.cell.robots if each.name in robots)
            return self._none_able(robots, first)
        found = (self._dispatcher.obstacle_to_opening(name) for name in able)
        obstacle = next((each for each in found if each), None)
        return NOT_OPENED(why=obstacle.sentence) if obstacle else None

    def _release(self, cell: CellRun, robots: set[str]) -> None:
        for name in self._holders(cell, robots):
            if name in cell.cell.shared:
                cell.context.devices.claim(name)
            losses.let_go(cell, name)
            make = self._dispatcher.model.robots[name].let_go
            now, name_of_cell = self._clock(), cell.cell.name
            self._sent.append(self._dispatcher.send(make, name_of_cell, RELEASING(), now, by_hand=True))


def scopes(model: PlantModel) -> dict[str, frozenset[str]]:
    """Names of the robots of each scope there is: the plant, a cell, one robot."""
    robots = {name: frozenset([name]) for name in model.robots}
    cells = {cell.name: frozenset(robot.name for robot in cell.robots) for cell in model.cells}
    return robots | cells | dict.fromkeys(("", "plant"), frozenset(model.robots))


def scope_of(request: OperatorRequest | OperatorAnswer) -> str:
    """Whom or what a request names; only task ids tell capitals apart."""
    scope = request.scope.strip()
    return scope if Scope.TASK in request.verb.row.scopes else scope.lower()


def arguments_of(request: OperatorRequest) -> Arguments:
    """The arguments of a request, in the letters in which they are shown."""
    return tuple((name, each.lower() if isinstance(each, str) else each) for name, each in request.arguments)


def _require_its_own(request: OperatorRequest) -> None:
    """VerbRefusal where a verb is told what it does not take."""
    takes = [each.name for each in request.verb.arguments]
    for name, _ in request.arguments:
        if name not in takes:
            raise VerbRefusal(NO_ARGUMENT(verb=request.verb.value, argument=quoted(name)))


def _did(request: OperatorRequest, scope: str) -> Sentence:
    """The sentence about the act of an operator, or of a task's own client."""
    scope = as_text(request.verb, scope, lasting(request.verb, arguments_of(request)))
    declared = TABLE[request.verb].declared
    if request.by_hand and declared is not None:
        return declared(scope=_whole(scope))
    did = DID_BY_CLIENT if request.client else DID
    return did(verb=DO[request.verb](scope=_whole(scope)))


def _whole(scope: str) -> Value:
    return scope or PLANT()


def _with_place(cells: list[CellRun], scope: Value, place: str) -> CellRun:
    """The cell with that place; VerbRefusal names the places that there are."""
    known = tuple(name for cell in cells for name in cell.context.places.counts)
    if not known:
        raise VerbRefusal(NO_PLACES(cell=scope))
    if place not in known:
        raise VerbRefusal(NO_PLACE(place=quoted(place), cell=scope, known=known))
    return next(cell for cell in cells if place in cell.context.places.counts)


def _always(operator: Operator, cell: CellRun, robots: set[str]) -> Sentence | None:
    return None


def _in(*states: CellState) -> Callable[[Operator, CellRun, set[str]], Sentence | None]:
    first, *others = (state.sentence for state in states)
    allowed = reduce(lambda before, other: OR(first=before, second=other), others, first)

    def check(operator: Operator, cell: CellRun, robots: set[str]) -> Sentence | None:
        if cell.state in states:
            return None
        return OTHER_STATE(cell=cell.cell.name, state=cell.state.sentence, allowed=allowed)

    return check


_held, _at_rest = _in(CellState.HELD), _in(CellState.IDLE, CellState.HELD)
_begun = _in(CellState.EXECUTE, CellState.HELD)


def _not_resettable(operator: Operator, cell: CellRun, robots: set[str]) -> Sentence | None:
    if cell.state is CellState.STOPPED:
        return None
    if cell.state in STOPPING:
        return CLEAR_FIRST(cell=cell.cell.name)
    return NOT_STOPPED(cell=cell.cell.name, state=cell.state.sentence)


def _not_holdable(operator: Operator, cell: CellRun, robots: set[str]) -> Sentence | None:
    if cell.state is CellState.EXECUTE:
        return None
    return NOT_AT_WORK(cell=cell.cell.name, state=cell.state.sentence)


def _not_retryable(operator: Operator, cell: CellRun, robots: set[str]) -> Sentence | None:
    if cell.manual.teaching is not None:
        return cell.manual.teaching.sentence
    refusal = _held(operator, cell, robots)
    if refusal is None and cell.stranded:
        return reasons.of_hold(cell)
    if refusal is None and cell.task is not None and cell.trouble is None:
        return NO_FAULT(cell=cell.cell.name)
    return refusal or _not_yet(cell)


def _not_yet(cell: CellRun) -> Sentence | None:
    """That a task of an earlier start cannot be judged yet."""
    return None if cell.awaits is None else NOT_YET(cell=cell.cell.name, why=cell.awaits)


def _not_taught(operator: Operator, cell: CellRun, robots: set[str]) -> Sentence | None:
    return NOT_TAUGHT(cell=cell.cell.name) if cell.manual.teaching is None else None


def _not_abandonable(operator: Operator, cell: CellRun, robots: set[str]) -> Sentence | None:
    if cell.manual.teaching is not None:
        return cell.manual.teaching.sentence
    refusal = _held(operator, cell, robots)
    if refusal is None and cell.task is None and (holding := cell.context.parts.holding):
        return _release_first(holding)
    return refusal


def _nothing_held(able: list[tuple[CellRun, str]]) -> Sentence:
    """That no part is known to be in devices, and what leads on where they keep a cell waiting."""
    devices = tuple(dict.fromkeys(name for _, name in able))
    ways = [each for cell, _ in able[:1] for each in cell.ways_out(cell.cell.name)]
    return (
        HOLDS_NOTHING_ANY_MORE(devices=devices, next=sentence(ways))
        if ways
        else HOLDS_NOTHING(devices=devices)
    )


def _release_first(holding: list[str]) -> Sentence:
    """That parts are to be released first, by everybody that may hold one."""
    if len(holding) == 1:
        return RELEASE_FIRST(arm=holding[0])
    releases = [DO[Verb.RELEASE](scope=robot) for robot in holding]
    all_releases = reduce(lambda first, second: AND(first=first, second=second), releases)
    return RELEASE_ALL_FIRST(devices=tuple(holding), releases=all_releases)


def _not_cancellable(operator: Operator, cell: CellRun, robots: set[str]) -> Sentence | None:
    if cell.task is None:
        return NO_RUNNING_TASK(cell=cell.cell.name)
    return _begun(operator, cell, robots)


BY_VERB = Phrase("teach.by_verb", "by the operator")()
BY_OPERATOR = Phrase("task.cancelled_by_operator", "cancelled by the operator")
BY_CLIENT = Phrase("task.cancelled_by_client", "cancelled by the client")
PUT_TO_WORK = Phrase("act.put_to_work", "version {number} was put to work by {by}: {changes}")
RESTART_WANTED = Phrase("act.restart_wanted", "{by} has the plant restart once all its cells rest")
RESTART_UNWANTED = Phrase("act.restart_unwanted", "{by} does not have the plant restart any more")
ACTS_TOLD = {
    phrase.key: phrase
    for phrase in (
        PUT_TO_WORK,
        RESTART_WANTED,
        RESTART_UNWANTED,
        *DO.values(),
        *ENDED.values(),
        DECLARED_HOMED,
        DECLARED_EMPTY,
        PLANT,
        DID,
        DID_BY_HAND,
        DID_BY_CLIENT,
        TEACHING_ENDED,
    )
}
"""All that is said of what operators did, by key."""
CANCELLED_BY_OPERATOR = Failure(reason=Reason.CANCELLED, sentence=BY_OPERATOR())
CANCELLED_BY_CLIENT = Failure(reason=Reason.CANCELLED, sentence=BY_CLIENT())


def _cancelled_by(request: OperatorRequest) -> Failure:
    return CANCELLED_BY_CLIENT if request.client else CANCELLED_BY_OPERATOR


STOPPING = (CellState.ABORTING, CellState.ABORTED)
UNTIL_RESET = (*STOPPING, CellState.CLEARING, CellState.STOPPED)
AT_REST = (CellState.IDLE, CellState.HELD)
AT_WORK = (CellState.EXECUTE, CellState.HOLDING, CellState.ABORTING)
Check = Callable[[Operator, CellRun, "set[str]"], "Sentence | None"]
Do = Callable[[Operator, CellRun, "set[str]"], None]
Plan = Callable[[Operator, OperatorRequest, str], Callable[[], None]]


def _nothing(operator: Operator, cell: CellRun, robots: set[str]) -> None:
    """Leave the cell to what is planned for all the scope."""


@dataclass(frozen=True, kw_only=True)
class Procedure:
    """Procedure of a verb: in each cell that `check` has nothing against, `do`.

    `first` is done in all cells before `do` in any: no robot's stop waits for what ends in other cells. A
    cell in a state of `must_all` that cannot follow keeps the verb from all the scope; others are left out.
    `plan` is for a verb that is done otherwise than cell by cell. `declared` tells what was done by hand.
    """

    check: Check = _always
    do: Do = _nothing
    first: Do | None = None
    must_all: tuple[CellState, ...] = ()
    plan: Plan | None = None
    declared: Phrase | None = None


TABLE: dict[Verb, Procedure] = {
    Verb.STOP: Procedure(first=Operator._latch, do=lambda operator, cell, robots: cell.stop()),
    Verb.CLEAR: Procedure(
        check=Operator._not_clearable,
        do=Operator._clear,
        must_all=(CellState.ABORTING, CellState.ABORTED, CellState.CLEARING),
    ),
    Verb.RESET: Procedure(check=_not_resettable, do=Operator._reset, must_all=(CellState.CLEARING,)),
    Verb.HOLD: Procedure(check=_not_holdable, do=lambda operator, cell, robots: cell.hold()),
    Verb.RESUME: Procedure(check=Operator._not_resumable, do=lambda operator, cell, robots: cell.resume()),
    Verb.CANCEL: Procedure(
        check=_not_cancellable,
        do=lambda operator, cell, robots: cell.cancel(CANCELLED_BY_OPERATOR),
        plan=Operator._planned_cancelling,
    ),
    Verb.RETRY: Procedure(check=_not_retryable, do=lambda operator, cell, robots: cell.retry()),
    Verb.ABANDON: Procedure(check=_not_abandonable, do=lambda operator, cell, robots: cell.abandon()),
    Verb.RELEASE: Procedure(
        check=Operator._not_releasable,
        do=Operator._release,
        plan=Operator._planned_release,
        declared=DECLARED_EMPTY,
    ),
    Verb.HOME: Procedure(plan=Operator._planned_homing, declared=DECLARED_HOMED),
    Verb.OVERRIDE: Procedure(plan=Operator._planned_override),
    Verb.UNLOAD: Procedure(plan=Operator._planned_unloading),
    Verb.LOAD: Procedure(plan=Operator._planned_loading),
    Verb.ANSWER: Procedure(plan=Operator._planned_answer),
    Verb.TEACH: Procedure(plan=Operator._planned_teaching),
    Verb.AUTOMATIC: Procedure(check=_not_taught, do=lambda operator, cell, robots: cell.manual.end(BY_VERB)),
}
