"""Commands ask the process that leads the plant, over real connections."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from tests.contract.web.conftest import Web
from tests.contract.web.conftest import local as local
from tests.contract.web.conftest import plant as plant
from tests.contract.web.conftest import serve as serve
from tests.contract.web.conftest import web as web
from tests.patience import PATIENCE_S
from tests.web_plant import QUEUED, TASK, VIEW, Plant

from arboleda.cli.client import PlantClient
from arboleda.cli.remote_plant import RemotePlant
from arboleda.model.messages import Verb
from arboleda.runtime.leader import LeaderInfo
from arboleda.runtime.state import StateDir
from arboleda.runtime.web_options import WebOptions
from arboleda_fleet.standby.waiting_room import WaitingRoom

HERE = socket.gethostname()


@contextmanager
def standing_by(state: Path, url: str) -> Iterator[WaitingRoom]:
    """A process on this state directory that stands by, while the plant is led at that address."""
    room = WaitingRoom("demo", state, WebOptions(port=0))
    with StateDir(state, plant="demo") as made:
        room.start(made.announce)
        room.show("waits for its end", LeaderInfo(plant="demo", host=HERE, process=7, url=url, epoch=7))
        try:
            yield room
        finally:
            room.stop()


def test_what_is_asked_of_a_standby_is_asked_of_the_leader_and_said_once(
    local: Web, plant: Plant, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with standing_by(tmp_path, local.origin):
        reached = PlantClient(tmp_path)
        assert reached.operate(Verb.STOP) == {"verb": "stop", "scope": ""}
        assert next(reached.changes())[0] == "snapshot"
    assert plant.acts == [(Verb.STOP, "", False)]
    assert capsys.readouterr().err == f"plant demo is led on {HERE}: asked there\n"


def test_who_follows_a_task_goes_on_with_the_next_leader(
    serve: Callable[..., Web],
    plant: Plant,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("arboleda.cli.client.NEXT_S", PATIENCE_S)
    before, after = serve(), serve()
    kept_by_several = RemotePlant(tmp_path, lambda: ("postgresql://db", "demo"), dict)
    plant.view = VIEW | {"tasks": [TASK | {"state": "running"}]}
    with standing_by(tmp_path, before.origin) as room:
        told = PlantClient(tmp_path, kept_by_several).follow(QUEUED)
        assert next(told)["state"] == "running"
        plant.view = VIEW | {"epoch": 8, "tasks": [TASK | {"state": "done"}]}
        room.show("waits", LeaderInfo(plant="demo", host=HERE, process=8, url=after.origin, epoch=8))
        before.server.stop()
        assert [row["state"] for row in told] == ["done"]
    said = capsys.readouterr().err
    assert said.endswith(f"plant demo is led on {HERE}: followed there\n")
