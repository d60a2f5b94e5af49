"""The people around a simulated plant: customers with tasks, an attendant who gets cells going again."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import count

from arboleda.drivers import Value
from arboleda.engine import title_of
from arboleda.engine.inspection import Question, ledger_of
from arboleda.model import text as task_text
from arboleda.model.advice import Advice, Hand
from arboleda.model.messages import TaskChanged, TaskState, Verb
from arboleda.model.plant_model import Cell, Link
from arboleda.recipes import Recipe, TextError
from arboleda.recipes.place_questions import GETS_PART, GETS_ROOM
from arboleda.rig.hands import HANDS, do
from arboleda.rig.world import World
from arboleda.sim.machine import MachineBody
from arboleda.wire.payloads import VerbGoal

from . import branch_numbers
from .chance import Dice
from .cycles import has_told
from .recorded.zone_users import running
from .task_words import task_words

IN_VAIN = 100  # tasks in a row of a cell that end without a cycle, or are refused
WAITING = 2  # tasks that the customers of a cell keep in its queue
REMEMBERED = 24  # of their tasks
SEEN_TO = {GETS_PART.key: HANDS[Hand.PUT_IN], GETS_ROOM.key: HANDS[Hand.TAKE_OUT]}
BY_THEMSELVES = (Hand.BRING_BACK, Hand.REPAIR)
THINKS_S = 1.5  # somebody who is asked
ROUND_S = (2.0, 6.0)  # how long the attendant takes to come by again
STANDS_BY_S = (1.5, 1.5)  # the same of one who does nothing else


class Customers:
    """Bring every cell its next task soon after one of theirs left its queue, until they `go`.

    They know their own tasks by the tokens of their requests. Once the plant has died, their tasks have ids
    of their own: when it is back, they ask for the last of them again, whatever they know of them. `cycles`
    counts the tasks, whoever asked for them, that ended and had told a device to do something; `outcomes` has
    all that began and ended.

    With `any_of` about half of their tasks name several cells, of which the plant chooses one.
    """

    def __init__(self, world: World, seed: int, *, any_of: bool = False) -> None:
        self._world = world
        self._dice = Dice(seed, "customers")
        self._groups = Dice(seed, "groups of cells") if any_of else None
        self._open_requests: dict[str, Cell] = {}  # by token
        self._waiting: set[str] = set()  # their own tasks that are in a queue
        self._started: dict[str, float] = {}  # when a task began
        self._gone = False
        self._tokens = count(1)
        self._starts = world.plant_process.starts
        self._back = Dice(seed, "customers come back")
        self._theirs: dict[str, str] = {}  # by id, the texts of their last tasks
        self._texts: dict[str, str] = {}  # by token, of those requests
        self.cycles = 0
        self.outcomes: dict[str, int] = {}
        self._in_vain = dict.fromkeys((cell.name for cell in world.model.cells), 0)
        world.watchers.append(self._look)
        for cell in world.model.cells:
            for _ in range(WAITING):
                self._come(cell)

    def go(self) -> None:
        """Bring no more."""
        self._gone = True

    @property
    def gave_up(self) -> bool:
        """True once many tasks in a row of each cell have come to nothing."""
        return all(number >= IN_VAIN for number in self._in_vain.values())

    def _look(self) -> None:
        moment = self._world.moment
        for message in (*moment.last_words, *moment.sent) if moment.last_words else moment.sent:
            if isinstance(message, TaskChanged):
                if message.request is None:
                    self._follow(message)
                elif message.request in self._open_requests:
                    self._answered(message, self._open_requests.pop(message.request))
                elif message.request in self._texts:
                    self._texts.pop(message.request)
                    self._take_repeat(message)
        if self._world.plant_process.starts != self._starts:
            self._starts = self._world.plant_process.starts
            self._come_back()

    def _answered(self, answer: TaskChanged, cell: Cell) -> None:
        if answer.state is TaskState.QUEUED:
            self._waiting.add(answer.task)
            return
        if answer.state is TaskState.REFUSED:
            self._theirs.pop(answer.text.rpartition("#")[2], None)
            self._in_vain[cell.name] += 1
        self._come(cell)

    def _come_back(self) -> None:
        """Ask again after a death of the plant: anew where no answer came, by id where the task has one."""
        for cell in self._open_requests.values():
            self._come(cell)
        self._open_requests.clear()
        self._texts.clear()
        for id in self._theirs:
            self._world.at(self._world.now + self._back.between(0.0, 20.0), self._ask_again, id)

    def _ask_again(self, id: str) -> None:
        text = self._theirs.get(id)
        never_taken = id not in self._world.disk.tasks
        if text is not None and not (self._gone and never_taken):
            token = f"customer {next(self._tokens)}"
            self._texts[token] = text
            self._world.request_task(text, token)

    def _take_repeat(self, answer: TaskChanged) -> None:
        """Take a task's state by its repeated request; one that is only accepted now waits as any other."""
        if answer.state is TaskState.QUEUED and answer.task not in self._waiting:
            self._waiting.add(answer.task)
        elif answer.state is not TaskState.QUEUED:
            self._follow(answer)

    def _follow(self, change: TaskChanged) -> None:
        if change.task in self._waiting and change.cell is not None:
            self._waiting.discard(change.task)
            self._come(self._world.model.cell(change.cell))
        if change.state is TaskState.RUNNING:
            self._started.setdefault(change.task, self._world.now)
        elif change.task in self._started:
            self._count(change, since=self._started.pop(change.task))

    def _count(self, change: TaskChanged, *, since: float) -> None:
        told = has_told(self._world, change.cell, since)
        self.cycles += told
        if change.cell is not None:
            self._in_vain[change.cell] = 0 if told else self._in_vain[change.cell] + 1
        outcome = change.reason.value if change.reason else change.state.value
        self.outcomes[outcome] = self.outcomes.get(outcome, 0) + 1

    def _come(self, cell: Cell) -> None:
        self._world.at(self._world.now + self._dice.between(0.0, 1.0), self._ask, cell)

    def _ask(self, cell: Cell) -> None:
        if not self._gone:
            number = next(self._tokens)
            token, text = f"customer {number}", self._text(cell)
            if self._world.plant_process.starts > 1:
                id = f"c-{number}"
                text = self._theirs[id] = f"{text} #{id}"
                for old in [*self._theirs][:-REMEMBERED]:
                    del self._theirs[old]
            self._open_requests[token] = cell
            self._world.request_task(text, token)

    def _text(self, cell: Cell) -> str:
        text = text_of(cell, self._dice)
        if self._groups is None or not self._groups.chance(0.5):
            return text
        words = text.partition(" ")[2]
        others = [other.name for other in self._world.model.cells if other is not cell]
        named = [name for name in others if self._takes(f"{name} {words}") and self._groups.chance(0.7)]
        return f"{task_text.BETWEEN_CELLS.join([cell.name, *named])} {words}"

    def _takes(self, text: str) -> bool:
        try:
            task_text.parse(text, self._world.offers)
        except TextError:
            return False
        return True


def text_of(cell: Cell, dice: Dice) -> str:
    """The text of a task for a cell; where its recipes have a short form, as people type it."""
    short = ShortForms.of(cell)
    if short is None or len(cell.recipes) > 2:
        return any_text(cell, dice)
    return short.plain if dice.chance(0.2) else short.default(dice)


@dataclass(frozen=True, kw_only=True)
class ShortForms:
    """Texts of a cell with a recipe that tasks need not name, and one that takes no value: `plain`."""

    cell: Cell
    unnamed: Recipe
    plain: str

    @classmethod
    def of(cls, cell: Cell) -> ShortForms | None:
        """Those of a cell that has both."""
        unnamed = next((each for each in cell.recipes if each.is_default and each.parameters), None)
        plain = [each.name for each in cell.recipes if not (each.is_default or each.parameters)]
        return cls(cell=cell, unnamed=unnamed, plain=f"{cell.name} {plain[0]}") if unnamed and plain else None

    def default(self, dice: Dice) -> str:
        """The text of one of the tasks that do not name their recipe."""
        values = (dice.pick(task_words(self.cell, each)) for each in self.unnamed.parameters)
        return " ".join([self.cell.name, *values])

    def first(self, *last: str) -> str:
        """The same with the first word of each parameter, and at the end with these."""
        values = [task_words(self.cell, each)[0] for each in self.unnamed.parameters]
        return " ".join([self.cell.name, *values[: len(values) - 1], *last])


def any_text(cell: Cell, dice: Dice) -> str:
    """The text of one of the recipes of a cell, with one of the words of each parameter."""
    chosen = dice.pick(cell.recipes)
    words = [dice.pick(list(each.words(cell))) for each in chosen.parameters]
    return " ".join([cell.name, chosen.name, *words])


def answer_anything(world: World, seed: int) -> None:
    """Have devices that are queried give any of their answers: a camera sees bad parts, too."""
    answers = branch_numbers.numbers(world.model)
    for robot in world.model.robots.values():
        board = world.boards.get(robot.mqtt)
        if board is not None and isinstance(board.body, MachineBody):
            dice = Dice(seed, "answers", robot.mqtt)
            own = {verb: those for (device, verb), those in answers.items() if device == robot.name}
            board.body.answer = partial(_any_answer, board.body, own, dice)


def _any_answer(
    body: MachineBody, numbers: Mapping[str, Sequence[Value]], dice: Dice, goal: VerbGoal
) -> Value:
    verb = body.kind.verbs[goal.verb]
    return dice.pick(verb.answers or numbers.get(goal.verb) or verb.answer_type.samples)


class FixedAnswers:
    """FixedAnswers: devices and people who are asked give the word that stands by their name, else the first.

    People think for a moment.
    """

    def __init__(self, world: World, words: Mapping[str, Value]) -> None:
        self._world = world
        self._words = words
        robots = world.model.robots.values()
        for robot in (each for each in robots if each.name in words and each.mqtt in world.boards):
            body = world.boards[robot.mqtt].body
            if isinstance(body, MachineBody):
                body.answer = partial(_word_or_first, body, words[robot.name])
        self._people = [robot.name for robot in robots if robot.link is Link.SCREEN]
        if self._people:
            self._come_by()

    def _come_by(self) -> None:
        self._world.at(self._world.now + THINKS_S, self._answer)

    def _answer(self, _: None) -> None:
        for name in self._people:
            entry = ledger_of(self._world.plant).question(name)
            if entry is not None and isinstance(entry.command, Question):
                word = self._words.get(name)
                answer = word if word in entry.command.answers else entry.command.answers[0]
                self._world.request_verb(Verb.ANSWER, name, arguments=(("answer", str(answer)),))
        self._come_by()


def answer_in_turn(body: MachineBody, verb: str, answers: Iterable[Value]) -> None:
    """Have a device answer the next questions of this verb so, one after the other; then as before."""
    body.answer = partial(_next, deque(answers), verb, body.answer)


def _next(prepared: deque[Value], verb: str, otherwise: Callable[[VerbGoal], Value], goal: VerbGoal) -> Value:
    return prepared.popleft() if prepared and goal.verb == verb else otherwise(goal)


def _word_or_first(body: MachineBody, word: Value, goal: VerbGoal) -> Value:
    answer = body.kind.verbs[goal.verb].answer_type.read(word)
    return body.first_answer(goal) if answer is None else answer


class Attendant:
    """Attendant: comes by every few seconds and does the first thing that is advised, cell by cell.

    It also sees to supplies and outputs for which a task waits, as people do who keep these. It neither
    brings back what is lost nor repairs what is broken: that ends with its fault. What several cells advise
    in one round, as to clear a device that they share, it does once. `acts` has what it did of the advice
    of each cell; between two rounds there are `round_s`.
    """

    def __init__(self, world: World, seed: int, *, round_s: tuple[float, float] = ROUND_S) -> None:
        self.acts = defaultdict[str, list[Advice]](list)
        self._round_s = round_s
        self._world = world
        self._dice = Dice(seed, "attendant")
        robots = world.model.robots.values()
        self._people = [robot.name for robot in robots if robot.link is Link.SCREEN]
        self._next_round()

    def _next_round(self) -> None:
        self._world.at(self._world.now + self._dice.between(*self._round_s), self._round)

    def _round(self, _: None) -> None:
        self._answer()
        done: set[Hashable] = set()
        for cell in self._world.plant.cells:
            self._see_to(cell, self._world.plant.advice(cell), done)
            self._keep_places(cell)
        self._next_round()

    def _keep_places(self, cell: str) -> None:
        """Fill a supply, or empty an output, for which a task waits, as nobody else does before its end."""
        run = self._world.plant.cells[cell]
        kept = {place.target for place in run.cell.places if place.by_people}
        for leaf in running(run.tree):
            title = title_of(leaf)
            if title.key in SEEN_TO and title.values["place"] in kept:
                SEEN_TO[title.key](self._world, f"{cell} {title.values['place']}")

    def _answer(self) -> None:
        """Have people who are asked something give one of the answers."""
        plant = self._world.plant
        for name in self._people:
            entry = ledger_of(plant).question(name)
            if entry is not None and isinstance(entry.command, Question):
                answer = self._dice.pick(entry.command.answers)
                self._world.request_verb(Verb.ANSWER, name, arguments=(("answer", answer),))

    def _see_to(self, cell: str, ways: tuple[Advice, ...], done: set[Hashable]) -> None:
        """Follow the first advice of a cell, if it is not `done` in this round; after a look into a zone, or
        work at a reference, also the next, as the plant cannot know that this was done.
        """
        for advice in ways:
            if advice.refusal is not None or advice.do in BY_THEMSELVES:
                return
            act = advice.do, advice.scope, advice.arguments, advice.by_hand
            if act not in done:
                do(self._world, advice)
                done.add(act)
            self.acts[cell].append(advice)
            if advice.do not in (Hand.CHECK, Hand.REFERENCE):
                return
