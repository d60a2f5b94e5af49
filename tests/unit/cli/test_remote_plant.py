"""Commands on a host that does not lead the plant: they go to who does, or say why they cannot."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx
import pytest
from starlette.types import ASGIApp
from tests.guarded_plant import guarded
from tests.in_process import Machine
from tests.in_process import machine as machine
from tests.web_plant import QUEUED, Plant

from arboleda.cli import remote_plant
from arboleda.cli.client import PlantClient
from arboleda.cli.remote_plant import NoLeader, RemotePlant
from arboleda.client import NoAnswer
from arboleda.model.messages import Verb
from arboleda.runtime.leader import LeaderInfo
from arboleda.runtime.state import StateDir

HERE, LEADER, OTHER = 8080, 8081, 8082  # ports of a process here, of the leader, of another standby
LED = LeaderInfo(
    plant="demo", host=socket.gethostname(), process=7, url=f"http://127.0.0.1:{LEADER}", epoch=7
)
ASKED = f"plant demo is led on {LED.host}: asked there\n"
STORE = "postgresql://db"
CUT = httpx.RemoteProtocolError("it broke off")


@pytest.fixture
def plant(machine: Machine) -> Plant:
    """The plant that the leader leads."""
    plant = Plant()
    machine.listen(LEADER, guarded(plant).app)
    return plant


@pytest.fixture
def state(tmp_path: Path) -> Path:
    return tmp_path / "state"


@contextmanager
def running(machine: Machine, state: Path, *those: ASGIApp | Exception) -> Iterator[None]:
    """A process on this state directory that leads, or did, and what its clients get."""
    machine.listen(HERE, *those)
    with StateDir(state, plant="demo") as made:
        made.announce(HERE)
        yield


class Database:
    """Says who leads, as `leadership_of`."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.led: LeaderInfo | None = None
        self.standbys = 0
        self.name = STORE
        monkeypatch.setattr(remote_plant, "leadership_of", lambda store, plant: self)

    def leader(self) -> Any:
        return SimpleNamespace(**vars(self.led or LED), leads=self.led is not None, standbys=self.standbys)

    def close(self) -> None:
        pass


@pytest.fixture
def database(monkeypatch: pytest.MonkeyPatch) -> Database:
    return Database(monkeypatch)


def client(state: Path, known: dict[str, str] | None = None) -> PlantClient:
    return PlantClient(state, RemotePlant(state, lambda: (STORE, "demo"), lambda: known or {}))


@pytest.mark.usefixtures("plant")
def test_where_nothing_runs_the_database_knows_who_leads(
    state: Path, database: Database, capsys: pytest.CaptureFixture[str]
) -> None:
    database.led = LED
    assert client(state).submit("sis_a 0B 7") == QUEUED
    assert capsys.readouterr().err == ASKED


@pytest.mark.parametrize("standbys", [0, 1])
def test_where_nobody_leads_that_is_said(state: Path, database: Database, standbys: int) -> None:
    database.standbys = standbys
    with pytest.raises(NoLeader) as nobody:
        client(state).status()
    assert str(nobody.value) == f"No plant is running on {state}. Nobody leads the plant of {STORE} now."
    assert nobody.value.awaited is bool(standbys)


def test_after_silence_here_only_what_is_done_once_is_asked_of_the_next_leader(
    state: Path, machine: Machine, plant: Plant, database: Database
) -> None:
    database.led = LED
    with running(machine, state, CUT):
        assert client(state).operate(Verb.STOP) == {"verb": "stop", "scope": ""}
        assert client(state).submit("sis_a 0B 7 #lot-1") == QUEUED
        with pytest.raises(
            NoAnswer, match=r"did not answer\. Plant demo is led .* It may have taken the task"
        ):
            client(state).submit("sis_a 0B 7")
        with pytest.raises(NoAnswer, match="Plant demo is led on"):
            client(state).operate(Verb.CLEAR)
    assert plant.texts == ["sis_a 0B 7 #lot-1"] and plant.acts == [(Verb.STOP, "", False)]


def test_where_nobody_else_leads_silence_here_is_said(
    state: Path, machine: Machine, database: Database
) -> None:
    database.led = replace(LED, process=os.getpid())
    with running(machine, state, CUT), pytest.raises(NoAnswer, match=r"did not answer\.$"):
        client(state).operate(Verb.STOP)


def test_a_stop_that_a_slow_leader_has_not_answered_at_once_is_told_it_again(
    state: Path, machine: Machine, database: Database
) -> None:
    database.led = replace(LED, process=os.getpid())
    with running(machine, state, httpx.ReadTimeout("nothing came"), guarded(Plant()).app):
        assert client(state).operate(Verb.STOP) == {"verb": "stop", "scope": ""}
    assert machine.asked == [HERE, HERE]
