"""Tries of proposals: `arboleda prove` or `simulate` on one, in a process beside the plant."""

from __future__ import annotations

import json
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from arboleda_make.drafts.api import DraftRefused
from arboleda_make.proposals.proposal import Proposal

from ..trying.errands import ErrandRun, Work

RESULT = "result.json"
PROVING = Work(module="proving", command="prove")
SIMULATING = Work(module="simulating", command="simulate")
FOLDERS = {PROVING: "proposal_proofs", SIMULATING: "proposal_simulations"}
BUSY = "another proposal is being tried; try again when that has ended"


class Tries:
    """Tries: their results stay for the next start; `stop` ends the one that is under way."""

    def __init__(self, work: Work, state: Path) -> None:
        self._work = work
        self._home = state / FOLDERS[work]
        self._turns = threading.Lock()
        self._hash = ""
        self._run: ErrandRun | None = None

    def begin(self, proposal: Proposal, plant_file: Path, wanted: Mapping[str, Any]) -> dict[str, Any]:
        """Begin to try a proposal anew; DraftRefused while another one is tried so."""
        with self._turns:
            is_under_way = self._run is not None and self._run.state()["state"] == "running"
            if is_under_way and self._hash != proposal.hash:
                raise DraftRefused(BUSY)
            if self._run is not None:
                self._run.stop()
            self._hash, self._run = proposal.hash, ErrandRun(self._work, self._folder(proposal.hash))
            self._run.begin(proposal.files, plant_file, wanted)
            return self._run.state()

    def state(self, hash: str) -> dict[str, Any]:
        """The state of the try of a proposal: idle, running, done, failed or stopped."""
        with self._turns:
            if self._run is not None and self._hash == hash:
                return self._run.state()
        return {"state": "done" if self.result(hash) is not None else "idle"}

    def result(self, hash: str) -> dict[str, Any] | None:
        """The result of the last try of a proposal; None where there is none."""
        try:
            found: dict[str, Any] = json.loads((self._folder(hash) / RESULT).read_text("utf-8"))
            return found
        except (OSError, ValueError):
            return None

    def stop(self) -> None:
        """End what is under way; idempotent."""
        with self._turns:
            if self._run is not None:
                self._run.stop()

    def _folder(self, hash: str) -> Path:
        return self._home / hash
