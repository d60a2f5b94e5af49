"""Stage: one task on a simulated plant of its own, from the plant's first second to rest."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from hashlib import blake2b

from arboleda.engine import CellRun, Entry, Plant
from arboleda.engine.inspection import EMPTY, ledger_of, places_of, tasks_of
from arboleda.model.advice import Hand, in_words
from arboleda.model.cell_states import CellState
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.model.plant_model import Link, PlantModel
from arboleda.recipes import Order
from arboleda.rig.hands import HANDS
from arboleda.rig.world import PLANT
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.invariants.part_places import recipes_end_as_they_say
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld
from arboleda_proofs.simulator.people import STANDS_BY_S, Attendant, FixedAnswers
from arboleda_proofs.simulator.run import NO_EXCEPTION
from arboleda_proofs.simulator.truth.refused_commands import RefusedCommands

from .end_state import EndState, differences, end_state, facts_by_report, stated
from .outcome import IS_DONE, End, Outcome, Run, with_acts
from .scenario import Scenario, alone
from .standstill import Standstill

ASKED_AT_S = 2.0  # when somebody asks for the task: everybody is connected by then
ENDS_AS_SAID = recipes_end_as_they_say.name  # which the simulator asks of calm runs, and of places
REQUEST, AGAIN = "test-1", "test-2"  # as the first ones of a test
PATIENCE_S = 300.0  # beyond what the task takes without a fault
LOST_S = 30.0  # after which a request that nobody has answered is lost
MENDED_IN_S = 0.000_5  # after a task has ended, so that a test that names the time does the same
HEARD_S = 1.0  # after which each board has reported what is truly so, now that nothing is at fault
GRACE_S = 30.0  # in which a cell gets ready by itself
TRIES = 3  # times that it may go on by itself, and be held again
STUCK = (CellState.HELD, CellState.ABORTED, CellState.STOPPED)
ENDS = {
    TaskState.DONE: End.DONE,
    TaskState.FAILED: End.FAILED,
    TaskState.CANCELLED: End.CANCELLED,
    TaskState.REFUSED: End.REFUSED,
}


class Rejoined(Exception):
    """Raised where a run is again as the calm one: `run` is that."""

    def __init__(self, run: Run) -> None:
        super().__init__("as without a fault")
        self.run = run


class Stage:
    """Stage: a task in its plant; `play` has something begin at its time, and returns what came of it.
    `go_to` comes close to such a time, from which forks of this process `play` on.

    `state` is what was so when the task was done, `answers` what devices had answered, `stated` what its
    recipe says of both; `commands` are those that its cell has given by then. `lacks` is the place at which
    it was to take a part and had none. `new_questions` are those of the last step to persons.
    `on_its_way` is called after each step until the task has ended. `waits`: it goes on for its whole time
    also where it is known that nothing happens any more.
    """

    def __init__(
        self,
        model: PlantModel,
        scenario: Scenario,
        *,
        keep: bool = False,
        make_plant: Callable[..., Plant] | None = None,
        waits: bool = False,
    ) -> None:
        self.watched = JudgedWorld(alone(model, scenario.cell), keep=keep, make_plant=make_plant)
        self.world = self.watched.world
        self._standstill = None if waits else Standstill(self.watched)
        self.cell = model.cell(scenario.cell)
        self.state: EndState = {}
        self.answers: EndState = {}
        self.stated: EndState = {}
        self.reported: EndState = {}  # of that, by then, by the plant
        self.commands: list[str] = []
        self.new_questions: list[Entry] = []
        self._people = [robot.name for robot in self.cell.robots if robot.link is Link.SCREEN]
        self._ended: dict[bool, Counter[str]] = {True: Counter(), False: Counter()}  # commands done, and not
        self._refused_commands = RefusedCommands()
        self._questions: set[str] = set()  # by id, of all that persons were asked so far
        self.last_change: TaskChanged | None = None  # the last word on the task
        self.mended_at = 0.0  # when the fault was ended, s
        self.on_its_way: Callable[[], None] = lambda: None
        self.began, self._lost_from = False, 0.0
        self._asked_at = 0.0  # by the time awake; 0: not yet
        self._turn = 0  # of what is to begin
        self.lacks: str | None = None
        self._scenario, self._request = scenario, REQUEST
        self._attendant: Attendant | None = None
        self._acts: tuple[str, ...] | None = None  # of the attendant, when the cell was ready first
        self._order: Order | None = None  # what the plant made of it
        FixedAnswers(self.world, dict(scenario.answers))
        self.world.watchers.append(self._look)

    @property
    def run(self) -> CellRun:
        """The cell as the plant that runs now has it."""
        return self.world.plant.cells[self.cell.name]

    @property
    def ended(self) -> bool:
        """True once the task has ended."""
        return self.last_change is not None and self.last_change.state in ENDS

    def play(
        self,
        at: float,
        begin: Callable[[], None],
        *,
        expected: EndState,
        commands: tuple[str, ...] | None,
        lasts_s: float,
    ) -> Run:
        """Have something begin `at` s, and judge the run to its end; `lasts_s`: the task without that."""
        outcome, attended_at = Outcome(end=End.UNFINISHED, alone=False), 0.0
        try:
            self.go_to(at)
            self.world.at(self.watched.start + at, lambda _: self._begin(begin), turn=self._turn)
            self._work(lasts_s + PATIENCE_S)
            outcome, attended_at = self._outcome(expected, commands), self.watched.seconds
            self._attendant = Attendant(self.world, seed=0, round_s=STANDS_BY_S)
            self.watched.come_to_rest(self._stands_still)
            self.watched.look_around()
            outcome = outcome if outcome.alone else with_acts(outcome, self._acts)
        except Rejoined as rejoined:
            digest = _hashed(self.watched.trace.digest, rejoined.run.digest)
            return replace(rejoined.run, digest=digest, joined_at=self.watched.seconds)
        except BrokenInvariant as broken:
            outcome = _broken(outcome, broken)
        except Exception as error:  # noqa: BLE001 - that none escapes is one of the invariants
            outcome = _broken(outcome, BrokenInvariant(NO_EXCEPTION, f"{type(error).__name__}: {error}"))
        seconds = self.watched.seconds
        return Run(
            outcome=outcome,
            digest=self.watched.trace.digest,
            mended_at=self.mended_at or seconds,
            attended_at=attended_at or seconds,
            seconds=seconds,
        )

    def go_to(self, at: float) -> None:
        """Have the task asked for once all are connected, and go on up to the last step before `at` s."""
        if not self._asked_at:
            self.world.advance(ASKED_AT_S)
            self._ask()
            self._asked_at, self._turn = self.world.awake_s, next(self.world.turns)
        self.world.advance(math.inf, lambda: self.world.next_deadline >= self.watched.start + at)

    def _ask(self) -> None:
        """Ask for the task, once people have brought what it needs."""
        for place in self._scenario.brought:
            HANDS[Hand.PUT_IN](self.world, f"{self.cell.name} {place}")
            self.world.settle()
        self.world.request_task(self._scenario.task, self._request)
        self.world.settle()

    def again(self, lasts_s: float) -> str:
        """Failure of the same task once more, after a calm run of `lasts_s`: empty where it is done."""
        self.last_change, self._request = None, AGAIN
        try:
            self._ask()
            self.world.advance(lasts_s + PATIENCE_S, lambda: self.ended or self._is_stuck)
        except BrokenInvariant as broken:
            return f"breaks {broken}"
        change = self.last_change
        if change is None or change.state is TaskState.DONE:
            return "" if change else "nobody takes it"
        return f"{change.state.value}: {change.sentence}"

    @property
    def done(self) -> object:
        """All that was commanded and done so far, and the last word on the task."""
        ended = {done: dict(each) for done, each in self._ended.items()}
        return tuple(self.commands), ended, None if self.last_change is None else self.last_change.state

    def befall(self, faults: Sequence[Fault]) -> None:
        """Have the first of these faults begin now, the others at their time if the task is at work then."""
        self.watched.begin(faults[0])
        for fault in faults[1:]:
            self.world.at(self.watched.start + fault.at, self._begin_another, fault)

    def _begin_another(self, fault: Fault) -> None:
        if not self.ended and not self.mended_at:
            self.watched.begin(fault)

    def _begin(self, begin: Callable[[], None]) -> None:
        self.began, self._lost_from = True, self.world.now + LOST_S
        begin()

    def _work(self, at_most_s: float) -> None:
        """Let the plant work for so long, until the task has ended or waits for a person; then mend what is
        at fault, and give the cell time to get ready.
        """
        since = self._asked_at
        for _ in range(TRIES):
            self.world.advance(at_most_s, self._is_over, since=since)
            self.world.advance(MENDED_IN_S)
            self.mended_at = self.watched.seconds
            self.watched.end_faults()
            self.world.advance(HEARD_S)
            self.world.advance(GRACE_S, lambda: self._is_ready() or self._stands_still())
            if self.ended or self._is_stuck:
                return
            since = self.world.awake_s

    def _is_over(self) -> bool:
        lost = self.last_change is None and self.world.now >= self._lost_from
        self.on_its_way()
        return self.began and (self.ended or self._is_stuck or lost)

    @property
    def _is_stuck(self) -> bool:
        return self.run.state in STUCK and not self.run.absence.hold

    def _stands_still(self) -> bool:
        return self._standstill is not None and self._standstill.lasts

    def _is_ready(self) -> bool:
        run = self.run
        idle = run.state is CellState.IDLE and run.task is None and not run.queue
        return idle and self.world.is_on(PLANT) and run.not_ready is None

    def _outcome(self, expected: EndState, commands: tuple[str, ...] | None) -> Outcome:
        end, cause = self._end_and_cause()
        if end is End.DONE and commands is not None and tuple(self.commands) != commands:
            end = End.RECOVERED
        untrue = differences(expected, self.state, self.reported) if end in IS_DONE else ()
        untrue += tuple(self._left_out(commands or ())) if end in IS_DONE else ()
        broken = self._false_end() if end in IS_DONE else None
        return Outcome(end=end, cause=cause, alone=self._is_ready(), untrue=untrue, broken=broken)

    def _left_out(self, commands: Sequence[str]) -> Iterator[str]:
        """Sentences on commands of the run without a fault that failed, or could not be given, and were not
        done as often as there; of a plant that died nobody knows them all.
        """
        if self.world.plant_process.starts == 1:
            done, failed = self._ended[True], self._ended[False]
            wanted = Counter(commands).items()
            left_out = (each for each, times in wanted if failed[each] and done[each] < times)
            yield from (f"{each} has failed, and was not done later" for each in left_out)

    def _false_end(self) -> tuple[str, str] | None:
        """The breach of a task that is done, and not as its recipe says; none where a board has lied."""
        found = {**self.state, **self.answers}
        false = () if self.world.deceptions else differences(self.stated, found, self.reported)
        return (
            (ENDS_AS_SAID, f"{self._scenario.task} is called done, but {'; '.join(false)}") if false else None
        )

    def _end_and_cause(self) -> tuple[End, str]:
        change, run = self.last_change, self.run
        if change is not None and change.state in ENDS:
            return ENDS[
                change.state
            ], change.reason.value if change.reason and change.state in _FAILED else ""
        if run.state in STUCK and (change is not None or run.task is not None):
            return End.HELD, run.trouble.reason.value if run.trouble else run.state.value
        return (End.LOST if change is None and run.task is None else End.UNFINISHED), ""

    def _look(self) -> None:
        self._count_ended()
        entries = ledger_of(self.world.plant).entries
        for message in self.world.moment.sent:
            if isinstance(message, TaskChanged):
                self._follow(message)
            elif (entry := entries.get(getattr(message, "id", ""))) and entry.cell == self.cell.name:
                self.commands.append(entry_name(entry))
        self.new_questions = list(self._fresh_questions())
        self.commands += map(entry_name, self.new_questions)
        if (
            self.world.plant_process.starts > 1
            and self.last_change is not None
            and not self.ended
            and self.world.is_on(PLANT)
        ):
            self._look_up(self.last_change)
        if self._attendant is not None and self._acts is None and self._is_ready():
            self._acts = tuple(str(in_words(each)) for each in self._attendant.acts[self.cell.name])

    def _count_ended(self) -> None:
        """Count the commands of the task that are done, have failed, or could not even be given."""
        ended = [(each.entry, each.done) for each in self.watched.truth.books.ended]
        ended += [(entry, False) for entry in self._refused_commands.fresh(self.world.plant)]
        for entry, done in ended:
            if entry.cell == self.cell.name and not self.ended:
                self._ended[done][entry_name(entry)] += 1

    def _fresh_questions(self) -> Iterator[Entry]:
        """The questions that persons see since this step: those are sent to nobody else."""
        for name in self._people:
            entry = ledger_of(self.world.plant).question(name)
            if entry is not None and entry.cell == self.cell.name and entry.command.id not in self._questions:
                self._questions.add(entry.command.id)
                yield entry

    def _look_up(self, change: TaskChanged) -> None:
        """Take the end of the task from what was kept, as a plant that died says no word on it any more."""
        kept = self.world.disk.ended(change.task)
        if kept is not None:
            reason = kept.failure.reason if kept.failure else None
            self._follow(replace(change, state=kept.state, reason=reason))

    def _follow(self, change: TaskChanged) -> None:
        mine = change.request == self._request or (
            self.last_change is not None and change.task == self.last_change.task
        )
        if not mine or self.ended:
            return
        self.last_change = change
        task = tasks_of(self.world.plant).get(change.task)
        self._order = self._order or (task.order if task is not None else None)
        trouble = places_of(self.run).asked.trouble
        if change.state is TaskState.FAILED and trouble is not None and trouble.key == EMPTY.key:
            self.lacks = str(trouble.values["place"])
        if change.state is TaskState.DONE and (order := self._order) is not None:
            self.state = end_state(self.watched, self.cell)
            self.reported = facts_by_report(self.watched, self.cell)
            self.answers = self.watched.truth.last_answers.since(-math.inf, self.cell.name)
            found = {**self.state, **self.answers}
            self.stated = stated(self.cell, order.recipe, order.values, found)


def _broken(outcome: Outcome, broken: BrokenInvariant) -> Outcome:
    return replace(outcome, broken=(broken.invariant, broken.sentence))


def _hashed(*digests: str) -> str:
    return blake2b("".join(digests).encode(), digest_size=16).hexdigest()


def entry_name(entry: Entry) -> str:
    """The name of a command, for people: its robot and what that does then."""
    return f"{entry.command.robot}: {entry.doing}"


_FAILED = (TaskState.FAILED, TaskState.CANCELLED, TaskState.REFUSED)
