"""Acts of operators before this start, as the plant's memory has them."""

from __future__ import annotations

import json
from typing import Any

from arboleda.engine import ACTS_TOLD
from arboleda.model.sentence import OWN, Sentence, from_data, retold
from arboleda.store.act_table import ActTable, JournalEntry


def of(acts: ActTable) -> list[dict[str, Any]]:
    """The acts of operators before this start, oldest first."""
    return [
        {"at": each.unix_s, "scope": each.scope, "cell": each.cell, "sentence": _sentence_of(each)}
        for each in reversed(acts.last())
    ]


def _sentence_of(entry: JournalEntry) -> Sentence:
    """The sentence about an act. One of a package, of an older start or of another version is told as it was
    said then; plain text if it cannot be read."""
    try:
        data = json.loads(entry.said or "")
        return from_data(data, ACTS_TOLD) if data["key"] in ACTS_TOLD else retold(entry.sentence, data)
    except (ValueError, TypeError, KeyError):
        return OWN(text=entry.sentence)
