"""The seeds of a campaign as rows, which workers on any host take one by one."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable

from psycopg import sql

from arboleda.extension import StartError
from arboleda.store.seeds import SeedRow, Seeds

from .server import checked, connected, explained

SCHEMA = "arboleda_simulate"
HOUR_S = 3600.0  # a frozen worker loses its seed after this time
TABLE = (
    "CREATE TABLE IF NOT EXISTS seed (campaign TEXT, seed BIGINT, digest TEXT, broken TEXT, cycles INTEGER,"
    " worker TEXT, PRIMARY KEY (campaign, seed))"
)
LAY_OUT = "INSERT INTO seed SELECT %s, generate_series(%s::bigint, %s::bigint) ON CONFLICT DO NOTHING"
TAKE = (
    "SELECT seed FROM seed WHERE campaign = %s AND digest IS NULL"
    " ORDER BY seed LIMIT 1 FOR UPDATE SKIP LOCKED"
)
DONE = "UPDATE seed SET digest = %s, broken = %s, cycles = %s, worker = %s WHERE campaign = %s AND seed = %s"
ROWS = "SELECT seed, digest, broken, cycles, worker FROM seed WHERE campaign = %s ORDER BY seed"


class SeedRows(Seeds):
    """Rows of one campaign in PostgreSQL."""

    def __init__(self, address: str, campaign: str) -> None:
        self._name = checked(address)
        self._campaign = campaign
        self._worker = f"process {os.getpid()} on {socket.gethostname()}"
        with explained(self._name, StartError):
            self._db = connected(address, SCHEMA, idle_s=HOUR_S)

    def lay_out(self, first: int, count: int) -> None:
        with explained(self._name, StartError), self._db.transaction():
            self._db.execute("SELECT pg_advisory_xact_lock(hashtext(%s))", (SCHEMA,))
            self._db.execute(sql.SQL("CREATE SCHEMA IF NOT EXISTS {}").format(sql.Identifier(SCHEMA)))
            self._db.execute(TABLE)
            self._db.execute(LAY_OUT, (self._campaign, first, first + count - 1))

    def do_next(self, run: Callable[[int], SeedRow]) -> SeedRow | None:
        """The row is locked meanwhile: if this process dies, the server gives the seed to another one."""
        with explained(self._name, StartError), self._db.transaction():
            found = self._db.execute(TAKE, (self._campaign,)).fetchone()
            if found is None:
                return None
            row = run(int(found[0]))
            values = (row.digest, row.broken, row.cycles, self._worker, self._campaign, row.seed)
            self._db.execute(DONE, values)
            return row

    def rows(self) -> list[SeedRow]:
        names = "seed", "digest", "broken", "cycles", "worker"
        with explained(self._name, StartError):
            found = self._db.execute(ROWS, (self._campaign,)).fetchall()
        return [SeedRow(**dict(zip(names, row, strict=True))) for row in found]

    def close(self) -> None:
        self._db.close()
