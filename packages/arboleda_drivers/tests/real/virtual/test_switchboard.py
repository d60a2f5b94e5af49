"""The HTTP port on which faults of virtual controllers are switched."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest
from tests.patience import PATIENCE_S

from arboleda_drivers.virtual.faults import Faults
from arboleda_drivers.virtual.switchboard import Switchboard

pytestmark = pytest.mark.system


@pytest.fixture
def board() -> Iterator[tuple[Faults, httpx.Client]]:
    faults = Faults({"mute": "it says nothing", "slow": "it is slow"}, ["slow"])
    switchboard = Switchboard(faults, 0)
    switchboard.start()
    with httpx.Client(base_url=f"http://127.0.0.1:{switchboard.port}", timeout=PATIENCE_S) as client:
        yield faults, client
    switchboard.stop()


def test_faults_are_listed_and_switched_and_what_is_not_there_is_told(
    board: tuple[Faults, httpx.Client],
) -> None:
    faults, client = board
    assert client.get("/faults").json()["slow"] == {"on": True, "what": "it is slow"}
    assert client.put("/faults/mute").json()["mute"]["on"] is True
    client.delete("/faults/slow")
    answers = {path: client.put(path) for path in ("/faults/mut", "/mute", "/faults/", "/")}
    assert {path: answer.status_code for path, answer in answers.items()} == dict.fromkeys(answers, 404)
    assert all("error" in answer.json() for answer in answers.values())
    assert list(faults) == ["mute"]
