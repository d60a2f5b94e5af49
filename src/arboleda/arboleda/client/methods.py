"""Methods of the client: a route of the HTTP API each, and those that ask several times."""

from __future__ import annotations

import secrets
from collections.abc import AsyncGenerator, Mapping, Sequence
from dataclasses import asdict
from typing import Any

from arboleda.model.facts import Value
from arboleda.model.verbs import Verb

from .answers.drafts import (
    AppliedDraft,
    CheckedDraft,
    DraftCells,
    DraftState,
    DriverRow,
    KeptDraft,
    RunState,
    TreesText,
)
from .answers.offers import AssistantLevel, CellOee, FaultList, Offer, Promise, ProvokedFault
from .answers.plant import Event, Snapshot
from .answers.proposals import DecidedProposal, ProposalAnswer, ProposalBase, ProposalRow, WholeProposal
from .answers.reports import TaskReport
from .answers.rows import Rows
from .answers.tasks import Act, Done, KeptTask, Task
from .answers.trees import Drawn, Nodes, TreeCopy, TreeFile
from .answers.versions import VersionList
from .calls import Side, flow, following, read_answer, route
from .errors import NotFound, StillRunning
from .http import TIMEOUT_S
from .line import LOOK_S, Call, path_of

CHECKED_S = 330.0  # a check of the plant's files has five minutes
REPORT_S = 120.0  # the record of a long task takes a while to be executed again
STOP_S = 2.5  # a stop is answered within some ms; then the next address is told it, or this one again
ACT_S = 120.0  # a homing may take a minute


class Looks(Side):
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

    @route("GET", "/api/oee", list[CellOee])
    def oee(self, *, cell: str = "", since: float | None = None, until: float | None = None) -> None:
        """The OEE of the cells, of the last 24 hours where no time is given (Unix times, in seconds)."""

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


class Tasks(Side):
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

    @flow("GET /api/tasks/{task_id}/report")
    async def report(self, task_id: str, *, within_s: float = REPORT_S) -> TaskReport:
        """Why a task failed: its cause, and the evidence. The plant may have to write it first, out of its
        record; after `within_s` it is as it is then. NotFound, with the reason, where there is none."""
        path = path_of("/api/tasks/{task_id}/report", {"task_id": task_id})
        until = self._line.clock() + within_s
        while True:
            data = await self._line.data(Call(method="GET", path=path, is_repeatable=True))
            report = read_answer(TaskReport, data)
            if report.state == "written" or self._line.clock() >= until:
                return report
            await self._line.http.sleep(LOOK_S)


class Verbs(Side):
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


class Versions(Side):
    """Looks at the versions of a plant's files, and puts them to work."""

    @route("GET", "/api/versions", VersionList)
    def versions(self) -> None:
        """The versions that were put to work, which one is, and what each cell works by."""

    @route("POST", "/api/versions/{number}/put", AppliedDraft, within_s=CHECKED_S)
    def put(self, number: int, name: str) -> None:
        """Put a version to work, in somebody's name; a cell takes it once its task has ended."""

    @route("POST", "/api/versions/restart", VersionList)
    def restart(self, name: str, wanted: bool = True) -> None:
        """Have the plant restart with its files as they are now, once all its cells rest."""


class Faults(Side):
    """Has faults of the simulator happen to virtual devices."""

    @route("GET", "/api/faults", FaultList)
    def faults(self) -> None:
        """The faults that were provoked and go on, and those that can be."""

    @route("POST", "/api/faults", ProvokedFault)
    def provoke(self, kind: str, robot: str, seconds: float | None = None) -> None:
        """Have a fault happen to a virtual device, for 5 s where no time is given and the kind lasts."""

    @route("POST", "/api/faults/end", list[ProvokedFault])
    def end_faults(self, robot: str = "", number: int | None = None) -> None:
        """End faults before their time: one by its number, all of a device, or all; those that went on."""


class Proposals(Side):
    """Proposals of assistants, the decisions of people on them, and tasks that assistants give."""

    @route("GET", "/api/proposals", list[ProposalRow])
    def proposals(self) -> None:
        """The proposals, the last first."""

    @route("GET", "/api/proposals/base", ProposalBase)
    def proposal_base(self) -> None:
        """Targets, kinds of devices and trees at work, on which a proposal can build."""

    @route("GET", "/api/proposals/{hash}", WholeProposal)
    def proposal(self, hash: str) -> None:
        """One proposal: its trees, what was proved of it, and what was decided."""

    @route("POST", "/api/proposals", ProposalAnswer, within_s=CHECKED_S)
    def propose(
        self,
        name: str,
        by: str,
        words: str = "",
        trees: Mapping[str, str | None] | None = None,
        values: Sequence[Mapping[str, Any]] = (),
        removed: Sequence[Sequence[str | int]] = (),
        recipes: Sequence[str] = (),
    ) -> None:
        """Have content checked and kept for a person to decide on; nothing of it is at work by that."""

    @route("POST", "/api/proposals/{hash}/prove", RunState)
    def prove_proposal(self, hash: str, recipes: Sequence[str] = (), budget_s: float = 60) -> None:
        """Begin to try every single fault at every kind of moment of it; its result is in `proposal`."""

    @route("POST", "/api/proposals/{hash}/simulate", RunState)
    def simulate_proposal(self, hash: str, seeds: int = 5, cycles: int = 4) -> None:
        """Begin to run it on virtual devices with faults; its result is in `proposal`."""

    @route("POST", "/api/proposals/{hash}/withdraw", ProposalRow)
    def withdraw(self, hash: str) -> None:
        """Take a proposal back that nobody has decided on."""

    @route("POST", "/api/proposals/{hash}/approve", DecidedProposal, within_s=CHECKED_S)
    def approve(self, hash: str, name: str) -> None:
        """Approve this content in a person's name, and put it to work."""

    @route("POST", "/api/proposals/{hash}/reject", ProposalRow)
    def reject(self, hash: str, name: str, reason: str) -> None:
        """Reject it in a person's name, for a reason that the assistant reads."""

    @flow("POST /api/assistants/tasks")
    async def give(self, text: str, by: str) -> Task:
        """Queue a task as an assistant: of an approved recipe, within the limits of the plant file; Conflict
        where it may not. One without an id gets one here, as `submit` gives it."""
        text = text if "#" in text else f"{text} #{new_id()}"
        call = Call(
            method="POST",
            path="/api/assistants/tasks",
            body={"text": text, "by": by},
            is_repeatable=True,
        )
        return read_answer(Task, await self._line.data(call))


class Trees(Side):
    """Looks at trees as XML, checks and edits their text; nothing is kept."""

    @route("GET", "/api/trees", list[TreeFile])
    def trees(self) -> None:
        """The files of trees that are recipes of this plant, as they were read."""

    @route("GET", "/api/trees/palette", list[Nodes])
    def palette(self, cell: str, language: str = "en") -> None:
        """All nodes that a tree can have in a cell."""

    @route("POST", "/api/trees/check", Drawn)
    def check_tree(self, cell: str, text: str) -> None:
        """A file of trees, with what `check` says of each node in a cell."""

    @route("POST", "/api/trees/copy", TreeCopy)
    def copy_tree(self, cell: str, recipe: str, name: str) -> None:
        """A recipe in Python as a tree that does the same; refused where no tree in XML can say it."""

    @route("POST", "/api/trees/edit", Drawn)
    def edit_tree(self, cell: str, text: str, operation: Mapping[str, Any]) -> None:
        """The same file after an operation, as `/api/docs` lists them."""


class DraftSteps(Side):
    """Draft of the plant's files, edited under an id of this client's own."""

    @route("GET", "/api/draft", DraftState)
    def state(self) -> None:
        """The editor of the draft, and its changes."""

    @route("GET", "/api/draft/trees", TreesText)
    def trees(self, file: str) -> None:
        """A file of trees as the draft has it."""

    @route("POST", "/api/draft/take", DraftState, by_editor=True)
    def take(self, name: str) -> None:
        """Begin to edit in somebody's name, or take over."""

    @route("POST", "/api/draft/set", DraftState, by_editor=True)
    def set(self, place: Sequence[str | int], value: Any, of: str | None = None) -> None:
        """Set a value of the plant file, as at `["cells", "lab", "targets", "nest"]`; in no other draft than
        `of`, its digest."""

    @route("POST", "/api/draft/remove", DraftState, by_editor=True)
    def remove(self, place: Sequence[str | int]) -> None:
        """Remove a key."""

    @route("POST", "/api/draft/set_trees", DraftState, by_editor=True)
    def set_trees(self, file: str, text: str) -> None:
        """Give a file of trees another text."""

    @route("POST", "/api/draft/remove_trees", DraftState, by_editor=True)
    def remove_trees(self, file: str) -> None:
        """Take a file of trees out of it."""

    @route("POST", "/api/draft/own", DraftState, by_editor=True)
    def own(self) -> None:
        """Copy its files to a folder of one's own."""

    @route("POST", "/api/draft/undo", DraftState, by_editor=True)
    def undo(self) -> None:
        """Take the last step back."""

    @route("POST", "/api/draft/redo", DraftState, by_editor=True)
    def redo(self) -> None:
        """Do it again."""

    @route("POST", "/api/draft/discard", DraftState, by_editor=True)
    def discard(self) -> None:
        """Forget all of the draft."""

    @route("POST", "/api/draft/check", CheckedDraft, within_s=CHECKED_S)
    def check(self) -> None:
        """The findings of `arboleda check` on the draft."""

    @route("POST", "/api/draft/keep", KeptDraft, within_s=CHECKED_S, by_editor=True)
    def keep(self, note: str = "") -> None:
        """Check the draft, write it into the plant's files and keep a version, which the next start takes."""

    @route("POST", "/api/draft/apply", AppliedDraft, within_s=CHECKED_S, by_editor=True)
    def apply(self, note: str = "") -> None:
        """The same, and put the version to work: a cell takes it once its task has ended."""


class DraftAsPlant(Side):
    """The draft as a plant: its cells, new recipes and devices, what is tried and proved of it."""

    @route("GET", "/api/make/cells", DraftCells, within_s=CHECKED_S)
    def cells(self) -> None:
        """The cells of the draft: devices, targets, recipes; and the faults that can befall it."""

    @route("GET", "/api/make/recipe", str, within_s=CHECKED_S)
    def recipe(self, cell: str, recipe: str) -> None:
        """The tree of a recipe, whoever wrote it, as XML."""

    @route("POST", "/api/make/carry", DraftState, within_s=CHECKED_S, by_editor=True)
    def carry(self, cell: str, recipe: str, robot: str, start: str, end: str) -> None:
        """Add a recipe that takes a part from one target to another."""

    @route("POST", "/api/make/copy", DraftState, within_s=CHECKED_S, by_editor=True)
    def copy(self, cell: str, recipe: str, name: str) -> None:
        """Add a recipe that is a tree and does what one in Python does."""

    @route("GET", "/api/make/palette", list[Nodes], within_s=CHECKED_S)
    def palette(self, cell: str, language: str = "en") -> None:
        """The nodes that a tree can have in a cell of the draft."""

    @route("GET", "/api/make/drivers", list[DriverRow], within_s=CHECKED_S)
    def drivers(self, language: str = "en") -> None:
        """The drivers that a device of a declared kind can have."""

    @route("POST", "/api/make/device", DraftState, within_s=CHECKED_S, by_editor=True)
    def add_device(
        self,
        cell: str,
        role: str,
        kind: str,
        driver: str = "",
        settings: Mapping[str, str] | None = None,
        declared: Mapping[str, Any] | None = None,
        keys: Mapping[str, Any] | None = None,
    ) -> None:
        """Add a device, or change it, with its driver, and its kind where that is new or changed."""

    @route("GET", "/api/make/runs/{what}", RunState)
    def run(self, what: str) -> None:
        """Progress of what is tried or proved: `try`, `prove`, `notice` or `reach`."""

    @route("POST", "/api/make/runs/{what}", RunState)
    def begin(
        self,
        what: str,
        task: str = "",
        answers: Mapping[str, Value] | None = None,
        faults: Sequence[Mapping[str, Any]] = (),
        recipes: Sequence[str] = (),
        kinds: Sequence[str] = (),
        budget_s: float = 60,
    ) -> None:
        """Begin to try a task of the draft as it is now, or to prove its recipes within a budget of time."""

    @route("POST", "/api/make/runs/{what}/end", RunState)
    def end(self, what: str) -> None:
        """End it, wherever it is."""

    @route("GET", "/api/make/runs/{what}/result", dict[str, Any])
    def result(self, what: str) -> None:
        """Result of the last run."""


def new_id() -> str:
    """An id that nobody else has: of a task, or of an editor."""
    return f"c-{secrets.token_hex(6)}"


async def _submitted(side: Side, body: Mapping[str, Any]) -> Task:
    call = Call(method="POST", path="/api/tasks", body=body, is_repeatable=True)  # it has an id
    return read_answer(Task, await side._line.data(call))


async def _followed(side: Side, task_id: str, until: float | None) -> AsyncGenerator[Task, None]:
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


async def _found(side: Side, task_id: str) -> Task:
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
