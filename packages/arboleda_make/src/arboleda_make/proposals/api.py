"""Proposals of assistants as the web server sees them, and the tasks that assistants give."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from ..drafts.api import State


class ProposalsApi(Protocol):
    """Proposals of one plant, as plain data with the keys of types in `arboleda_make.answers`.

    DraftRefused, and nothing is changed, where it cannot be. `hash` names the content of one. Who
    calls these has the role for it.
    """

    @abstractmethod
    def base(self) -> State:
        """Files of the plant to build on: ProposalBase."""

    @abstractmethod
    def propose(self, wanted: Mapping[str, Any]) -> State:
        """Check content that an assistant wrote, and keep it as a proposal: `name`, `by`, `words`, `trees`,
        `values`, `removed`, `recipes`. ProposalAnswer."""

    @abstractmethod
    def listed(self) -> list[State]:
        """The proposals, the last first: a ProposalRow each."""

    @abstractmethod
    def shown(self, hash: str) -> State:
        """All of one: WholeProposal."""

    @abstractmethod
    def prove(self, hash: str, recipes: Sequence[str], budget_s: float) -> State:
        """Begin to prove it in a process beside the plant; the run's state."""

    @abstractmethod
    def simulate(self, hash: str, seeds: int, cycles: int) -> State:
        """Begin to run it on virtual devices with faults, in a process beside the plant; the run's state."""

    @abstractmethod
    def withdraw(self, hash: str) -> State:
        """End one that is not decided."""

    @abstractmethod
    def approve(self, hash: str, by: str) -> State:
        """Approve this content in a person's name and put it to work; as `VersionsApi.put`."""

    @abstractmethod
    def reject(self, hash: str, by: str, reason: str) -> State:
        """Reject it in a person's name, for a reason that the assistant reads."""

    @abstractmethod
    def submit(self, text: str, by: str) -> State:
        """Give a task in an assistant's name, of a recipe that is approved, within the limits of the file."""
