"""The journal: the table of what operators did."""

from __future__ import annotations

import json
from dataclasses import dataclass

from arboleda.model.messages import Journal, outlives_power

from .rows import Rows

PUT_TO_WORK = "put_to_work"  # in the journal in place of a verb


@dataclass(frozen=True, kw_only=True)
class JournalEntry:
    """Act of an operator; `id` grows, `unix_s` is the time by the clock of the plant's machine.

    `cell` is None if the act was for more than one, or is older than this column; `said` is JSON of the
    sentence, None if it is older than that column.
    """

    id: int
    unix_s: float
    verb: str
    scope: str
    sentence: str
    cell: str | None
    said: str | None


class ActTable:
    """The acts of operators, in the order in which they were kept."""

    def __init__(self, rows: Rows) -> None:
        self._rows = rows

    def keep(self, entry: Journal, unix_s: float) -> None:
        """Commit one act of an operator."""
        sentence_json = json.dumps(entry.sentence.data(), ensure_ascii=False)
        word = PUT_TO_WORK if entry.verb is None else entry.verb.value
        row = (unix_s, word, entry.scope, str(entry.sentence), entry.cell, sentence_json)
        insert = "INSERT INTO journal (unix_s, verb, scope, sentence, cell, said) VALUES (?, ?, ?, ?, ?, ?)"
        self._rows.write((insert, row), durable=outlives_power(entry))

    def last(self, limit: int = 100) -> list[JournalEntry]:
        """The last acts, the newest first."""
        columns = "id", "unix_s", "verb", "scope", "sentence", "cell", "said"
        rows = self._rows.read(f"SELECT {', '.join(columns)} FROM journal ORDER BY id DESC LIMIT ?", limit)
        for _, unix_s, *texts, cell, sentence_json in rows:
            known = [*texts, cell or "", sentence_json or ""]
            if not isinstance(unix_s, float) or not all(isinstance(text, str) for text in known):
                raise self._rows.damaged()
        return [JournalEntry(**dict(zip(columns, row, strict=True))) for row in rows]
