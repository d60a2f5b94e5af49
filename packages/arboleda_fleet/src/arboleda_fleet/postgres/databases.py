"""PostgreSQL databases that keep the memories of plants."""

from __future__ import annotations

from arboleda.extension import StartError
from arboleda.runtime import invocation
from arboleda.store.leadership import Leaders, Leadership
from arboleda.store.plant_memory import PlantMemory
from arboleda.store.schemes import Databases
from arboleda.store.task_rows import History


class Postgres(Databases):
    """Postgres: what it makes loads its library."""

    def __init__(self) -> None:
        refuse_without_library()

    def memory(self, address: str, plant: str) -> PlantMemory:
        from .memory import PostgresMemory

        return PostgresMemory(address, plant)

    def history(self, address: str, plant: str) -> History:
        from .history import PostgresHistory

        return PostgresHistory(address, plant)

    def leadership(self, address: str, plant: str) -> Leadership:
        from .leadership import PostgresLeadership

        return PostgresLeadership(address, plant)

    def leaders(self, address: str) -> Leaders:
        from .leaders import PostgresLeaders

        return PostgresLeaders(address)


def refuse_without_library() -> None:
    """Raise StartError if the extra is not installed."""
    try:
        import psycopg  # noqa: F401 - it is an extra
    except ImportError as error:
        raise StartError(
            "A store in PostgreSQL needs the library psycopg: type"
            f" `{invocation.pip_install()} 'arboleda[postgres]'` ({error})"
        ) from error
