"""Checksums of the rows of a plant's memory, so that a changed bit does not pass for what was written, and
a count of their changes, so that an older memory does not pass for the last one."""

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
COUNT = (
    # the number stands there twice: `integrity_check` finds a bit of it that has changed
    "CREATE TABLE written (number INTEGER NOT NULL, negative INTEGER NOT NULL CHECK (number + negative = 0))",
    "INSERT INTO written (number, negative) VALUES (0, 0)",
)
ONE_MORE = "UPDATE written SET number = number + 1, negative = negative - 1"
UPPER_BIT = 2**31  # SQLite keeps the sum of the schema in a number with a sign


def know(db: sqlite3.Connection) -> None:
    """Register the checksum function with this connection."""
    db.create_function("arboleda_crc", -1, lambda *row: _sum(row))


def watch(db: sqlite3.Connection) -> None:
    """Have each row that this connection writes summed in the same commit, and each change counted. Triggers
    of the connection do it, not of the file: other programs have no such function."""
    for table, keys in KEYS.items():
        names = _columns(db, table)
        values, wanted = ", ".join(names), " AND ".join(f"{key} = new.{key}" for key in keys)
        body = f"UPDATE {table} SET crc = arboleda_crc({values}) WHERE {wanted}; {ONE_MORE}"
        for event in ("INSERT", f"UPDATE OF {values}"):
            name = f"{table}_{event.split()[0].lower()}"
            db.execute(f"CREATE TEMP TRIGGER {name} AFTER {event} ON main.{table} BEGIN {body}; END")
    db.execute(f"CREATE TEMP TRIGGER fact_delete AFTER DELETE ON main.fact BEGIN {ONE_MORE}; END")


def written(db: sqlite3.Connection) -> int:
    """The number of the last change that a connection sees; sqlite3.Error if there is none."""
    found = [number for (number,) in db.execute("SELECT number FROM written") if isinstance(number, int)]
    if len(found) != 1:
        raise sqlite3.DatabaseError("database disk image is malformed")
    return found[0]


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
