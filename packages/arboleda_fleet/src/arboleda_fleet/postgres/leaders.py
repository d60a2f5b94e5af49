"""Leader of each plant of a database, for a process that watches all of them."""

from __future__ import annotations

from typing import Any

from psycopg import sql

from arboleda.departures.leading import LEASE_S
from arboleda.drivers import plain
from arboleda.extension import ArboledaError
from arboleda.store.leadership import Leader, Leaders

from .leader_row import lately
from .schema import PREFIX
from .server import Impatient, checked, connected, explained

PLANTS = (
    "SELECT table_schema FROM information_schema.columns WHERE table_name = 'leader' AND column_name = 'url'"
    " AND starts_with(table_schema, %s) ORDER BY table_schema"
)
LEADER = (
    f"SELECT {{name}}, epoch, host, process, url, {lately('seen', '{lease}')},"
    f" (SELECT count(*) FROM {{schema}}.standby WHERE {lately('seen', '{lease}')}) FROM {{schema}}.leader"
)


class PostgresLeaders(Leaders):
    """Leaders of the plants of a database: a connection of its own."""

    def __init__(self, address: str) -> None:
        self._address = checked(address)
        self._opened: Impatient | None = None

    def all(self) -> dict[str, Leader]:
        with explained(self._address, ArboledaError, "cannot be reached"):
            db = self._connection()
            schemas = [row[0] for row in db.execute(PLANTS, (PREFIX,)).fetchall()]
            if not schemas:
                return {}
            rows = db.execute(sql.SQL(" UNION ALL ").join(map(_leader, schemas))).fetchall()
        return {plain(name): _row(*rest) for name, *rest in rows}

    def close(self) -> None:
        if self._opened is not None:
            self._opened.close()
            self._opened = None

    def _connection(self) -> Impatient:
        if self._opened is None or self._opened.closed:
            self._opened = connected(self._address, "public")
        return self._opened


def _leader(schema: str) -> sql.Composed:
    name = sql.Literal(schema.removeprefix(PREFIX))
    lease = sql.Literal(LEASE_S)
    return sql.SQL(LEADER).format(name=name, lease=lease, schema=sql.Identifier(schema))


def _row(epoch: int, host: str, process: int, url: str, leads: bool, standbys: Any) -> Leader:
    return Leader(
        epoch=epoch, host=plain(host), process=process, url=plain(url), leads=leads, standbys=int(standbys)
    )
