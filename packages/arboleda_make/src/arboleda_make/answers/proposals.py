"""Proposals of assistants."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any

from .drafts import AppliedDraft, RunState


@dataclass(frozen=True, kw_only=True)
class ProposalBase:
    """Parts of the plant's files that a proposal can build on."""

    version: Annotated[str, "The digest of the version at work."]
    cells: dict[str, dict[str, Any]]
    kinds: dict[str, Any]
    trees: dict[str, str]


@dataclass(frozen=True, kw_only=True)
class ProposalRow:
    """Proposal without its trees."""

    hash: str
    name: str
    by: str
    words: Annotated[str, "The assistant's own words: text from outside."]
    at: str
    recipes: list[str]
    changes: list[str]
    warnings: list[str]
    made_for: Annotated[str, "The digest of the version of the plant that it was made for."]
    fits: Annotated[bool, "Whether that version is at work."]
    stage: Annotated[str, "open, replaced, withdrawn, rejected or approved."]
    decided_by: str
    decided_at: str
    reason: str
    version: Annotated[int | None, "The version that it became."]


@dataclass(frozen=True, kw_only=True)
class ProposalAnswer:
    """Proposal that was kept, or the problems for which it was not: then its hash is null."""

    hash: str | None
    problems: list[str]
    warnings: list[str]
    stage: str = ""
    reason: str = ""
    changes: list[str] = field(default_factory=list)


@dataclass(frozen=True, kw_only=True)
class WholeProposal(ProposalRow):
    """Proposal with its trees, as text and as pictures, and with what was proved and simulated of it."""

    trees: dict[str, str]
    differing: Annotated[list[str], "Those of its files of trees that are others than at work."]
    differences: Annotated[dict[str, str], "By file of trees the lines that come (+) and go (-)."]
    pictures: Annotated[dict[str, str], "Of these, as SVG."]
    proof: dict[str, Any] | None
    proof_state: RunState
    simulation: dict[str, Any] | None
    simulation_state: RunState


@dataclass(frozen=True, kw_only=True)
class DecidedProposal(ProposalRow, AppliedDraft):
    """Proposal that was approved and put to work; with problems neither is done."""
