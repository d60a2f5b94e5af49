"""A plant whose memory is in PostgreSQL: killed, twice at once, and left without its database."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.postgres import PASSWORD, Server

pytestmark = pytest.mark.system

UP = ("up", "--no-ros", "--rate", "10")
PLANT = "arboleda"  # the name of the shipped plant


@pytest.fixture
def store(postgres: Server, database: str) -> tuple[str, str]:
    """The options for a database that knows nothing of the plant."""
    with postgres.connection() as db:
        db.execute(f"DROP SCHEMA IF EXISTS plant_{PLANT} CASCADE")
    return "--store", database


def kept(arboleda: Callable[..., Any], *store: str) -> dict[str, str]:
    """The state of each task that the plant has ever taken, by its id."""
    listed = arboleda("tasks", "--json", *store)
    assert listed.wait() == 0, listed.output
    return {row["id"]: row["state"] for row in map(json.loads, listed.lines)}


@pytest.mark.smoke
def test_a_killed_plant_finds_its_tasks_in_the_database(
    arboleda: Callable[..., Any], store: tuple[str, str], tmp_path: Path
) -> None:
    first = arboleda(*UP, *store, "sis_a 0B 1 #one", "sis_a 0B 2 #two", "sis_a 0B 3 #three")
    first.wait_for("running   sis_a 0B 2")
    first.kill()
    elsewhere = ("--state", str(tmp_path / "elsewhere"))  # as on another host
    again = arboleda(*UP, *store, *elsewhere)
    again.wait_for("task two was at work when the plant stopped, at its step")
    again.wait_for("1 task of an earlier start waits in sis_a")
    again.wait_for("HTTP API")
    listed = arboleda("tasks", "--json", *elsewhere)  # a plant that runs says where it keeps them
    assert listed.wait() == 0 and len(listed.lines) == 3
    second = arboleda(*UP, *store)
    assert second.wait() == 1
    assert "is led by another process (process" in second.output and "Traceback" not in second.output
    assert again.interrupt() == 0
    assert kept(arboleda, *store) == {"one": "done", "two": "running", "three": "queued"}
    assert not (tmp_path / "state" / "plant.sqlite").exists()


def test_a_plant_that_loses_its_database_ends_and_has_lost_nothing(
    arboleda: Callable[..., Any], store: tuple[str, str], postgres: Server
) -> None:
    plant = arboleda(*UP, *store, "sis_a 0B 1 #one", "sis_a 0B 2 #two")
    plant.wait_for("queued    sis_a 0B 2")
    postgres.stop()
    try:
        assert plant.wait() == 1
        assert "The plant's memory postgresql://" in plant.lines[-1]
        assert "look whether the server runs and can be reached" in plant.lines[-1]
        assert "Traceback" not in plant.output and PASSWORD not in plant.output
        refused = arboleda(*UP, *store)
        assert refused.wait() == 1
        assert "(Connection refused): look whether the server runs" in refused.lines[-1]
    finally:
        postgres.start()
    found = kept(arboleda, *store)
    assert set(found) == {"one", "two"} and found["two"] == "queued"
