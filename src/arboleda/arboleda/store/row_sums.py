"""Checksums of the rows of a plant's memory, so that a changed bit does not pass for what was written."""

from __future__ import annotations

import json
import sqlite3
import zlib
from collections.abc import Iterator, Sequence

KEYS = {
    "fact": ("fact", "name"),
    "journal": ("id",),
    "task": ("number",),
    "down": ("number",),
    "run": ("number",),
}
COLUMNS = tuple(f"ALTER TABLE {table} ADD COLUMN crc INTEGER" for table in KEYS)
UPPER_BIT = 2**31  # SQLite keeps the sum of the schema in a number with a sign


def know(db: sqlite3.Connection) -> None:
    """Register the checksum function with this connection."""
    db.create_function("arboleda_crc", -1, lambda *row: _sum(row))


def watch(db: sqlite3.Connection) -> None:
    """Have each row that this connection writes summed in the same commit. Triggers of the connection do it,
    not of the file: other programs have no such function."""
    for table, keys in KEYS.items():
        names = _columns(db, table)
        values, wanted = ", ".join(names), " AND ".join(f"{key} = new.{key}" for key in keys)
        body = f"UPDATE {table} SET crc = arboleda_crc({values}) WHERE {wanted}"
        for event in ("INSERT", f"UPDATE OF {values}"):
            name = f"{table}_{event.split()[0].lower()}"
            db.execute(f"CREATE TEMP TRIGGER {name} AFTER {event} ON main.{table} BEGIN {body}; END")


def fill(db: sqlite3.Connection) -> Iterator[str]:
    """The SQL statements that add checksums to a memory without them; run each before taking the next."""
    for table in KEYS:
        yield f"UPDATE {table} SET crc = arboleda_crc({', '.join(_columns(db, table))})"
    yield f"PRAGMA application_id = {_schema(db)}"


def are_right(db: sqlite3.Connection) -> bool:
    """True if tables and rows still match their checksums."""
    (kept,) = db.execute("PRAGMA application_id").fetchone()
    return kept == _schema(db) and all(_is_right(db, table) for table in KEYS)


def _is_right(db: sqlite3.Connection, table: str) -> bool:
    rows = db.execute(f"SELECT {', '.join(_columns(db, table))}, crc FROM {table}")
    return all(_sum(row) == crc for *row, crc in rows)


def _columns(db: sqlite3.Connection, table: str) -> list[str]:
    found = db.execute("SELECT name FROM pragma_table_info(?)", (table,))
    return [name for (name,) in found if name != "crc"]


def _schema(db: sqlite3.Connection) -> int:
    ours = f"tbl_name IN ({', '.join('?' * len(KEYS))})"
    select = f"SELECT type, name, tbl_name, sql FROM sqlite_master WHERE {ours} ORDER BY type, name"
    rows = db.execute(select, tuple(KEYS))
    return _sum(rows.fetchall()) % UPPER_BIT


def _sum(values: Sequence[object]) -> int:
    """The checksum of values, the same in every Python: over JSON in ASCII, where 1, 1.0 and "1" differ."""
    return zlib.crc32(json.dumps(values, default=repr).encode())
