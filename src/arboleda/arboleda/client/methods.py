"""Methods of the client: a route of the runner each, and those that ask several times."""

from __future__ import annotations

import secrets
from collections.abc import AsyncGenerator, Mapping, Sequence
from dataclasses import asdict
from typing import Any

from arboleda.model.facts import Value
from arboleda.model.outside import quoted
from arboleda.model.verbs import Verb

from .answers.offers import AssistantLevel, Offer, Promise
from .answers.plant import Event, Snapshot
from .answers.rows import Rows
from .answers.tasks import Act, Done, KeptTask, Task
from .calls import Routes, flow, following, read_answer, route
from .errors import NotFound, PlantError, StillRunning
from .http import TIMEOUT_S
from .line import LOOK_S, Call, path_of

STOP_S = 2.5  # a stop is answered within some ms; then the next address is told it, or this one again
ACT_S = 120.0  # a homing may take a minute


class Asking(Routes):
    """Asks a plant by the address of a route, as one of a package that adds no method of its own."""

    @flow()
    async def get(
        self, path: str, query: Mapping[str, Any] | None = None, *, within_s: float = TIMEOUT_S
    ) -> Any:
        """The JSON that a route of the plant answers, as plain data: `plant.get("/api/ended")`."""
        call = Call(method="GET", path=path, query=query or {}, is_repeatable=True, within_s=within_s)
        return await _asked(self, call)

    @flow()
    async def post(
        self,
        path: str,
        body: Mapping[str, Any] | None = None,
        *,
        is_repeatable: bool = False,
        within_s: float = TIMEOUT_S,
    ) -> Any:
        """Have a route do something, `plant.post("/api/orders", {"part": "lid"})`; its answer, as plain data.
        It is asked again after a cut only where that does no harm, `is_repeatable`."""
        call = Call(method="POST", path=path, body=body, is_repeatable=is_repeatable, within_s=within_s)
        return await _asked(self, call)


class Looks(Routes):
    """Looks at a plant."""

    @route("GET", "/api/plant", Snapshot)
    def snapshot(self) -> None:
        """The whole plant: cells with their trees, devices, tasks, zones, what operators did last."""

    @route("GET", "/api/recipes", list[Offer])
    def recipes(self) -> None:
        """The recipes of each cell, their parameters, and the values that these can have."""

    @route("GET", "/api/assistants", AssistantLevel)
    def assistants(self) -> None:
        """The level of assistants, over `arboleda mcp`, in the plant file, and the limits of their tasks."""

    @route("GET", "/api/promises", list[Promise])
    def promises(self, text: str) -> None:
        """The time at which each cell named by a task text would have done it; queues no task."""

    @route("GET", "/api/history", Rows[KeptTask])
    def history(
        self,
        *,
        cell: str = "",
        state: str = "",
        recipe: str = "",
        words: str = "",
        since: float | None = None,
        until: float | None = None,
        before: int | None = None,
        limit: int = 100,
    ) -> None:
        """Tasks of all starts, the last accepted first, at most 1000; the next page is `before` the last
        `number`."""

    @route("GET", "/api/history.csv", str)
    def history_csv(
        self,
        *,
        cell: str = "",
        state: str = "",
        recipe: str = "",
        words: str = "",
        since: float | None = None,
        until: float | None = None,
        before: int | None = None,
        limit: int = 100,
    ) -> None:
        """The same as a table for other programs, with a line of names."""

    @following("GET /api/events")
    async def events(self) -> AsyncGenerator[Event, None]:
        """Changes as they happen, for ever: a snapshot first, and again where something was missed. After a
        cut, or with the next leader, it goes on by itself."""
        async for event in self._line.events():
            yield event


class Tasks(Routes):
    """Gives tasks to a plant, and follows them."""

    @route("GET", "/api/tasks", list[Task])
    def tasks(self) -> None:
        """The open tasks and those that ended last, in the order of their acceptance."""

    @route("GET", "/api/tasks/{task_id}", Task)
    def task(self, task_id: str) -> None:
        """One task by its id."""

    @flow("POST /api/tasks")
    async def submit(self, text: str, *, why: str = "") -> Task:
        """Queue a task as it is written on the command line; WrongRequest where it is refused, Later where
        its queue is full. One without an id (`#lot42`) gets one here, so that an answer that was lost never
        makes two of it."""
        text = text if "#" in text else f"{text} #{new_id()}"
        return await _submitted(self, {"text": text, "why": why} if why else {"text": text})

    @flow("POST /api/tasks")
    async def submit_form(
        self,
        *,
        cell: str = "",
        any_of: Sequence[str] = (),
        recipe: str = "",
        values: Mapping[str, Value] | None = None,
        id: str = "",
    ) -> Task:
        """Queue a task by the names and values of `recipes`; for a cell, or for any of several."""
        where = {"any_of": list(any_of)} if any_of else {"cell": cell}
        form = {**where, "recipe": recipe, "values": dict(values or {}), "id": id or new_id()}
        return await _submitted(self, form)

    @following("GET /api/events")
    async def follow(self, task_id: str) -> AsyncGenerator[Task, None]:
        """A task at each change of its state, until it has ended, as it is now first."""
        async for task in _followed(self, task_id, None):
            yield task

    @flow("GET /api/events", "GET /api/tasks/{task_id}", "GET /api/history")
    async def wait(self, task_id: str, *, within_s: float | None = None) -> Task:
        """A task once it has ended, whatever its end; StillRunning if not within `within_s`."""
        until = None if within_s is None else self._line.clock() + within_s
        async for task in _followed(self, task_id, until):
            if task.has_ended:
                return task
        task = await _found(self, task_id)
        if not task.has_ended:
            raise StillRunning(task)
        return task


class Verbs(Routes):
    """Operates a plant."""

    @flow("POST /api/plant/{verb}", "POST /api/cells/{scope}/{verb}")
    async def operate(
        self, /, verb: Verb | str, scope: str = "", *, by_hand: bool = False, **arguments: int | str
    ) -> Done:
        """Have the plant (no scope), a cell, robot, zone or task carry out a verb, with its arguments by
        name; Conflict where it does not now. What may move something is never asked again by itself."""
        word = verb.value if isinstance(verb, Verb) else verb
        template = "/api/cells/{scope}/{verb}" if scope else "/api/plant/{verb}"
        stops = word == Verb.STOP.value
        body = {**arguments, **({"by_hand": True} if by_hand else {})}
        call = Call(
            method="POST",
            path=path_of(template, {"scope": scope, "verb": word}),
            body=body or None,
            is_repeatable=stops,
            within_s=STOP_S if stops else TIMEOUT_S,
        )
        return read_answer(Done, await self._line.data(call))

    @flow("POST /api/plant/{verb}", "POST /api/cells/{scope}/{verb}")
    async def stop(self, scope: str = "") -> Done:
        """Stop (software) the plant, a cell or a robot: halt and latch. It is no safety function."""
        done: Done = await Verbs.operate.work(self, Verb.STOP, scope)
        return done

    @route("GET", "/api/acts/{number}", Act)
    def act(self, number: int) -> None:
        """The present state of an operator's act; the last 20 acts are known."""

    @flow("GET /api/acts/{number}")
    async def outcome(self, number: int, *, within_s: float = ACT_S) -> Act:
        """An act once it has ended; after `within_s` as it is then."""
        until = self._line.clock() + within_s
        while True:
            act: Act = await Verbs.act.work(self, number)
            if act.outcome != "under_way" or self._line.clock() >= until:
                return act
            await self._line.http.sleep(LOOK_S)


def new_id() -> str:
    """An id that nobody else has: of a task, or of an editor."""
    return f"c-{secrets.token_hex(6)}"


async def _asked(side: Routes, call: Call) -> Any:
    """The answer to a call whose path a user wrote: without / it could lead the token to another host."""
    if not call.path.startswith("/"):
        raise PlantError(
            f"The path of a route begins with /, as in /api/plant; {quoted(call.path)} does not."
        )
    reply = await side._line.reply(call)
    return reply.content() if reply.text else None


async def _submitted(side: Routes, body: Mapping[str, Any]) -> Task:
    call = Call(method="POST", path="/api/tasks", body=body, is_repeatable=True)  # it has an id
    return read_answer(Task, await side._line.data(call))


async def _followed(side: Routes, task_id: str, until: float | None) -> AsyncGenerator[Task, None]:
    state = ""
    async for event in side._line.events(until=until):
        if event.kind != "snapshot" and (event.kind != "task" or event.row["id"] != task_id):
            continue
        task = await _found(side, task_id)
        if task.state != state:
            state = task.state
            yield task
        if task.has_ended:
            return


async def _found(side: Routes, task_id: str) -> Task:
    """A task by its id; a leader may know those that ended under the one before by its history alone."""
    try:
        task: Task = await Tasks.task.work(side, task_id)
        return task
    except NotFound:
        for row in await Looks.history.work(side, words=task_id):
            if row.id == task_id:
                return as_task(row)
        raise


def as_task(row: KeptTask) -> Task:
    """A task of the history as one of the plant, without its choice: the history has another sentence."""
    return read_answer(Task, {**asdict(row), "choice": None})
