"""Facts that the plant has kept for its next start, as it told its disk.

`kept_before_it_leaves` finds by it a latch that is remembered only after it left.
"""

from __future__ import annotations

from collections.abc import Mapping

from arboleda.model.messages import Fact, Remember

Rows = dict[Fact, dict[str, str]]


class KeptFacts:
    """Kept facts, by fact and name: `before` this step of the plant, and `now`."""

    def __init__(self) -> None:
        self.before: Rows = {}
        self.now: Rows = {}

    def restore(self, facts: Mapping[Fact, Mapping[str, str]]) -> None:
        """Take over what is on the disk."""
        self.now = {fact: dict(rows) for fact, rows in facts.items()}

    def begin_step(self) -> None:
        self.before = self.now

    def take(self, message: Remember) -> None:
        """Take in that the plant keeps something, or keeps it no more."""
        kept = {fact: dict(rows) for fact, rows in self.now.items()}
        rows = kept.setdefault(message.fact, {})
        rows.pop(message.name, None)
        if message.value is not None:
            rows[message.name] = message.value
        self.now = kept

    def effector(self, arm: str) -> str:
        """The state of an effector as it is kept."""
        return self.now.get(Fact.EFFECTOR, {}).get(arm, "off")
