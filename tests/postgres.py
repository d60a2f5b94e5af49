"""The PostgreSQL server of tests; where there is none, those that need it are skipped."""

from __future__ import annotations

import pytest

from arboleda_kills import database
from arboleda_kills.database import DATABASE, PASSWORD, USER, NoServer

__all__ = ["DATABASE", "PASSWORD", "USER", "Server"]


class Server(database.Server):
    """The server of a test run; `address` is that of its one database."""

    def __init__(self, port: int) -> None:
        try:
            super().__init__(port)
        except NoServer as error:
            pytest.skip(str(error))
