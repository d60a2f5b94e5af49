"""Record of all that was said and done in a world so far, kept apart from the plant's own books."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import Any

from arboleda.engine import Act, Entry, Plant, State
from arboleda.kinds.joints import MoveJoints
from arboleda.model.by_class import nearest
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Command, Home, Stop, StopMode, Work
from arboleda.model.messages import (
    CellRevised,
    Fact,
    InternalError,
    OperatorAnswer,
    OperatorRequest,
    Remember,
    Report,
    SystemStart,
    TaskChanged,
    TaskRequest,
    TaskState,
    Verb,
)
from arboleda.model.plant_model import Link, Timing

from .recorded.acts import Acts
from .recorded.boards import Boards, KnownBoard
from .recorded.bridge import Bridges
from .recorded.cells import LOOK_S, KnownCell
from .recorded.choices import Choices
from .recorded.commands import Commands, SentCommand
from .recorded.courses import Courses
from .recorded.foreign import ForeignCommands
from .recorded.proofs import Proofs
from .recorded.refusals import differences
from .recorded.robots import STOPS, KnownRobot, Obstacle, StopProgress
from .recorded.scopes import Scopes
from .recorded.starts import Starts, Step, turn_of
from .recorded.stops import EarlyStops
from .recorded.tasks import Tasks
from .recorded.teachers import Teachers
from .recorded.time_line import TimeLine
from .recorded.times import Times
from .recorded.trails import Trails
from .recorded.verbs import EarlierState
from .recorded.zone_users import ZoneUser
from .world import BRIDGE, World

NO_VERBS: frozenset[Verb] = frozenset()
GIVEN_UP = (State.FAILED, State.CANCELLED)
GETS_GOING = frozenset(verb for verb in Verb if verb.row.moves)
SLOW_S = 10.0  # after the last sign of it, a bridge that stalled or a slow line may still have old reports


class Record:
    """Follows requests, commands, reports and tasks step by step.

    Of a step: `stepped`: the plant made it in this pass; `born`: the plant started in this pass; `begins`: it
    is the plant's first; `news`: something changed in it besides what robots report, or it is time to look at
    everything again; `has_spoken`: the plant spoke of a task, answered somebody, or a cell changed its state.
    `anew`: reports that say something else than before, or the same for some time. `away`: the
    plant finds in this step that it did nothing for long; `unattended`: the cells for which nobody has asked
    for anything since, with whether they had something to do then; `unasked`: the motions that it sends to
    such a cell by itself in this step; `stirring`: the same after a start. `born_at`: when the plant started
    last, unless that was the first time. `undisturbed`: no operator has asked for anything yet. `slow_until`:
    reports may be old until then. `shown`: by robot its record, its board and the plant's belief. `answers`,
    `errors` and `transitions` (cell, state before, state after) are of this step; `unnumbered`: a cell or a
    task changed in this step, but not the number by which screens know of changes. `differences` are what
    changed in a step in which everything asked for was refused and nothing was heard.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        model = world.model
        self.scopes = Scopes(model)
        stale_after_s = model.timing.stale_after_s
        self.robots = {name: KnownRobot(robot, stale_after_s) for name, robot in model.robots.items()}
        self.cells = {cell.name: KnownCell(cell, model.timing) for cell in model.cells}
        self.commands = Commands()
        self.proofs = Proofs()
        self.bridges = Bridges(model)
        self.others = ForeignCommands()
        self._people = [robot.name for robot in model.robots.values() if robot.link is Link.SCREEN]
        self.before_requests = EarlierState()
        self.acts = Acts()
        self.teachers = Teachers()
        world.before_asking.append(lambda: self.before_requests.look(self._cells, self.tasks, world))
        self.courses = Courses()
        self.courses.begin(run.task.id for run in world.plant.cells.values() if run.task is not None)
        self.courses.look(world.plant)
        self.choices = Choices(self.robots, self.courses)
        world.before_asking.append(lambda: self.choices.look(world))
        self.kept: dict[Fact, dict[str, str]] = {}  # before this step
        self._kept: dict[Fact, dict[str, str]] = {}
        self.tasks = Tasks(self.cells)
        self.starts = Starts(model)
        self.trails = Trails(self.robots)
        self.times = Times(world.plant.now)
        self.time_line = TimeLine()
        self.lost_stops: list[str] = []
        self.boards = Boards(
            {name: KnownBoard(_robot(world, name), board) for name, board in world.boards.items()}
        )
        self.stops = EarlyStops()
        self.anew: list[Report] = []
        self.answers: list[OperatorAnswer] = []
        self.errors: list[InternalError] = []
        self.transitions: list[tuple[KnownCell, CellState, CellState]] = []
        self.differences: list[str] = []
        self.waiting: list[ZoneUser] = []  # those that wait for zones
        self._requests: tuple[tuple[str, frozenset[str]], ...] = ()
        self.idle: list[KnownCell] = []  # with tasks in the queue, which is not paused
        self.stepped = self.news = self.born = self.begins = self.has_spoken = False
        self._has_begun = True
        self.undisturbed = True
        self.unnumbered = False
        self._cells = tuple(self.cells.values())
        self._look_again_at = 0.0
        self._has_news = False
        self.stepped_at = world.plant.now
        self.slow_until = world.now
        self._skipped_s = world.skipped_s
        self._next: dict[str, float] = {}
        self._checked: dict[str, object] = {}
        self.away = False
        self.unattended: dict[str, bool] = {}
        self.unasked: list[Command] = []
        self._verbs: dict[str, set[Verb]] = {}
        self._cancels_a_task = False
        self._unanswered: deque[OperatorRequest] = deque()  # of this step, in the order of asking
        self._booted: set[str] = set()  # robots that told of a boot in this step
        self._earlier: dict[str, list[KnownRobot]] = {}
        self._plant = world.plant
        self._cuts = world.disk.cuts
        self.stirring: list[Command] = []
        self._since_start = False
        self.born_at = -math.inf
        self._begin(world.plant)
        self._take_over(world.plant)

    def look(self) -> None:
        """Take in what happened in this step; called before any invariant."""
        moment, plant = self.world.moment, self.world.plant
        if self.anew:
            self.anew = []
        if self.world.versions:
            self._revise(moment.sent)
        if self._has_news:
            self._clear_news()
        if self.starts.wrong or self.starts.twice:
            self.starts.clear_news()
        if moment.last_words or moment.unkept:
            self.starts.hear((*moment.last_words, *moment.unkept))
        if plant is not self._plant:
            self.starts.take_stock()
        if moment.sent:
            self.starts.hear(moment.sent)
        for board, goal in moment.executed:
            self.starts.carries_out(board, goal)
        if moment.published:
            self.boards.tell(self.world.now, moment.published)
        if moment.delivered or moment.executed:
            self._look_at_boards()
        if moment.bridged:
            self.bridges.look(moment.bridged)
            self.others.look(moment.bridged, self.bridges.of_others)
        if moment.taken:
            self.stops.look(moment.taken, plant.epoch)
        for message, late_s in moment.late:
            self.commands.left_late(message, late_s)
        inbox, now = self.world.broker.clients[BRIDGE].inbox, self.world.now
        skipped = self.world.skipped_s != self._skipped_s
        if skipped or self.world.to_plant.troubles or (inbox and inbox[0].at < now):
            self.slow_until, self._skipped_s = now + SLOW_S, self.world.skipped_s
        acted = moment.sent or moment.reports or moment.requests
        if acted or plant.now != self.stepped_at or plant is not self._plant:
            self._look_at_plant(plant)
        elif self.stepped:
            self.stepped = self.news = self.born = self.begins = False

    def effector_of(self, arm: str) -> str:
        """The state of an effector as the plant's memory has it."""
        return self._kept.get(Fact.EFFECTOR, {}).get(arm, "off")

    def reports_from_s(self, at: float) -> float:
        """The time since when a position that reached the plant at `at` may have been reported."""
        return 0.0 if at < self.slow_until else at - self.world.model.timing.stale_after_s

    @property
    def questions(self) -> list[Entry]:
        """The open questions to people: nothing is sent for those."""
        dispatcher = self.world.plant.dispatcher
        return [entry for name in self._people if (entry := dispatcher.ledger.question(name)) is not None]

    def due_for(self, what: str, every_s: float) -> bool:
        """True if a check that is made only every `every_s` is due now; counts as made then."""
        if self.world.now < self._next.get(what, 0.0):
            return False
        self._next[what] = self.world.now + every_s
        return True

    def is_new(self, what: str, value: object) -> bool:
        """True if this is another value than when it was asked last; a check that depends on no more than the
        value need not be made again.
        """
        if what in self._checked and self._checked[what] == value:
            return False
        self._checked[what] = value
        return True

    def timing_of(self, sent: SentCommand) -> Timing:
        """The times by which a command was given: no cell takes others while one of its own is open."""
        entry = sent.entry
        known = self.cells[self.world.model.cell_of[sent.robot].name if entry is None else entry.cell]
        return known.timing if sent.at == self.stepped_at else known.timing_before

    def _revise(self, sent: Iterable[object]) -> None:
        """Know of each cell the version that it works by, and of all that the last start has."""
        revised = {each.cell: each.version.digest for each in sent if isinstance(each, CellRevised)}
        for name, known in self.cells.items():
            known.timing_before = known.timing
            if name in revised:
                known.revise(self.world.model.cell(name), self.world.versions[revised[name]].timing)
            elif self.world.plant is not self._plant:
                known.revise(self.world.model.cell(name), self.world.model.timing)

    def _begin(self, plant: Plant) -> None:
        """Begin with a plant that starts: it knows nothing but what it had to keep."""
        self._plant, self._start = plant, self.world.plant_process.starts
        self.stepped_at, self._version = plant.now, -1
        self.unattended.clear()
        self.tasks.restart(self.world.plant_process.found.tasks.values() if self.born else (), plant.now)
        self.commands.forget()
        self.proofs.forget()
        cuts, self._cuts = self._cuts, self.world.disk.cuts
        self.starts.restart(undone=cuts != self._cuts)
        self.time_line.begin()
        self.teachers.restart()
        found = self.world.plant_process.found.facts
        displaced, boots = found.get(Fact.DISPLACED, {}), found.get(Fact.BOOT, {})
        for name, robot in self.robots.items():
            robot.forget()
            robot.displaced = name in displaced
            robot.boot = int(boots[name]) if name in boots else None
        for name, cell in self.cells.items():
            cell.begin(plant.cells[name])
        self.trails.restart(found, self.tasks.running)
        beliefs, boards = plant.dispatcher.beliefs, self.boards.of_robot
        self.shown = {name: (self.robots[name], board, beliefs[name]) for name, board in boards.items()}

    def _take_over(self, plant: Plant) -> None:
        """Take over the plant's beliefs, this once: reports from before this record began."""
        self.bridges.take_over(self.world.bridge, self.world.now, plant.dispatcher.beliefs)
        for name, known in self.robots.items():
            belief = plant.dispatcher.beliefs[name]
            known.take_over(belief.heard_at)
            known.state, known.homed = belief.state, belief.homed
            known.boot, known.epoch, known.plant = belief.boot_id, belief.epoch, belief.plant
            known.q, known.node = belief.q, belief.node
            known.numbers.append(belief.number)
            known.effector, known.piece, known.facts = belief.effector, belief.piece, dict(belief.facts)
            if (board := self.boards.of_robot.get(name)) is not None:
                board.take_over(self.world.now, belief)

    def _look_at_boards(self) -> None:
        boards, moment = self.boards, self.world.moment
        boards.deliver(moment.delivered)
        boards.executed.clear()
        for name, goal in moment.executed:
            boards.execute(name, goal)
        boards.forget_read(self.world.broker.clients)

    def _look_at_plant(self, plant: Plant) -> None:
        moment = self.world.moment
        self.stepped = self.world.plant_process.has_stepped
        self.born = plant is not self._plant
        if self.born:
            self._take_last_words()
            self.times.restart(self.stepped_at, plant.now)
            self._begin(plant)
            self.courses.begin(self.tasks.running.values())
            self._expect_rest(plant)
            self._has_begun = False
        self.begins = self.stepped and not self._has_begun
        self._has_begun = self._has_begun or self.stepped
        self._earlier.clear()
        self._booted.clear()
        self.away = not self.born and plant.now - self.stepped_at > plant.away_after_s
        if self.away:
            self.unattended = {
                cell.name: self._has_work(cell)
                for cell in self._cells
                if (cell.tree is not None and not cell.cell.goes_on_after_absence)
                or cell.queued == 0  # tasks may start by themselves where none is under way
            }
            self._since_start = False
            for cell in self._cells:
                if cell.cell.goes_on_after_absence:  # it goes on by itself, as after a retry
                    self._retried(cell.name)
        if self.proofs.of:
            self.proofs.of.clear()
        if moment.reports:
            self._hear(bool(moment.requests))
        if moment.requests:
            self._ask(moment.requests)
        if moment.requests or self.teachers.taught or self.teachers.was:
            self.teachers.look(moment.requests, moment.sent)
        self.kept = self._kept
        for message in moment.sent:
            take = taker(message.__class__)
            if take is not None:
                take(self, message)
        self._compare(plant)
        self.courses.look(plant)
        self.stepped_at = plant.now
        if self.acts.of:
            faults, last = self.world.faults_active, self.world.last_fault_at
            self.acts.look(self.cells, last_fault_at=last, faults=faults)

    def _take_last_words(self) -> None:
        """Take in what a plant said in the step in which it died, of which the rest is unknown."""
        words = self.world.moment.last_words
        self._unanswered = deque(event for event in words if isinstance(event, OperatorRequest))
        self.undisturbed &= not self._unanswered
        for message in words:
            take = taker(message.__class__)
            if take is not None:
                take(self, message)
        for request in words:  # its effects may be kept, though nobody was told
            if isinstance(request, OperatorRequest) and request.verb is Verb.RETRY:
                self._retried(request.scope)
            elif isinstance(request, OperatorRequest) and request.verb is Verb.CANCEL:
                self._may_be_cancelled(request.scope)
        sent = {each.command.id: each.command for each in self.commands.new}
        if sent:
            self.commands.follow(self._plant.dispatcher.ledger, self._plant.now)
        for cell in self._cells if sent else ():
            cell.look(sent)
            self._follow_steps(cell, sent)
        self._clear_news()
        self._kept = {fact: dict(rows) for fact, rows in self.world.plant_process.found.facts.items()}
        kept = self._kept.get(Fact.LATCH, {})
        stopped = [name for name, known in self.robots.items() if known.stop is StopProgress.LATCHED]
        undone = any(each.verb in (Verb.CLEAR, Verb.RESET) for each in self._unanswered)
        self.lost_stops = [name for name in stopped if kept.get(name) != "on" and not undone]
        if words:
            self._take_over_stops()
            for each in self.commands.open.values():
                if each.entry is not None and each.entry.state in GIVEN_UP:
                    self.starts.gave_up(each.command.id)

    def _take_over_stops(self) -> None:
        """Take over the stops on the disk: of a step in which the plant died, they show how far it got."""
        kept = self._kept.get(Fact.LATCH, {})
        for name in self.scopes.commanded(""):
            self.robots[name].stop = STOPS.get(kept.get(name, ""))
        for cell in self._cells:
            alone = [
                name
                for name in cell.cell.shared
                if kept.keys().isdisjoint(own for each in self.world.model.cells_of[name] for own in each.own)
            ]
            cell.stopped = not kept.keys().isdisjoint((*cell.cell.own, *alone))

    def _expect_rest(self, plant: Plant) -> None:
        """Cells in which nothing may move by itself now: all but those that go on and were not at work."""
        self._since_start = True
        self.born_at = plant.now
        self.slow_until = self.world.now + SLOW_S  # a bridge tells a new plant all that it knows
        for cell in self._cells:
            at_work = cell.name in self.tasks.running
            if at_work or not cell.cell.goes_on:
                has_work = bool(self.tasks.queues[cell.name]) or plant.cells[cell.name].task is not None
                self.unattended[cell.name] = has_work

    def _is_behind_work(self, user: ZoneUser) -> bool:
        """True if all that have, or get earlier, the zones that this robot wants were at work."""
        zones, before, wanted = self._plant.zones, set(), dict(self._requests)[user.robot]
        for arm, asked in self._requests:
            if arm == user.robot:
                break
            if not wanted.isdisjoint(asked):
                before.add(arm)
        holders = zones.holders
        before.update([holders[zone] for zone in wanted if zone in holders])
        if before:
            before.difference_update([sent.robot for sent in self.commands.open.values()])
            for each in self._cells if before else ():
                if CellState.EXECUTE in (each.state, each.run.state):
                    before.difference_update(each.cell.zone_users)
        return not before and not any(map(zones.is_quarantined, wanted))

    def _has_work(self, cell: KnownCell) -> bool:
        return cell.tree is not None or cell.queued > 0

    def _is_unasked(self, command: Command) -> bool:
        """True for a motion in a cell for which nobody has asked for anything since the absence.

        A request for one robot of a cell may move the other: `abandon` of the mobile brings the arm home.
        """
        moves = isinstance(command, Work)
        if self._since_start and isinstance(command, Home) and self.robots[command.robot].robot.home_at_start:
            return False
        cells = self.world.model.cells_of[command.robot]
        if not moves or self._cancels_a_task or any(cell.name not in self.unattended for cell in cells):
            return False
        robots = [robot.name for cell in cells for robot in cell.robots]
        return all(GETS_GOING.isdisjoint(self._verbs.get(name, NO_VERBS)) for name in robots)

    def _attend(self, scope: str) -> None:
        for name in self.scopes.cells(scope):
            self.unattended.pop(name, None)

    def _clear_news(self) -> None:
        self.commands.clear_news()
        self.unasked.clear()
        self.stirring.clear()
        self.tasks.clear_news()
        self.answers.clear()
        self.errors.clear()
        self.transitions.clear()
        self.differences.clear()
        self._has_news = self.has_spoken = False

    def _compare(self, plant: Plant) -> None:
        """Take over what the plant's books say after this step."""
        moved = self.commands.follow(plant.dispatcher.ledger, plant.now)
        for sent, _ in self.commands.moved:
            cell = self.cells[sent.entry.cell] if sent.entry is not None else None
            if sent.state is State.DONE and cell is not None and cell.run.state is CellState.EXECUTE:
                self.starts.went_on(sent.command.id)
            elif sent.state in GIVEN_UP:
                self.starts.gave_up(sent.command.id)
        if moved:
            self.proofs.follow(list(self.commands.open.values()))
            self._follow_homing()
            self._follow_refusals(plant)
        has_requests = bool(self.world.moment.requests)
        if has_requests:
            self.differences += differences(self)
            self._verbs.clear()
            self._cancels_a_task = False
        if self.world.model.zones:
            self._look_at_zones(plant)
        changed = self._look_at_cells()
        self._look_at_trails()
        if changed or self.born:
            self.times.look(self._cells, plant.now)
            idle = [cell for cell in self._cells if cell.queued and cell.state is CellState.IDLE]
            self.idle = [cell for cell in idle if not cell.paused]
        late = self.commands.soonest <= plant.now
        self.news = moved or has_requests or changed or late or self.born or bool(self.tasks.changes)
        news = self.tasks.changes or self.tasks.refused or self.answers or self.transitions
        self.has_spoken = bool(news or self.errors)
        self.unnumbered = (changed or bool(self.tasks.changes)) and plant.version == self._version
        self._version = plant.version
        if self.news or plant.now >= self._look_again_at:
            self._look_into_trees(plant.now)

    def _hear(self, is_requested: bool) -> None:
        """Take in reports; if somebody asked for something among them, a command may rest on any."""
        moment, robots = self.world.moment, self.robots
        commanded = {each.robot for each in moment.sent if isinstance(each, Command)}
        for report in moment.reports:
            known = robots.get(report.robot)
            if known is None:
                continue
            if report.robot in commanded and (is_requested or known.robot.home_at_start):
                self._earlier.setdefault(report.robot, []).append(known.as_it_is())
            if report.robot in self.proofs.by_robot:
                self.proofs.hear(report, known)
            if report.boot_id not in (None, known.boot):
                self._booted.add(report.robot)
            if known.hear(report):
                self.anew.append(report)
                if report.rejected is not None:
                    self.commands.hear(report, known)

    def _ask(self, requests: list[Any]) -> None:
        self._unanswered = deque(event for event in requests if isinstance(event, OperatorRequest))
        for event in requests:
            if isinstance(event, OperatorRequest):
                self._cancels_a_task |= event.verb is Verb.CANCEL and event.scope not in self.scopes
                self.undisturbed = False
                for robot in self.scopes.robots(event.scope):
                    self._verbs.setdefault(robot, set()).add(event.verb)

    def _acted_on(self, request: OperatorRequest) -> list[KnownCell]:
        """The cells that a request is to lead on; an answer is for the one cell that asks."""
        cells = [self.cells[name] for name in self.scopes.cells(request.scope)]
        return [] if request.verb is Verb.ANSWER and len(cells) > 1 else cells

    def _look_at_zones(self, plant: Plant) -> None:
        """Look at the zones, before the cells are taken over: each still has its previous state."""
        requests = plant.zones.queue.waiting
        if requests != self._requests:
            self._requests, robots = requests, dict(requests)
            users = [user for cell in self._cells for user in cell.zone_users.values()]
            self.waiting = [user for user in users if user.robot in robots]
        for user in self.waiting if not self.away else ():
            state, behind_work = self.cells[user.cell].state, self._is_behind_work(user)
            user.wait(plant.now - self.stepped_at, state=state, behind_work=behind_work)
        moves: dict[str, list[SentCommand]] = {}
        for each in self.commands.new:
            if each.entry is not None and each.entry.cancelled_at is None:  # not halted at once
                of_cell = moves.setdefault(each.entry.cell, [])
                of_cell += [each] if isinstance(each.command, MoveJoints) else []
        holders = plant.zones.holders.values()
        for cell in self._cells:
            for user in cell.zone_users.values():
                if cell.name in moves:
                    user.watch_recovery(moves[cell.name])
                user.holds = user.robot in holders

    def _look_at_cells(self) -> bool:
        """Take over the states of the cells; True if any of them changed."""
        changed = False
        for cell in self._cells:
            cell.looked, run = False, cell.run
            cell.wakes = cell.context.time.wakes
            if cell.signs(run) == cell.last_signs and len(run.queue) == cell.queued:
                continue
            before, changed = cell.state, True
            cell.follow()
            if cell.state is not before:
                self.transitions.append((cell, before, cell.state))
        return changed

    def _look_at_trails(self) -> None:
        if self.trails.found or self.trails.wrong:
            retried = Verb.RETRY in [each.verb for each in self.answers] if self.answers else False
            self.trails.look(self.cells, self.transitions, retried=retried)
        if self.answers:
            self.trails.keep(self.world.moment.sent, self.cells, self.commands)

    def _look_into_trees(self, now: float) -> None:
        """Look into the trees of the cells that sent something, and from time to time into all."""
        self.news = self._has_news = True
        due = now >= self._look_again_at
        if due:
            self._look_again_at = now + LOOK_S
        new = self.commands.new
        sent = {each.command.id: each.command for each in new}
        senders = {each.entry.cell for each in new if each.entry}
        for cell in self._cells:
            cell.watch_time(now, away=self.away)
            if (due or cell.name in senders) and cell.state is CellState.EXECUTE:
                cell.look(sent)
                self._follow_steps(cell, sent)

    def _follow_steps(self, cell: KnownCell, sent: Mapping[str, Command]) -> None:
        """Note the steps of the cell's task that gave the commands of this step, with their tokens."""
        run = cell.run
        if run.task is None or run.run.recovering:
            return
        for leaf in cell.leaves:
            entry = leaf.entry if isinstance(leaf, Act) else None
            command = None if entry is None else sent.get(entry.command.id)
            if command is not None:
                board = self.world.model.robots[command.robot].mqtt
                misled = self.world.deceptions[board, "ack"] > 0
                path = turn_of(leaf)
                self.starts.gave(Step(run.task.id, path, command, self._start, cell.retries, misled=misled))

    def _on_command(self, command: Command) -> None:
        known = self.robots[command.robot]
        verbs = self._verbs_done(command.robot) if command.robot in self._verbs else NO_VERBS
        if self.unattended and self._is_unasked(command):
            (self.stirring if self._since_start else self.unasked).append(command)
        obstacles = frozenset() if isinstance(command, Stop) else self._obstacles(known)
        if isinstance(command, Stop):
            verbs |= self._missed(command, known, verbs)
        self.commands.take(SentCommand(command, self._plant.now, obstacles, verbs, known.halts), known)
        if isinstance(command, Stop) and command.mode is StopMode.CLEAR:
            known.barred = False
            known.stop = StopProgress.CLEARED if known.stop is StopProgress.LATCHED else known.stop

    def _verbs_done(self, robot: str) -> frozenset[Verb]:
        """The verbs that operators asked for on a robot in this step, without those that are refused."""
        answers = [each for each in self.world.moment.sent if isinstance(each, OperatorAnswer)]
        done = {answer.verb for answer in answers if answer.refusal is None}
        refused = {answer.verb for answer in answers if answer.refusal is not None}
        return frozenset(self._verbs[robot] - (refused - done))

    def _missed(self, command: Stop, known: KnownRobot, verbs: frozenset[Verb]) -> frozenset[Verb]:
        """Count a clear once more when a robot that was offline at that time is back."""
        missed, asked = known.missed_clear, Verb.CLEAR in verbs
        known.missed_clear = command.mode is StopMode.CLEAR and asked and known.offline(self._plant.now)
        known.missed_clear |= command.mode is StopMode.HALT and missed
        return frozenset({Verb.CLEAR}) if missed else NO_VERBS

    def _obstacles(self, known: KnownRobot) -> frozenset[Obstacle]:
        """The obstacles that spoke against a command to this robot all through this step."""
        requests = self.world.moment.requests
        now = min((event.at for event in requests), default=self._plant.now)
        found = known.obstacles(now, self._plant.epoch)
        for earlier in self._earlier.get(known.robot.name, ()):
            earlier.stop = known.stop
            found &= earlier.obstacles(now, self._plant.epoch)
        cells = self.world.model.cells_of[known.robot.name]
        stopped = all(self.cells[cell.name].stopped for cell in cells)
        return found | {Obstacle.STOPPED} if stopped else found

    def _on_fact(self, message: Remember) -> None:
        kept = {fact: dict(rows) for fact, rows in self._kept.items()}
        rows = kept.setdefault(message.fact, {})
        rows.pop(message.name, None)
        if message.value is not None:
            rows[message.name] = message.value
        self._kept = kept

    def _on_task(self, change: TaskChanged) -> None:
        requests = (each for each in self.world.moment.requests if isinstance(each, TaskRequest))
        again = change.request is not None or any(each.request is None for each in requests)
        self.tasks.take(change, self._plant.now, is_repeated=again)
        if change.state is TaskState.QUEUED and not self.unattended.get(change.cell or "", True):
            del self.unattended[
                change.cell or ""
            ]  # it had nothing to do, and now somebody asks for something

    def _on_answer(self, answer: OperatorAnswer) -> None:
        self.answers.append(answer)
        request = self._unanswered.popleft()
        self.acts.take(request, self._acted_on(request), is_refused=answer.refusal is not None)
        if answer.refusal is None and answer.verb in GETS_GOING:
            self._attend(answer.scope)
        done = DONE.get(answer.verb)
        if answer.refusal is None and done is not None:
            done(self, answer.scope)
        if answer.refusal is None and request.verb is Verb.HOME and request.by_hand:
            self._put_right(answer.scope)

    def _on_error(self, error: InternalError) -> None:
        self.errors.append(error)
        self._has_news = True

    def _stopped(self, scope: str) -> None:
        for name in self.scopes.commanded(scope):
            self.robots[name].stop = StopProgress.LATCHED
        for name in self.scopes.cells(scope):
            self.cells[name].stopped = True

    def _reset(self, scope: str) -> None:
        for name in self.scopes.cells(scope):
            cell = self.cells[name]
            if cell.state is CellState.STOPPED:
                cell.stopped = False
                for robot in cell.cell.robots:  # a shared device only with the last of its cells
                    cells = self.world.model.cells_of[robot.name]
                    if not any(self.cells[each.name].stopped for each in cells):
                        self.robots[robot.name].stop = None

    def _again(self, scope: str) -> None:
        for name in self.scopes.cells(scope):
            self.cells[name].again += 1

    def _follow_homing(self) -> None:
        """Take over that a robot knows its place again, once its homing routine has ended."""
        for sent, _ in self.commands.moved:
            if isinstance(sent.command, Home) and sent.state is State.DONE:
                self.robots[sent.robot].displaced = False

    def _follow_refusals(self, plant: Plant) -> None:
        """Take the plant's word on refused halted commands: those of a robot at rest mean nothing."""
        for sent, _ in self.commands.moved:
            if sent.rejected and sent.state is State.CANCELLED:
                self.robots[sent.robot].barred = plant.dispatcher.beliefs[sent.robot].barred

    def _put_right(self, scope: str) -> None:
        """Take over that operators put robots right; a boot reported in this step may be later."""
        beliefs = self._plant.dispatcher.beliefs
        for name in self.scopes.robots(scope):
            self.robots[name].displaced = name in self._booted and beliefs[name].displaced

    def _retried(self, scope: str) -> None:
        self._again(scope)
        for name in self.scopes.cells(scope):
            self.cells[name].retries += 1

    def _cancelled(self, scope: str) -> None:
        """A task by its id, or what runs in each cell of the scope that could be cancelled."""
        task, cells = self.tasks.known(scope.strip().lstrip("#")), self.scopes.cells(scope)
        if task is not None:
            task.cancelled = True
            self.unattended.pop(task.cell, None)
            return
        for name in cells:
            running = self.tasks.open.get(self.tasks.running.get(name, ""))
            if running is not None and running.cancelled is False:
                running.cancelled = True if len(cells) == 1 else None
        if len(cells) == 1:
            self.unattended.pop(cells[0], None)

    def _may_be_cancelled(self, scope: str) -> None:
        """Note cancels in a scope, of tasks by id or in its cells, that may or may not have been kept."""
        named = self.tasks.known(scope.strip().lstrip("#"))
        running = (self.tasks.running.get(name, "") for name in self.scopes.cells(scope))
        found = [named] if named is not None else [self.tasks.open.get(id) for id in running]
        for task in found:
            if task is not None and task.cancelled is False:
                task.cancelled = None


TAKES: dict[type, Callable[[Record, Any], None]] = {
    Command: Record._on_command,
    SystemStart: lambda record, start: record.tasks.announce(start.cell, record.world.plant.now),
    TaskChanged: Record._on_task,
    OperatorAnswer: Record._on_answer,
    Remember: Record._on_fact,
    InternalError: Record._on_error,
}


@cache
def taker(kind: type) -> Callable[[Record, Any], None] | None:
    """The method that takes in messages of a class, or None; looked up for every message."""
    return nearest(TAKES, kind)


DONE: dict[Verb, Callable[[Record, str], None]] = {
    Verb.STOP: Record._stopped,
    Verb.RESET: Record._reset,
    Verb.RESUME: Record._again,
    Verb.RETRY: Record._retried,
    Verb.CANCEL: Record._cancelled,
}


def _robot(world: World, mqtt: str) -> Any:
    return next(robot for robot in world.model.robots.values() if robot.mqtt == mqtt)
