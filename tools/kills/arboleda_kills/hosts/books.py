"""True times of each task, from accepted to ended: its own times are of clocks that are stepped here."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import psycopg

from arboleda.store.task_rows import TaskRow

from ..steady import BEGAN_S

TICK_S = 0.01  # of /proc/uptime, the one clock that nobody sets and a server can read
KEEP = f"""
CREATE TABLE books (id TEXT PRIMARY KEY, accepted_s FLOAT8, started_s FLOAT8, ended_s FLOAT8);
CREATE FUNCTION kept() RETURNS TRIGGER LANGUAGE plpgsql AS $$
DECLARE truly FLOAT8 := {BEGAN_S!r} + split_part(pg_read_file('/proc/uptime'), ' ', 1)::FLOAT8;
BEGIN
    IF TG_OP = 'INSERT' THEN INSERT INTO books VALUES (NEW.id, truly); END IF;
    IF TG_OP = 'INSERT' OR NEW.started_s IS DISTINCT FROM OLD.started_s THEN
        UPDATE books SET started_s = CASE WHEN NEW.started_s IS NOT NULL THEN truly END WHERE id = NEW.id;
    END IF;
    IF TG_OP = 'INSERT' OR NEW.ended_s IS DISTINCT FROM OLD.ended_s THEN
        UPDATE books SET ended_s = CASE WHEN NEW.ended_s IS NOT NULL THEN truly END WHERE id = NEW.id;
    END IF;
    RETURN NULL;
END $$;
CREATE TRIGGER kept AFTER INSERT OR UPDATE ON task FOR EACH ROW EXECUTE FUNCTION kept();
"""


def keep_books(db: psycopg.Connection, schema: str) -> None:
    """Have the server write down when each row of a task truly changes."""
    db.execute(f'SET search_path TO "{schema}"')
    db.execute(KEEP)
    db.execute(f'ALTER FUNCTION kept() SET search_path TO "{schema}"')


def truly(db: psycopg.Connection, schema: str, rows: Sequence[TaskRow]) -> list[TaskRow]:
    """The rows with the times of the books."""
    found = db.execute(f'SELECT id, accepted_s, started_s, ended_s FROM "{schema}".books').fetchall()
    times = {id: rest for id, *rest in found}
    return [_at(row, *times[row.id]) for row in rows]


def _at(row: TaskRow, accepted_s: float, started_s: float | None, ended_s: float | None) -> TaskRow:
    ended_s = None if ended_s is None else ended_s + TICK_S
    return replace(row, accepted_s=accepted_s, started_s=started_s, ended_s=ended_s)
