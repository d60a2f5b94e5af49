"""Tools that look at tasks, and the one that gives one."""

from __future__ import annotations

from typing import Any, Literal

from arboleda_make.client import AsyncMake
from arboleda_proofs.client import AsyncProofs

from .desk import GIVE, LOOK, Call, Desk, Reply, Tools, program_of

State = Literal["", "queued", "running", "done", "failed", "cancelled"]


class TaskTools:
    """TaskTools: tasks of now and before, why they failed, and those that an assistant may give."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def tools(self) -> Tools:
        """All of them, with their hints."""
        found = self.tasks, self.task, self.history, self.why_failed, self.worked
        return [*((each, LOOK) for each in found), (self.give_task, GIVE)]

    async def tasks(self, call: Call) -> Reply:
        """The open tasks and those that ended last."""
        return await self._desk.look(call, lambda plant: plant.tasks())

    async def task(self, call: Call, task_id: str) -> Reply:
        """One task by its id."""
        return await self._desk.look(call, lambda plant: plant.task(task_id))

    async def history(
        self,
        call: Call,
        cell: str = "",
        state: State = "",
        recipe: str = "",
        words: str = "",
        before: int | None = None,
        limit: int = 50,
    ) -> Reply:
        """Tasks of all starts, the last accepted first; the next page is `before` the last number."""
        wanted: dict[str, Any] = {"cell": cell, "state": state, "recipe": recipe, "words": words}
        return await self._desk.look(call, lambda plant: plant.history(**wanted, before=before, limit=limit))

    async def why_failed(self, call: Call, task_id: str) -> Reply:
        """The cause of a task's failure, and the evidence, out of the flight record. It may take a minute."""
        return await self._desk.look(call, lambda plant: AsyncProofs(plant).report(task_id))

    async def worked(self, call: Call, cell: str = "") -> Reply:
        """The OEE of the cells over the last 24 hours: availability, performance, quality."""
        return await self._desk.look(call, lambda plant: plant.get("/api/oee", {"cell": cell}))

    async def give_task(self, call: Call, text: str) -> Reply:
        """Give a task, such as `lab to_tray #lot42`: of a recipe that a person approved as it is at work, in
        the cells, hours and number that the plant file allows. It moves robots."""
        by = program_of(call)
        return await self._desk.look(call, lambda plant: AsyncMake(plant).give(text, by))
