"""Virtual controllers as they are typed, each a process of its own, for tests that reach them by a plant."""

from __future__ import annotations

import json
import re
import sys
import urllib.request
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tests.patience import PATIENCE_S

COMMAND = "from arboleda.cli.main import main; main()"


def typed(start: Callable[..., Any], *words: str) -> Any:
    """The process of `arboleda virtual` with these words."""
    return start(sys.executable, "-c", COMMAND, "virtual", *words)


@dataclass(frozen=True, kw_only=True)
class Played:
    """A virtual controller that listens, and where its faults are switched."""

    process: Any
    faults: str

    def found(self, pattern: str) -> tuple[str, ...]:
        """The groups of this pattern in what it says."""
        found = re.search(pattern, self.process.output)
        assert found
        return found.groups()

    def switch(self, fault: str, *, on: bool) -> None:
        request = urllib.request.Request(f"{self.faults}/{fault}", method="PUT" if on else "DELETE")
        with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
            assert json.load(answer)[fault]["on"] is on


def play(start: Callable[..., Any], *words: str) -> Played:
    """The virtual controller of `arboleda virtual` with these words, its faults at any port."""
    process = typed(start, *words, "--fault-port", "0")
    process.wait_for("faults are switched on ")
    faults = re.search(r"switched on (\S+)", process.output)
    assert faults
    return Played(process=process, faults=faults[1])
