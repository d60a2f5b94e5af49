"""Rows of a plant's memory, as statements of SQL that every store takes."""

from __future__ import annotations

from typing import Any, Protocol

from arboleda.model.errors import ArboledaError

Statement = tuple[str, tuple[object, ...]]  # with its values, each in the place of a `?`


class Rows(Protocol):
    """Table that rows are kept in; each method raises ArboledaError."""

    def write(self, *statements: Statement, durable: bool) -> None:
        """Commit all of the statements, or none; what is to be `durable` may wait for a sync."""

    def read(self, statement: str, *values: object) -> list[tuple[Any, ...]]:
        """The rows of a query."""

    def damaged(self) -> ArboledaError:
        """The error for a row that is not as it was written."""


def row_of_fact(key: tuple[str, str], value: str | None) -> Statement:
    """The statement that writes a row of `fact`, or deletes it."""
    if value is None:
        return "DELETE FROM fact WHERE fact = ? AND name = ?", key
    insert = "INSERT INTO fact (fact, name, value) VALUES (?, ?, ?)"
    return f"{insert} ON CONFLICT (fact, name) DO UPDATE SET value = excluded.value", (*key, value)
