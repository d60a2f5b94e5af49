"""Draft of a plant's files over HTTP, edited under an id of this client's own."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Concatenate, ParamSpec, TypeVar

from arboleda.client import Awaiting, Blocking, Call, Line, Route, Routes, new_id, route
from arboleda.client.http import TIMEOUT_S
from arboleda.drivers import Value
from arboleda_make.answers.drafts import (
    AppliedDraft,
    CheckedDraft,
    DraftCells,
    DraftState,
    DriverRow,
    KeptDraft,
    RunState,
    TreesText,
)
from arboleda_make.answers.trees import Nodes

CHECKED_S = 330.0  # a check of the plant's files has five minutes
P = ParamSpec("P")
Result = TypeVar("Result")


class Edited(Routes):
    """Routes of a draft; `editor` is the id under which it is edited."""

    def __init__(self, of: Routes | Line, editor: str = "") -> None:
        super().__init__(of)
        self.editor = editor or new_id()


class Edit(Route[P, Result]):
    """Route that changes the draft: the id of its editor goes with the rest of the body."""

    def call(self, side: Routes, *args: Any, **named: Any) -> Call:
        assert isinstance(side, Edited)
        call = super().call(side, *args, **named)
        return replace(call, body={"editor": side.editor, **(call.body or {})})


def edit(
    path: str, answer: type[Result], *, within_s: float = TIMEOUT_S
) -> Callable[[Callable[Concatenate[Any, P], None]], Edit[P, Result]]:
    """Decorator that makes a method of a route that changes the draft."""
    return lambda declared: Edit("POST", path, answer, declared, within_s)


class DraftSteps(Edited):
    """Draft of the plant's files, edited under an id of this client's own."""

    @route("GET", "/api/draft", DraftState)
    def state(self) -> None:
        """The editor of the draft, and its changes."""

    @route("GET", "/api/draft/trees", TreesText)
    def trees(self, file: str) -> None:
        """A file of trees as the draft has it."""

    @edit("/api/draft/take", DraftState)
    def take(self, name: str) -> None:
        """Begin to edit in somebody's name, or take over."""

    @edit("/api/draft/set", DraftState)
    def set(self, place: Sequence[str | int], value: Any, of: str | None = None) -> None:
        """Set a value of the plant file, as at `["cells", "lab", "targets", "nest"]`; in no other draft than
        `of`, its digest."""

    @edit("/api/draft/remove", DraftState)
    def remove(self, place: Sequence[str | int]) -> None:
        """Remove a key."""

    @edit("/api/draft/set_trees", DraftState)
    def set_trees(self, file: str, text: str) -> None:
        """Give a file of trees another text."""

    @edit("/api/draft/remove_trees", DraftState)
    def remove_trees(self, file: str) -> None:
        """Take a file of trees out of it."""

    @edit("/api/draft/own", DraftState)
    def own(self) -> None:
        """Copy its files to a folder of one's own."""

    @edit("/api/draft/undo", DraftState)
    def undo(self) -> None:
        """Take the last step back."""

    @edit("/api/draft/redo", DraftState)
    def redo(self) -> None:
        """Do it again."""

    @edit("/api/draft/discard", DraftState)
    def discard(self) -> None:
        """Forget all of the draft."""

    @route("POST", "/api/draft/check", CheckedDraft, within_s=CHECKED_S)
    def check(self) -> None:
        """The findings of `arboleda check` on the draft."""

    @edit("/api/draft/keep", KeptDraft, within_s=CHECKED_S)
    def keep(self, note: str = "") -> None:
        """Check the draft, write it into the plant's files and keep a version, which the next start takes."""

    @edit("/api/draft/apply", AppliedDraft, within_s=CHECKED_S)
    def apply(self, note: str = "") -> None:
        """The same, and put the version to work: a cell takes it once its task has ended."""


class DraftAsPlant(Edited):
    """The draft as a plant: its cells, new recipes and devices, what is tried and proved of it."""

    @route("GET", "/api/make/cells", DraftCells, within_s=CHECKED_S)
    def cells(self) -> None:
        """The cells of the draft: devices, targets, recipes; and the faults that can befall it."""

    @route("GET", "/api/make/recipe", str, within_s=CHECKED_S)
    def recipe(self, cell: str, recipe: str) -> None:
        """The tree of a recipe, whoever wrote it, as XML."""

    @edit("/api/make/carry", DraftState, within_s=CHECKED_S)
    def carry(self, cell: str, recipe: str, robot: str, start: str, end: str) -> None:
        """Add a recipe that takes a part from one target to another."""

    @edit("/api/make/copy", DraftState, within_s=CHECKED_S)
    def copy(self, cell: str, recipe: str, name: str) -> None:
        """Add a recipe that is a tree and does what one in Python does."""

    @route("GET", "/api/make/palette", list[Nodes], within_s=CHECKED_S)
    def palette(self, cell: str, language: str = "en") -> None:
        """The nodes that a tree can have in a cell of the draft."""

    @route("GET", "/api/make/drivers", list[DriverRow], within_s=CHECKED_S)
    def drivers(self, language: str = "en") -> None:
        """The drivers that a device of a declared kind can have."""

    @edit("/api/make/device", DraftState, within_s=CHECKED_S)
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


class Draft(DraftSteps, DraftAsPlant, Blocking):
    """Draft of a plant's files, as `plant.draft()` makes it; one editor takes its steps, under an id."""


class AsyncDraft(DraftSteps, DraftAsPlant, Awaiting):
    """Draft of a plant's files, for asyncio: the methods of Draft, to be awaited."""
