"""Shelf of proposals: a file for each, written once, and one for what was decided, in the state directory."""

from __future__ import annotations

import json
import threading
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from enum import Enum
from pathlib import Path
from typing import Any

from arboleda.drivers import quoted
from arboleda.extension import ConfigError, StartError
from arboleda.runtime.state import replace_file
from arboleda_make.drafts.api import DraftRefused
from arboleda_make.proposals.proposal import Proposal, from_data

FOLDER, ENDING, DECIDED = "proposals", ".json", ".decided.json"
MOST_DECIDED = 200  # the oldest that are at work no more make room
UNKNOWN = "there is no proposal {hash}; it may have been forgotten"
DAMAGED = "the proposal {hash} is not what was proposed any more, so nobody can approve it: {error}"


class Stage(str, Enum):
    """Stage of a proposal; all but the first one are final."""

    OPEN = "open"
    REPLACED = "replaced"
    WITHDRAWN = "withdrawn"
    REJECTED = "rejected"
    APPROVED = "approved"


@dataclass(frozen=True, kw_only=True)
class Decision:
    """Decision on a proposal: by whom, when, and the `reason` of a rejection.

    An approval has the digest of the `content` that was approved, and the number of the `version` that it
    became, None where there was nothing to put to work, or not yet.
    """

    stage: Stage = Stage.OPEN
    by: str = ""
    at: str = ""
    reason: str = ""
    content: str = ""
    version: int | None = None


class Shelf:
    """Shelf: all proposals of a plant that are known, for any thread. What `keep` and `decide` return from is
    on the disk."""

    def __init__(self, state: Path) -> None:
        self._folder = state / FOLDER
        self._turns = threading.Lock()

    def all(self) -> list[tuple[Proposal, Decision]]:
        """Every proposal that is whole, the oldest first."""
        found = []
        for hash in self._hashes():
            try:
                found.append((self._proposal(hash), self.decision(hash)))
            except DraftRefused:
                continue
        return sorted(found, key=lambda pair: pair[0].at)

    def find(self, hash: str) -> tuple[Proposal, Decision]:
        """A proposal as its hash was made of it, and what was decided; DraftRefused where there is none."""
        if hash not in self._hashes():
            raise DraftRefused(UNKNOWN.format(hash=quoted(hash)))
        return self._proposal(hash), self.decision(hash)

    def keep(self, proposal: Proposal) -> None:
        """Keep a new proposal; StartError, and nothing is kept, if the disk refuses."""
        with self._turns:
            self._write(proposal.hash + ENDING, proposal.data())

    def decide(self, hash: str, decision: Decision) -> None:
        """Keep what was decided; StartError if the disk refuses."""
        with self._turns:
            self._write(hash + DECIDED, {**asdict(decision), "stage": decision.stage.value})

    def forget_old(self, kept: str) -> None:
        """Forget the oldest of many that are decided, but for those approved with the content `kept`."""
        decided = [
            (proposal, decision)
            for proposal, decision in self.all()
            if decision.stage is not Stage.OPEN and decision.content != kept
        ]
        for proposal, _ in decided[: max(0, len(decided) - MOST_DECIDED)]:
            for ending in (ENDING, DECIDED):
                (self._folder / (proposal.hash + ending)).unlink(missing_ok=True)

    def decision(self, hash: str) -> Decision:
        """The decision on a proposal; DraftRefused where it cannot be read."""
        file = self._folder / (hash + DECIDED)
        try:
            data = json.loads(file.read_text("utf-8"))
            return Decision(**{**data, "stage": Stage(data["stage"])})
        except FileNotFoundError:
            return Decision()
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise DraftRefused(DAMAGED.format(hash=hash[:12], error=error)) from error

    def _proposal(self, hash: str) -> Proposal:
        try:
            found = from_data(json.loads((self._folder / (hash + ENDING)).read_text("utf-8")))
        except (OSError, ValueError, ConfigError) as error:
            raise DraftRefused(DAMAGED.format(hash=hash[:12], error=error)) from error
        if found.hash != hash:
            raise DraftRefused(DAMAGED.format(hash=hash[:12], error="its file has another one"))
        return found

    def _hashes(self) -> list[str]:
        if not self._folder.is_dir():
            return []
        names = (each.name for each in self._folder.iterdir() if not each.name.startswith("."))
        return [
            name.removesuffix(ENDING)
            for name in names
            if name.endswith(ENDING) and not name.endswith(DECIDED)
        ]

    def _write(self, name: str, data: Mapping[str, Any]) -> None:
        try:
            self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            replace_file(self._folder / name, json.dumps(data, ensure_ascii=True) + "\n")
        except OSError as error:
            raise StartError(f"{self._folder} cannot be written: {error.strerror or error}") from error
