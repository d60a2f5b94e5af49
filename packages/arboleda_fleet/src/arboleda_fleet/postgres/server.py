"""The way to a PostgreSQL server: connections that do not wait for ever, and its errors in words."""

from __future__ import annotations

import ipaddress
import os
import re
import socket
import time
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import psycopg
from psycopg import sql

from arboleda.extension import ArboledaError, StartError
from arboleda.store.address import has_password, is_address

OLDEST = 13  # the oldest supported version of the server
IDLE_MS = 1000
ANSWER_S = 1.0  # a server that is silent for so long counts as away
CONNECT_S = 2  # libpq takes no less
SETTINGS = {
    "connect_timeout": CONNECT_S,
    # a network that is cut in the middle of an answer is noticed, too
    "keepalives": 1,
    "keepalives_idle": 1,
    "keepalives_interval": 1,
    "keepalives_count": 2,
    "tcp_user_timeout": 2000,
    "application_name": "arboleda",
}
WORDS = {  # advice by the class or the code of PostgreSQL's error
    "28": "look at the user and its password, which are in PGPASSWORD or ~/.pgpass",
    "3D": "make the database, or correct its name",
    "42501": "let this user use and make schemas and tables there",
    "53": "make room on the server, and start again",
}
T = TypeVar("T")


class NoAnswer(psycopg.OperationalError):
    """Error: the server did not answer within ANSWER_S."""


class Impatient(psycopg.Connection[Any]):
    """A connection that is closed when its server says nothing for ANSWER_S.

    The answer may still come, and would be taken for that to the next statement.
    """

    def wait(self, gen: Generator[Any, Any, T], *options: Any, **named: Any) -> T:
        try:
            return super().wait(_limited(gen, time.monotonic() + ANSWER_S), *options, **named)
        except NoAnswer:
            self.close()
            raise


def _limited(gen: Generator[Any, Any, T], until: float) -> Generator[Any, Any, T]:
    """The same generator, with NoAnswer raised after `until`; psycopg asks at each interval."""
    ready = None
    while True:
        try:
            wanted = gen.send(ready)
        except StopIteration as end:
            result: T = end.value
            return result
        ready = yield wanted
        if not ready and time.monotonic() > until:
            raise NoAnswer(f"the server gave no answer for {ANSWER_S:g} s")


def checked(address: str) -> str:
    """The address of a database, as people write it; raises StartError if it has a password, or is none."""
    if not is_address(address):
        raise StartError("A store is written as postgresql://USER@HOST:PORT/DATABASE.")
    if has_password(address):
        raise StartError(
            "The address of a store has a password in it, which others can read there: leave it out, and put"
            " it into PGPASSWORD or ~/.pgpass."
        )
    try:
        psycopg.conninfo.conninfo_to_dict(address)
    except psycopg.Error as error:
        raise StartError(f"{address} is no address of a PostgreSQL database ({in_words(error)}).") from None
    return address


def connected(address: str, schema: str) -> Impatient:
    """A connection on which each statement is a transaction of its own; psycopg.Error, StartError.

    Who is frozen between a statement and its end keeps others out for IDLE_MS and no longer.
    """
    known = psycopg.conninfo.conninfo_to_dict(address)
    limits = f"-c idle_in_transaction_session_timeout={IDLE_MS} -c statement_timeout=5000"
    wanted = SETTINGS | {"options": f"{limits} -c timezone=UTC"}
    ours: dict[str, Any] = {key: value for key, value in wanted.items() if key not in known}
    db = Impatient.connect(address, autocommit=True, **ours)
    try:
        if db.info.server_version < OLDEST * 10_000:
            raise StartError(
                f"The PostgreSQL server of {address} is of version {db.info.server_version // 10_000}, and"
                f" this needs {OLDEST} or newer."
            )
        db.execute(sql.SQL("SET search_path TO {}").format(sql.Identifier(schema)))
        db.prepare_threshold = 1
    except BaseException:  # whatever it is, Ctrl-C too, the connection is not left open
        db.close()
        raise
    return db


def own_address(db: Impatient) -> str:
    """The address of this host on its way to the server; "" if both are one machine, or it fits in no URL."""
    with socket.socket(fileno=os.dup(db.fileno())) as end:
        name = end.getsockname()
    if not isinstance(name, tuple) or "%" in name[0] or ipaddress.ip_address(name[0]).is_loopback:
        return ""
    return str(name[0])


def translated(statement: str) -> str:
    """The statement in psycopg's form, with ILIKE for LIKE, which distinguishes case in PostgreSQL."""
    return statement.replace("%", "%%").replace("?", "%s").replace(" LIKE ", " ILIKE ")


def plain_values(values: tuple[object, ...]) -> tuple[object, ...]:
    """The values, without characters that no text of PostgreSQL can hold."""
    return tuple(
        each.replace("\0", "\N{REPLACEMENT CHARACTER}") if isinstance(each, str) else each for each in values
    )


@contextmanager
def explained(name: str, kind: type[ArboledaError], cannot: str = "cannot be used") -> Iterator[None]:
    """Context that turns errors of PostgreSQL into one sentence on the plant's memory."""
    try:
        yield
    except psycopg.Error as error:
        raise kind(f"The plant's memory {name} {cannot} ({in_words(error)}): {advice(error)}.") from error


def in_words(error: psycopg.Error) -> str:
    """The server's error on one line, without the address, which is named beside it."""
    message = error.diag.message_primary or next(iter(str(error).splitlines()), type(error).__name__)
    return re.sub(r"^connection failed: (connection to server .*? failed: )?(FATAL: *)?", "", message).rstrip(
        "."
    )


def advice(error: psycopg.Error) -> str:
    """The advice to the user for an error of PostgreSQL."""
    message, code = str(error), error.sqlstate or ""
    if "password" in message or "no pg_hba.conf entry" in message or "role" in message:
        code = code or "28"
    elif "does not exist" in message and "database" in message:
        code = code or "3D"
    known = (WORDS[each] for each in WORDS if code.startswith(each))
    return next(known, "look whether the server runs and can be reached; what was kept before is not lost")
