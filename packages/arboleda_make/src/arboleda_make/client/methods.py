"""Methods of a plant over HTTP: versions, trees, proposals and the draft."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from arboleda.client import Awaiting, Blocking, Call, Routes, Task, flow, new_id, read_answer, route
from arboleda_make.answers.drafts import AppliedDraft, RunState
from arboleda_make.answers.proposals import (
    DecidedProposal,
    ProposalAnswer,
    ProposalBase,
    ProposalRow,
    WholeProposal,
)
from arboleda_make.answers.trees import Drawn, Nodes, TreeCopy, TreeFile
from arboleda_make.answers.versions import VersionList

from .draft import CHECKED_S, AsyncDraft, Draft


class Versions(Routes):
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


class Trees(Routes):
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


class Proposals(Routes):
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


class MakeRoutes(Versions, Trees, Proposals):
    """Methods that a plant has where this package is installed."""

    def draft(self, editor: str = "") -> Draft | AsyncDraft:
        """The draft of its files, under the id of an editor or a new one; `take` begins to edit it."""
        return Draft(self, editor) if isinstance(self, Blocking) else AsyncDraft(self, editor)


class Make(MakeRoutes, Blocking):
    """Methods of Make for a plant, with types: `Make(plant).draft()` is `plant.draft()`."""

    def draft(self, editor: str = "") -> Draft:
        """The draft of its files, under the id of an editor or a new one; `take` begins to edit it."""
        return Draft(self, editor)


class AsyncMake(MakeRoutes, Awaiting):
    """Methods of Make for an AsyncPlant, to be awaited."""

    def draft(self, editor: str = "") -> AsyncDraft:
        """The draft of its files, as `Make.draft`."""
        return AsyncDraft(self, editor)
