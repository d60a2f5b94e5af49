"""Record of all that was said and done in a world so far, kept apart from the plant's own books."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

from arboleda.drivers import Command, Stop, StopMode
from arboleda.engine import Plant, State
from arboleda.engine.inspection import beliefs_of, ledger_of
from arboleda.model.by_class import nearest
from arboleda.model.cell_states import CellState
from arboleda.model.messages import (
    CellRevised,
    Fact,
    InternalError,
    OperatorAnswer,
    OperatorRequest,
    Remember,
    SystemStart,
    TaskChanged,
    TaskRequest,
    TaskState,
    Verb,
)
from arboleda.rig.world import World

from .recorded.acts import Acts
from .recorded.boards import Boards
from .recorded.bridge import Bridges
from .recorded.cells import CellStates, KnownCell
from .recorded.checked import Checked
from .recorded.choices import Choices
from .recorded.commands import Commands, SentCommand
from .recorded.courses import Courses
from .recorded.foreign import ForeignCommands
from .recorded.heard import Heard
from .recorded.kept_facts import KeptFacts
from .recorded.lateness import Lateness
from .recorded.operator_requests import OperatorRequests
from .recorded.operator_stops import OperatorStops
from .recorded.plant_step import PlantStep
from .recorded.proofs import Proofs
from .recorded.refusals import differences
from .recorded.robots import KnownRobot, Obstacle
from .recorded.scopes import Scopes
from .recorded.starts import Starts
from .recorded.stops import EarlyStops
from .recorded.tasks import Tasks
from .recorded.teachers import Teachers
from .recorded.time_line import TimeLine
from .recorded.times import Times
from .recorded.trails import Trails
from .recorded.trees import Trees
from .recorded.unattended import GETS_GOING, Unattended
from .recorded.verbs import EarlierState
from .recorded.waiting import Waiting

GIVEN_UP = (State.FAILED, State.CANCELLED)
NO_OBSTACLES: frozenset[Obstacle] = frozenset()


class Record:
    """Follows requests, commands, reports and tasks step by step; each part follows one of these.

    `errors` are those of this step. `differences` are what changed in a step in which everything asked for
    was refused and nothing was heard.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        model, plant = world.model, world.plant
        stale_after_s = model.timing.stale_after_s
        self.robots = {name: KnownRobot(robot, stale_after_s) for name, robot in model.robots.items()}
        self.cells = {cell.name: KnownCell(cell, model.timing) for cell in model.cells}
        self.scopes = Scopes(model)
        self.step = PlantStep(at=plant.now)
        self.operator_requests = OperatorRequests(self.scopes)
        self.acts = Acts()
        self.stops = OperatorStops(model, self.scopes, self.robots, self.cells)
        self.unattended = Unattended(model, self.scopes)
        self.teachers = Teachers()
        self.heard = Heard(model, self.robots, self.cells)
        self.lateness = Lateness(world)
        self.commands = Commands(self.cells)
        self.proofs = Proofs()
        self.states = CellStates(self.cells.values())
        self.waiting = Waiting(self.cells)
        self.tasks = Tasks(self.cells)
        self.courses = Courses(plant)
        self.choices = Choices(self.robots, self.courses)
        self.before_requests = EarlierState()
        self.facts = KeptFacts()
        self.starts = Starts(model)
        self.trails = Trails(self.robots)
        self.trees = Trees(world, self.starts)
        self.times = Times(plant.now)
        self.bridges = Bridges(model)
        self.others = ForeignCommands()
        self.early_stops = EarlyStops()
        self.boards = Boards(world)
        self.time_line = TimeLine()
        self.checked = Checked()
        self.errors: list[InternalError] = []
        self.differences: list[str] = []
        self._cuts = world.disk.cuts
        self._begin(plant)
        self._take_over(plant)
        world.before_asking.append(lambda: self.before_requests.look(self.cells.values(), self.tasks, world))
        world.before_asking.append(lambda: self.choices.look(world))

    def look(self) -> None:
        """Take in what happened in this step; called before any invariant."""
        moment, plant = self.world.moment, self.world.plant
        is_other = plant is not self._plant
        if self.heard.anew:
            self.heard.anew = []
        if self.world.versions:
            self._revise(moment.sent)
        if self._has_news:
            self._clear_news()
        self._look_at_starts()
        if moment.published:
            self.boards.tell(self.world.now, moment.published)
        if moment.delivered or moment.executed:
            self.boards.look(moment, self.world.broker.clients)
        if moment.bridged:
            self.bridges.look(moment.bridged)
            self.others.look(moment.bridged, self.bridges.of_others)
        if moment.taken:
            self.early_stops.look(moment.taken, plant.epoch)
        for message, late_s in moment.late:
            self.commands.left_late(message, late_s)
        self.lateness.look()
        acted = moment.sent or moment.reports or moment.requests
        if acted or plant.now != self.step.at or is_other:
            self._look_at_plant(plant)
        elif self.step.stepped:
            self.step.pass_by()

    def _look_at_starts(self) -> None:
        """Take in what the plant says, its last words too, and what boards carry out."""
        moment, starts = self.world.moment, self.starts
        if starts.wrong or starts.twice:
            starts.clear_news()
        if moment.last_words or moment.unkept:
            starts.hear((*moment.last_words, *moment.unkept))
        if self.world.plant is not self._plant:
            starts.take_stock()
        if moment.sent:
            starts.hear(moment.sent)
        for board, goal in moment.executed:
            starts.carries_out(board, goal)

    def _revise(self, sent: Iterable[object]) -> None:
        """Know of each cell the version that it works by, and of all that the last start has."""
        revised = {each.cell: each.version.digest for each in sent if isinstance(each, CellRevised)}
        for name, known in self.cells.items():
            if name in revised:
                known.revise(self.world.model.cell(name), self.world.versions[revised[name]].timing)
            elif self.world.plant is not self._plant:
                known.revise(self.world.model.cell(name), self.world.model.timing)

    def _begin(self, plant: Plant) -> None:
        """Begin with a plant that starts: it knows nothing but what it had to keep."""
        self._plant, self._version = plant, -1
        self._has_begun, self._has_news = not self.step.born, False
        self.step.at = plant.now
        found = self.world.plant_process.found
        self.tasks.restart(found.tasks.values() if self.step.born else (), plant.now)
        self.commands.forget()
        self.proofs.forget()
        cuts, self._cuts = self._cuts, self.world.disk.cuts
        self.starts.restart(undone=cuts != self._cuts)
        self.trees.begin()
        self.time_line.begin()
        self.teachers.restart()
        displaced, boots = found.facts.get(Fact.DISPLACED, {}), found.facts.get(Fact.BOOT, {})
        for name, robot in self.robots.items():
            robot.forget()
            robot.displaced = name in displaced
            robot.boot = int(boots[name]) if name in boots else None
        for name, cell in self.cells.items():
            cell.begin(plant.cells[name])
        self.trails.restart(found.facts, self.tasks.running)

    def _take_over(self, plant: Plant) -> None:
        """Take over the plant's beliefs, this once: reports from before this record began."""
        beliefs = beliefs_of(plant)
        self.bridges.take_over(self.world.bridge, self.world.now, beliefs)
        self.boards.take_over(self.world.now, beliefs)
        for name, known in self.robots.items():
            known.take_over(beliefs[name])

    def _look_at_plant(self, plant: Plant) -> None:
        moment, step = self.world.moment, self.step
        step.stepped = self.world.plant_process.has_stepped
        step.born = plant is not self._plant
        if step.born:
            self._take_last_words()
            self.times.restart(step.at, plant.now)
            self._begin(plant)
            self.courses.begin(self.tasks.running.values())
            self.unattended.begin_start(plant.now, self.cells.values(), self.tasks)
            self.lateness.expect_old()
        step.begins = step.stepped and not self._has_begun
        self._has_begun = self._has_begun or step.stepped
        self.heard.begin_step()
        step.away = not step.born and plant.now - step.at > plant.away_after_s
        if step.away:
            self.unattended.begin_absence(self.cells.values())
            for cell in self.cells.values():
                if cell.cell.goes_on_after_absence:  # it goes on by itself, as after a retry
                    self._retried(cell.name)
        if self.proofs.of:
            self.proofs.of.clear()
        if moment.reports:
            self.heard.hear(moment, self.commands, self.proofs)
        if moment.requests:
            self.operator_requests.hear(moment.requests)
        if moment.requests or self.teachers.taught or self.teachers.was:
            self.teachers.look(moment.requests, moment.sent)
        self.facts.begin_step()
        self._take(moment.sent)
        self._compare(plant)
        self.courses.look(plant)
        step.at = plant.now
        if self.acts.of:
            faults, last = self.world.faults_active, self.world.last_fault_at
            self.acts.look(self.cells, last_fault_at=last, faults=faults)

    def _take(self, messages: Iterable[Any]) -> None:
        for message in messages:
            take = taker(message.__class__)
            if take is not None:
                take(self, message)

    def _take_last_words(self) -> None:
        """Take in what a plant said in the step in which it died, of which the rest is unknown."""
        words = self.world.moment.last_words
        requests = self.operator_requests.hear_last(words)
        self._take(words)
        for request in requests:  # its effects may be kept, though nobody was told
            if request.verb is Verb.RETRY:
                self._retried(request.scope)
            elif request.verb is Verb.CANCEL:
                self.tasks.may_be_cancelled(request.scope, self.scopes.cells(request.scope))
        sent = {each.command.id: each.command for each in self.commands.new}
        if sent:
            self.commands.follow(ledger_of(self._plant), self._plant.now)
        for cell in self.cells.values() if sent else ():
            self.trees.look_into(cell, sent)
        self._clear_news()
        self.facts.restore(self.world.plant_process.found.facts)
        kept = self.facts.now.get(Fact.LATCH, {})
        self.stops.find(kept, self.operator_requests.unanswered)
        if words:
            self.stops.take_over(kept)
            for each in self.commands.open.values():
                if each.entry is not None and each.entry.state in GIVEN_UP:
                    self.starts.gave_up(each.command.id)

    def _clear_news(self) -> None:
        self.commands.clear_news()
        self.unattended.clear_news()
        self.tasks.clear_news()
        self.operator_requests.answers.clear()
        self.errors.clear()
        self.states.transitions.clear()
        self.differences.clear()
        self._has_news = self.step.has_spoken = False

    def _compare(self, plant: Plant) -> None:
        """Take over what the plant's books say after this step."""
        moved = self._compare_commands(plant)
        has_requests = bool(self.world.moment.requests)
        if has_requests:
            self.differences += differences(self)
            self.operator_requests.end_step()
        if self.world.model.zones:
            self.waiting.look(plant, self.commands, plant.now - self.step.at)
        changed = self.states.look()
        self._look_at_trails()
        if changed or self.step.born:
            self.times.look(self.cells.values(), plant.now)
            self.states.look_for_idle()
        tasks, answers = self.tasks, self.operator_requests.answers
        late = self.commands.soonest <= plant.now
        news = moved or has_requests or changed or late or self.step.born or bool(tasks.changes)
        spoken = tasks.changes or tasks.refused or answers or self.states.transitions
        self.step.has_spoken = bool(spoken or self.errors)
        self.step.unnumbered = (changed or bool(tasks.changes)) and plant.version == self._version
        self._version = plant.version
        self.step.news = news or self.trees.is_due(plant.now)
        if self.step.news:
            self._has_news = True
            self.trees.look(self.cells.values(), plant.now, self.commands.new, away=self.step.away)

    def _compare_commands(self, plant: Plant) -> bool:
        """Take over what became of commands; True if anything did."""
        commands = self.commands
        moved = commands.follow(ledger_of(plant), plant.now)
        for sent, _ in commands.moved:
            cell = self.cells[sent.entry.cell] if sent.entry is not None else None
            if sent.state is State.DONE and cell is not None and cell.run.state is CellState.EXECUTE:
                self.starts.went_on(sent.command.id)
            elif sent.state in GIVEN_UP:
                self.starts.gave_up(sent.command.id)
        if moved:
            self.proofs.follow(list(commands.open.values()))
            self.heard.follow(commands, beliefs_of(plant))
        return moved

    def _look_at_trails(self) -> None:
        answers = self.operator_requests.answers
        if self.trails.found or self.trails.wrong:
            retried = Verb.RETRY in [each.verb for each in answers]
            self.trails.look(self.cells, self.states.transitions, retried=retried)
        if answers:
            self.trails.keep(self.world.moment.sent, self.cells, self.commands)

    def _on_command(self, command: Command) -> None:
        known, now, moment = self.robots[command.robot], self._plant.now, self.world.moment
        verbs = self.operator_requests.done(command.robot, moment.sent)
        self.unattended.judge(command, self.operator_requests, homes_at_start=known.robot.home_at_start)
        if isinstance(command, Stop):
            obstacles = NO_OBSTACLES
            verbs |= self.stops.missed(command, known, verbs, now)
        else:
            since = min((event.at for event in moment.requests), default=now)
            obstacles = self.heard.obstacles(known, since, self._plant.epoch)
        timing = self.cells[self.world.model.cell_of[command.robot].name].timing
        self.commands.take(SentCommand(command, now, obstacles, verbs, known.halts, timing), known)
        if isinstance(command, Stop) and command.mode is StopMode.CLEAR:
            self.stops.clear(known)

    def _on_task(self, change: TaskChanged) -> None:
        requests = (each for each in self.world.moment.requests if isinstance(each, TaskRequest))
        again = change.request is not None or any(each.request is None for each in requests)
        self.tasks.take(change, self._plant.now, is_repeated=again)
        if change.state is TaskState.QUEUED:
            self.unattended.give_task(change.cell or "")

    def _on_answer(self, answer: OperatorAnswer) -> None:
        request = self.operator_requests.take(answer)
        self.acts.take(request, self._acted_on(request), is_refused=answer.refusal is not None)
        if answer.refusal is not None:
            return
        if answer.verb in GETS_GOING:
            self.unattended.attend(answer.scope)
        done = DONE.get(answer.verb)
        if done is not None:
            done(self, answer.scope)
        if request.verb is Verb.HOME and request.by_hand:
            self.heard.put_right(self.scopes.robots(answer.scope), beliefs_of(self._plant))

    def _acted_on(self, request: OperatorRequest) -> list[KnownCell]:
        """The cells that a request is to lead on; an answer is for the one cell that asks."""
        cells = [self.cells[name] for name in self.scopes.cells(request.scope)]
        return [] if request.verb is Verb.ANSWER and len(cells) > 1 else cells

    def _on_error(self, error: InternalError) -> None:
        self.errors.append(error)
        self._has_news = True

    def _again(self, scope: str) -> None:
        for name in self.scopes.cells(scope):
            self.cells[name].again += 1

    def _retried(self, scope: str) -> None:
        self._again(scope)
        for name in self.scopes.cells(scope):
            self.cells[name].retries += 1

    def _cancelled(self, scope: str) -> None:
        """A task by its id, or what runs in each cell of the scope that could be cancelled."""
        for cell in self.tasks.cancel(scope, self.scopes.cells(scope)):
            self.unattended.cells.pop(cell, None)


TAKES: dict[type, Callable[[Record, Any], None]] = {
    Command: Record._on_command,
    SystemStart: lambda record, start: record.tasks.announce(start.cell, record.world.plant.now),
    TaskChanged: Record._on_task,
    OperatorAnswer: Record._on_answer,
    Remember: lambda record, message: record.facts.take(message),
    InternalError: Record._on_error,
}


@cache
def taker(kind: type) -> Callable[[Record, Any], None] | None:
    """The function that takes in messages of a class, or None; looked up for every message."""
    return nearest(TAKES, kind)


DONE: dict[Verb, Callable[[Record, str], None]] = {
    Verb.STOP: lambda record, scope: record.stops.stop(scope),
    Verb.RESET: lambda record, scope: record.stops.reset(scope),
    Verb.RESUME: Record._again,
    Verb.RETRY: Record._retried,
    Verb.CANCEL: Record._cancelled,
}
