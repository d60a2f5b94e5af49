"""Tools with which an assistant writes trees, and proposes content to people."""

from __future__ import annotations

from typing import Any

from arboleda_make.client import AsyncMake

from .desk import LOOK, PROPOSE, Call, Desk, Reply, Tools, program_of


class ProposalTools:
    """ProposalTools: trees are checked and copied; proposals are made, tried, looked at and taken back."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def tools(self) -> Tools:
        """All of them, with their hints."""
        looks = self.check_tree, self.copy_tree, self.proposals, self.proposal
        acts = self.propose, self.prove_proposal, self.simulate_proposal, self.withdraw
        return [*((each, LOOK) for each in looks), *((each, PROPOSE) for each in acts)]

    async def check_tree(self, call: Call, cell: str, xml: str) -> Reply:
        """Check the text of a file of trees (BehaviorTree.CPP XML) in a cell: what is wrong, where."""
        return await self._desk.look(call, lambda plant: AsyncMake(plant).check_tree(cell, xml))

    async def copy_tree(self, call: Call, cell: str, recipe: str, name: str) -> Reply:
        """A recipe in Python as the text of a tree `name` that does the same, where XML can say it."""
        return await self._desk.look(call, lambda plant: AsyncMake(plant).copy_tree(cell, recipe, name))

    async def propose(
        self,
        call: Call,
        name: str,
        words: str,
        trees: dict[str, str | None] | None = None,
        values: list[dict[str, Any]] | None = None,
        removed: list[list[str | int]] | None = None,
        recipes: list[str] | None = None,
    ) -> Reply:
        """Propose content to people; nothing of it is at work before a person approves it. `trees`: texts of
        files of trees, null for one that goes. `values`: {place, value} of the plant file, targets, new
        devices and new kinds: {"place": ["cells", "lab", "targets", "nest"], "value": {...}}. `removed`:
        places of targets that go. `recipes`: those of which you want to give tasks. A later one of the same
        name takes its place. With problems nothing is kept."""
        wanted: dict[str, Any] = {"trees": trees or {}, "values": values or [], "removed": removed or []}
        wanted |= {"name": name, "by": program_of(call), "words": words, "recipes": recipes or []}
        return await self._desk.look(call, lambda plant: AsyncMake(plant).propose(**wanted))

    async def proposals(self, call: Call) -> Reply:
        """The proposals, the last first: which are decided, and why one was rejected."""
        return await self._desk.look(call, lambda plant: AsyncMake(plant).proposals())

    async def proposal(self, call: Call, hash: str) -> Reply:
        """One proposal: its trees, their pictures (SVG), what was proved and simulated of it, what was
        decided and why."""
        return await self._desk.look(call, lambda plant: AsyncMake(plant).proposal(hash))

    async def prove_proposal(
        self, call: Call, hash: str, recipes: list[str] | None = None, budget_s: float = 60
    ) -> Reply:
        """Have the plant try a proposal without faults and with every single fault, beside itself, for 1 to
        600 s; look for the result in `proposal`: what it finds, and where it is known what would mend it."""
        chosen = recipes or []
        return await self._desk.look(
            call, lambda plant: AsyncMake(plant).prove_proposal(hash, recipes=chosen, budget_s=budget_s)
        )

    async def simulate_proposal(self, call: Call, hash: str, seeds: int = 5, cycles: int = 4) -> Reply:
        """Have the plant run a proposal on virtual devices with faults, 1 to 50 seeds, beside itself; look
        for the result in `proposal`."""
        return await self._desk.look(
            call, lambda plant: AsyncMake(plant).simulate_proposal(hash, seeds=seeds, cycles=cycles)
        )

    async def withdraw(self, call: Call, hash: str) -> Reply:
        """Take a proposal back that nobody has decided on."""
        return await self._desk.look(call, lambda plant: AsyncMake(plant).withdraw(hash))
