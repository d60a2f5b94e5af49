"""The script of a day: orders, stops, cuts and bad lines by chance, at a peer that says what it did and when.

Held to: an order is begun once at most, not after its stop was answered, and not after its task has ended; a
task is done only if the peer has done its work; what a stop reaches stands; and the first advice, followed
each time, leads the cell back to work.
"""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from random import Random
from typing import Any, Protocol

from tests.patience import PATIENCE_S

from arboleda.drivers import Driver, NotSent, Stop, StopMode
from arboleda.model.messages import ENDED, Reason, TaskChanged, TaskState, Verb
from arboleda.runtime.build import App
from arboleda.views.readying import due_in_cell
from arboleda_lines.line import TIMED, Form
from arboleda_lines.relay import Relay

from .peer import BEGIN, DROP, END, Did

CELL = "shop"
GRACE_S = 0.1  # what is on its way in the peer itself, on a busy machine
UNDER_WAY = 0.7  # how much of what befalls an order does so once it was given
SEEN_S = 0.5  # until a driver sees that a line was cut
STANDS_S = 1.0  # until what a stop has reached stands
ENOUGH = 7  # acts that lead out of any state
SHORTEST_S, LONGEST_S = 0.05, 0.4  # of works
GOES = {"order": 46, "cancel": 14, "stop": 14, "cut": 9, "silence": 9, "refusal": 8}
GOES_BADLY = {"order": 30, "bad": 30, "bad_cancel": 20, "bad_stop": 20}  # with a relay before the line
DEAF = ("half_open", "reset", "left_over")  # forms in which a stop may not arrive
LATE_S = (0.05, 1.5)  # by how much an answer comes late, at least and at most
OVER = ENDED | {TaskState.REFUSED}


class Device(Protocol):
    """A peer that does what it is ordered."""

    did: list[Did]

    def say(self, *words: object) -> None:
        """Tell it: `takes SECONDS`, `refuses`."""


class Line(Protocol):
    """The line to it."""

    def cut(self, *, silent: bool) -> None: ...
    def mend(self) -> None: ...


@dataclass
class Sent:
    """A command that was given to the driver, and the error that it raised."""

    command: Any
    began: float
    ended: float = float("inf")
    error: BaseException | None = None

    @property
    def stopped(self) -> bool:
        """True for a stop that was answered."""
        is_stop = isinstance(self.command, Stop) and self.command.mode is not StopMode.CLEAR
        return is_stop and self.ended < float("inf") and self.error is None

    @property
    def is_order(self) -> bool:
        return not isinstance(self.command, Stop)


@contextmanager
def noted(driver: type[Driver], monkeypatch: Any) -> Iterator[list[Sent]]:
    """The commands that drivers of this class are given."""
    sent: list[Sent] = []
    send = driver.send

    def note(self: Driver, command: Any) -> None:
        sent.append(one := Sent(command, time.monotonic()))
        try:
            send(self, command)
        except BaseException as error:
            one.error = error
            raise
        finally:
            one.ended = time.monotonic()

    with monkeypatch.context() as patched:
        patched.setattr(driver, "send", note)
        yield sent


@dataclass
class Task:
    """A task of the day, and when it was asked for and when its end was told."""

    id: str
    goes: str
    began: float
    end: TaskChanged | None = None
    ended: float = float("inf")


@dataclass
class Day:
    """A plant at a peer; `run` it between `App.start` and `App.stop`."""

    app: App
    peer: Device
    line: Line
    sent: list[Sent]
    seed: int
    recipes: tuple[str, ...] = ("work", "other")
    goes: dict[str, int] = field(default_factory=lambda: dict(GOES))
    relay: Relay | None = None  # before the line
    forms: tuple[str, ...] = ()  # in which the relay is bad

    def __post_init__(self) -> None:
        self.found: list[str] = []
        self.counts: Counter[str] = Counter()
        self._tasks: list[Task] = []
        self._news = threading.Condition()
        self._bad: list[tuple[float, float, Form]] = []  # when the line was bad, and how
        self.form: Form | None = None  # in which the line was bad, in the last order
        self._snapshot: dict[str, Any] = {}
        self._seen_at = self._acted_at = 0.0  # the snapshot, and what was done to the plant
        self.app.watch(self._watch)
        self.app.listen(self._hear)

    def run(self, orders: int) -> None:
        """Go through the day; what is wrong is in `found`."""
        chance = Random(self.seed)
        self._lead_out("the start")
        for number in range(orders):
            goes = chance.choices([*self.goes], [*self.goes.values()])[0]
            self._go(chance, f"d{number}", goes)
            self._lead_out(f"d{number}, {goes} {self.form or ''}".strip())
        time.sleep(STANDS_S + GRACE_S)
        self._judge()

    def _go(self, chance: Random, id: str, goes: str) -> None:
        takes = chance.uniform(SHORTEST_S, LONGEST_S)
        self.form = None
        self.peer.say("takes", takes)
        if goes == "refusal":
            self.peer.say("refuses")
        task = Task(id, goes, time.monotonic())
        self._tasks.append(task)
        recipe = chance.choice(self.recipes)
        answer = self.app.plant.submit(f"{CELL} {recipe} #{id}").result(PATIENCE_S)
        if answer.state in OVER:
            self._end(task, answer)
        self._acted_at = time.monotonic()
        wait = chance.uniform(0, takes + 0.15)
        away = chance.uniform(0.05, 2.5)
        if goes in ("order", "refusal"):
            self._await(task)
            return
        if chance.random() < UNDER_WAY:
            self._wait_for_order(task)
        if goes.startswith("bad"):
            self._go_badly(chance, goes, wait, away)
        else:
            time.sleep(wait)
            self._meet(goes, away)
        self._acted_at = time.monotonic()
        self._await(task)

    def _meet(self, goes: str, away: float) -> None:
        """Let that befall the order."""
        if goes.endswith("cancel"):
            self.app.plant.operate(Verb.CANCEL, CELL).result(PATIENCE_S)
        elif goes.endswith("stop"):
            self.app.plant.operate(Verb.STOP, CELL).result(PATIENCE_S)
        elif goes in ("cut", "silence"):
            self.line.cut(silent=goes == "silence")
            time.sleep(away)
            self.line.mend()
            time.sleep(SEEN_S)

    def _go_badly(self, chance: Random, goes: str, wait: float, away: float) -> None:
        """The same while the line is bad."""
        assert self.relay is not None
        word = chance.choice(self.forms)
        self.form = Form(word=word, delay_s=round(chance.uniform(*LATE_S), 2) if word in TIMED else 0.0)
        self.counts[f"bad: {word}"] += 1
        began = time.monotonic()
        with self.relay.bad(self.form):
            time.sleep(wait)
            self._meet(goes, away)
            time.sleep(away)
        time.sleep(SEEN_S)
        self._bad.append((began, time.monotonic(), self.form))

    def _wait_for_order(self, task: Task) -> None:
        """Wait until the driver is given an order of the task, it ends, or the cell waits for somebody."""
        until = time.monotonic() + PATIENCE_S
        while task.end is None and not self._is_ordered(task) and not self._is_held():
            assert time.monotonic() < until, f"{task}; {self._snapshot['cells'][0]}"
            time.sleep(0.002)

    def _is_ordered(self, task: Task) -> bool:
        return bool(self.sent) and self.sent[-1].is_order and self.sent[-1].began > task.began

    def _await(self, task: Task) -> None:
        """Wait for the end of the task, or until the cell waits for somebody."""
        with self._news:
            over = self._news.wait_for(lambda: task.end is not None or self._is_held(), PATIENCE_S)
            assert over, f"{task}; {self._snapshot['cells'][0]}"

    def _lead_out(self, after: str) -> None:
        """Follow the first advice until the cell works and no task is open."""
        done: list[str] = []
        until = time.monotonic() + PATIENCE_S
        while time.monotonic() < until and len(done) <= ENOUGH:
            snapshot = self._next()
            self._acted_at = self._seen_at
            (cell,) = snapshot["cells"]
            due = due_in_cell(snapshot, cell)
            if due is None and cell["state"] == "idle":
                self.counts["acts"] += len(done)
                return
            if due is not None and due.is_act:
                way = due.advice
                assert way is not None
                verb = Verb(way["do"])
                arguments = tuple(way["arguments"].items())
                answer = self.app.plant.operate(
                    verb, way["scope"], by_hand=way["by_hand"], arguments=arguments
                ).result(PATIENCE_S)
                self._acted_at = time.monotonic()
                done.append(f"{way['do']} {answer.refusal or ''}".strip())
        raise AssertionError(f"after {after} {done} leads nowhere: {cell['held_by'] or cell['not_ready']}")

    def _next(self) -> dict[str, Any]:
        """A snapshot of after what was done last; there is one each second at least."""
        with self._news:
            assert self._news.wait_for(lambda: self._seen_at > self._acted_at, PATIENCE_S)
            return self._snapshot

    def _is_held(self) -> bool:
        if self._seen_at <= self._acted_at:
            return False
        (cell,) = self._snapshot["cells"]
        due = due_in_cell(self._snapshot, cell)
        return due is not None and due.is_act

    def _watch(self, snapshot: dict[str, Any]) -> None:
        with self._news:
            self._snapshot, self._seen_at = snapshot, time.monotonic()
            self._news.notify_all()

    def _hear(self, change: TaskChanged) -> None:
        if change.state in OVER:
            with self._news:
                for task in self._tasks:
                    if task.id == change.task:
                        self._end(task, change)
                self._news.notify_all()

    def _end(self, task: Task, change: TaskChanged) -> None:
        if task.end is None:
            task.end, task.ended = change, time.monotonic()

    def _judge(self) -> None:
        orders = [each for each in self.sent if each.is_order]
        begins = [each for each in self.peer.did if each.word == BEGIN]
        self.counts.update(
            f"{task.goes} {task.end.state.value if task.end else 'open'}" for task in self._tasks
        )
        self.counts["begun"] = len(begins)
        self.counts["orders"] = len(orders)
        begun: Counter[str] = Counter()
        for each in begins:
            before = [order for order in orders if order.began <= each.at]
            if not before:
                self.found.append(f"{each} was never ordered")
                continue
            order = before[-1]
            begun[order.command.id] += 1
            if order.ended < each.at and isinstance(order.error, NotSent):
                self.found.append(f"{each} is of {order.command}, of which nothing had left")
            self._judge_stops(each, order)
            task = [task for task in self._tasks if task.began <= each.at][-1]
            if each.at > task.ended + GRACE_S and order.began < task.ended:  # later ones are of acts
                late = each.at - task.ended
                self.found.append(f"{each} began {late:.3f} s after {task.id} had ended ({task.goes})")
        for order in orders:
            if begun[order.command.id] > 1:
                self.found.append(f"{order.command} was begun twice ({self._form_at(order.began)})")
        self._judge_stands()
        for task in self._tasks:
            self._judge_end(task)

    def _judge_stops(self, begin: Did, order: Sent) -> None:
        for stop in self.sent:
            if stop.stopped and order.began < stop.began and begin.at > stop.ended + GRACE_S:
                late = begin.at - stop.ended
                self.found.append(f"{begin} began {late:.3f} s after {stop.command} was answered")
                return

    def _judge_stands(self) -> None:
        """Whatever was begun before a stop that was answered is over soon."""
        did = self.peer.did
        for stop in (each for each in self.sent if each.stopped and not self._is_deaf(each.began)):
            before = [each for each in did if each.at <= stop.ended]
            if not before or before[-1].word != BEGIN:
                continue
            over = [each for each in did if each.at > before[-1].at]
            if not over or over[0].at > stop.ended + STANDS_S or over[0].word == BEGIN:
                form = self._form_at(stop.began)
                self.found.append(f"{before[-1]} went on after {stop.command} was answered ({form})")

    def _is_deaf(self, at: float) -> bool:
        """True while the device may not have heard what was sent."""
        return self._form_at(at).partition(" ")[0] in DEAF

    def _form_at(self, at: float) -> str:
        """The form in which the line was bad then; "" for none."""
        return next((str(form) for began, ended, form in self._bad if began <= at <= ended), "")

    def _judge_end(self, task: Task) -> None:
        here = [each for each in self.peer.did if task.began <= each.at <= task.ended]
        last = here[-1].word if here else None
        if task.end is None:
            self.found.append(f"{task.id} has no end ({task.goes})")
        elif task.end.state is TaskState.DONE and last != END:
            self.found.append(f"{task.id} is done ({task.goes}), and the peer: {here}")
        elif task.goes == "order" and task.end.state is not TaskState.DONE:
            self.found.append(f"{task.id} is not done: {task.end.sentence}")
        elif task.goes == "refusal" and task.end.reason is not Reason.REJECTED:
            self.found.append(f"{task.id} is not refused: {task.end}")
        if task.goes.endswith(("cancel", "stop")) and last == DROP:
            self.counts["dropped"] += 1
