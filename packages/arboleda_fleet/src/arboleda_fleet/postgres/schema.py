"""The tables of a plant in PostgreSQL: a schema for each plant, so that several share a database."""

from __future__ import annotations

from psycopg import sql

from arboleda.extension import StartError

from .server import Impatient

PREFIX, LONGEST = "plant_", 63  # PostgreSQL cuts longer names, so that two plants could become one
VERSION = 7
NUMBER = "BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY"
TABLES = (
    "CREATE TABLE fact (fact TEXT, name TEXT, value TEXT NOT NULL, PRIMARY KEY (fact, name))",
    f"CREATE TABLE journal (id {NUMBER}, unix_s DOUBLE PRECISION NOT NULL, verb TEXT NOT NULL,"
    " scope TEXT NOT NULL, sentence TEXT NOT NULL, cell TEXT, said TEXT)",
    f"CREATE TABLE task (number {NUMBER}, id TEXT NOT NULL UNIQUE, text TEXT NOT NULL, cell TEXT NOT NULL,"
    " recipe TEXT NOT NULL, state TEXT NOT NULL, reason TEXT, sentence TEXT, said TEXT,"
    " accepted_s DOUBLE PRECISION NOT NULL, started_s DOUBLE PRECISION, ended_s DOUBLE PRECISION,"
    " asked_by TEXT, attempts INTEGER NOT NULL DEFAULT 0, answers TEXT)",
    "CREATE INDEX task_open ON task (number) WHERE ended_s IS NULL",
    "CREATE INDEX task_ended ON task (ended_s) WHERE ended_s IS NOT NULL",
    f"CREATE TABLE down (number {NUMBER}, cell TEXT NOT NULL, state TEXT NOT NULL,"
    " since_s DOUBLE PRECISION NOT NULL, until_s DOUBLE PRECISION)",
    "CREATE INDEX down_open ON down (cell) WHERE until_s IS NULL",
    f"CREATE TABLE run (number {NUMBER}, since_s DOUBLE PRECISION NOT NULL,"
    " seen_s DOUBLE PRECISION NOT NULL, ended INTEGER NOT NULL)",
    # one row: the format of these tables, who leads the plant under which number, and when he said so last,
    # by the server's clock; `seen` is null where nobody leads it
    "CREATE TABLE leader (format INTEGER NOT NULL, epoch BIGINT NOT NULL, host TEXT NOT NULL,"
    " process BIGINT NOT NULL, seen TIMESTAMPTZ)",
    "INSERT INTO leader (format, epoch, host, process, seen) VALUES (1, 0, '', 0, NULL)",
    # Called by each statement that writes: who does not lead any more writes nothing, since what this raises
    # takes the statement back. The lock has a change of leaders wait for the statement, and no longer.
    "CREATE FUNCTION fenced(mine BIGINT, durable BOOLEAN) RETURNS VOID LANGUAGE plpgsql AS $$ BEGIN"
    " PERFORM set_config('synchronous_commit', CASE WHEN durable THEN 'on' ELSE 'off' END, true);"
    " PERFORM FROM leader WHERE epoch = mine FOR SHARE;"
    " IF NOT FOUND THEN RAISE EXCEPTION 'another process leads' USING ERRCODE = 'AR001'; END IF;"
    " END $$",
)
SINCE: dict[int, tuple[str, ...]] = {  # statements from each format to the next one
    1: (
        # the address of the leader's page; since when another leader is wanted; the cells that were at work
        # when the last leader handed the plant over, as JSON
        "ALTER TABLE leader ADD COLUMN url TEXT NOT NULL DEFAULT '', ADD COLUMN wanted TIMESTAMPTZ,"
        " ADD COLUMN going TEXT NOT NULL DEFAULT '[]'",
        "CREATE TABLE standby (host TEXT, process BIGINT, seen TIMESTAMPTZ NOT NULL,"
        " PRIMARY KEY (host, process))",
    ),
    2: ("ALTER TABLE task ADD COLUMN choice TEXT",),
    3: ("ALTER TABLE standby ADD COLUMN url TEXT NOT NULL DEFAULT ''",),  # the address of its page
    4: ("ALTER TABLE task ADD COLUMN course TEXT",),
    5: ("ALTER TABLE task ADD COLUMN unchecked TEXT",),
    6: (
        # how long the plant had run, over all of its starts, when a task ended
        "ALTER TABLE task ADD COLUMN ran_s DOUBLE PRECISION",
        "CREATE INDEX task_ran ON task (ran_s) WHERE ran_s IS NOT NULL",
        "UPDATE task SET ran_s = 0 WHERE ended_s IS NOT NULL",
    ),
}
SUPERSEDED = "AR001"


def schema_of(plant: str) -> str:
    """The name of a plant's schema; raises StartError if the plant's name is too long for one."""
    schema = PREFIX + plant
    if len(schema.encode()) > LONGEST:
        raise StartError(
            f"A plant whose memory is in PostgreSQL has a name of at most {LONGEST - len(PREFIX)} characters."
        )
    return schema


def exists(db: Impatient, schema: str) -> bool:
    """True if the plant has tables in this database; looked up anew, as cached names may be old."""
    found = db.execute("SELECT FROM pg_tables WHERE schemaname = %s AND tablename = 'leader'", (schema,))
    return found.fetchone() is not None


def prepare(db: Impatient, schema: str, name: str) -> None:
    """Make the tables, or bring those of an older Arboleda up to date; raises StartError."""
    if exists(db, schema):
        found = version(db)
        refuse_newer(found, name)
        if found == VERSION:
            return
    with db.transaction():  # two hosts may start at once
        db.execute("SELECT pg_advisory_xact_lock(hashtext(%s))", (schema,))
        if not exists(db, schema):
            db.execute(sql.SQL("CREATE SCHEMA IF NOT EXISTS {}").format(sql.Identifier(schema)))
            for statement in TABLES:
                db.execute(statement)
        found = version(db)
        for since in sorted(each for each in SINCE if each >= found):
            for statement in SINCE[since]:
                db.execute(statement)
        db.execute("UPDATE leader SET format = %s", (VERSION,))


def version(db: Impatient) -> int:
    """The version of the tables; 0 if Arboleda did not make them."""
    row = db.execute("SELECT format FROM leader").fetchone()
    return 0 if row is None else int(row[0])


def refuse_newer(found: int, name: str) -> None:
    """Raises StartError if the tables have a format that this Arboleda does not know."""
    if found > VERSION:
        raise StartError(
            f"The plant's memory {name} is of a newer Arboleda (format {found}, known: {VERSION}):"
            " use that one."
        )
    if found < 1:
        raise StartError(f"The plant's memory {name} has lost its content: put a backup of it in its place.")
