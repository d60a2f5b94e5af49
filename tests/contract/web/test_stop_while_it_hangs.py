"""A real plant with its server: a stop takes effect, and is answered as a hold is, while the disk hangs."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from tests.patience import PATIENCE_S

from arboleda.cli.client import PlantClient
from arboleda.departures.leaving import ends_motion
from arboleda.model.messages import Verb
from arboleda.runtime.build import App, Options, build
from arboleda.store.sqlite import Store
from arboleda.testing import shipped


class Robots:
    """The port to the robots: which of them were told to stop."""

    def __init__(self) -> None:
        self.stopped: set[str] = set()

    def send(self, message: Any) -> None:
        if ends_motion(message):
            self.stopped.add(message.robot)


class Disk:
    """A store whose syncs hang once it `hangs`, until they are let go on."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.hangs = False
        self.reached, self.let_go = threading.Event(), threading.Event()
        sync = Store.sync

        def slowly(store: Store) -> None:
            if self.hangs:
                self.reached.set()
                assert self.let_go.wait(PATIENCE_S)
            sync(store)

        monkeypatch.setattr(Store, "sync", slowly)


@pytest.fixture
def robots() -> Robots:
    return Robots()


@pytest.fixture
def disk(monkeypatch: pytest.MonkeyPatch) -> Disk:
    return Disk(monkeypatch)


@pytest.fixture
def app(tmp_path: Path, robots: Robots, disk: Disk) -> Iterator[App]:
    made = build(shipped("sis_a"), {"orchestrator", "web"}, Options(state_dir=tmp_path, page=False))
    made.plant.connect(robots)
    made.start()
    disk.hangs = True
    made.plant.submit("sis_a 0B 1 #a")
    assert disk.reached.wait(PATIENCE_S)
    yield made
    disk.let_go.set()
    made.stop()


def address(app: App) -> str:
    note = next(note for note in app.notes if note.startswith("HTTP API: "))
    return note.split()[2]  # behind it may stand that the usual port is taken


def test_whoever_asks_is_told_that_the_stop_has_left_and_is_not_kept_yet(
    app: App, robots: Robots, disk: Disk, tmp_path: Path
) -> None:
    said = PlantClient(tmp_path).operate(Verb.STOP, "ra1")
    assert "the stop has left for ra1" in said["why"]
    assert robots.stopped == {"ra1"}
    url = address(app)
    with httpx.Client(trust_env=False, timeout=PATIENCE_S) as client:
        answer = client.post(f"{url}/stop")
        assert answer.status_code == 202 and "has not kept it" in answer.json()["why"]
        assert robots.stopped == {"ra1", "rm_sis_a"}
        held = client.post(f"{url.replace('plant', 'cells/sis_a')}/hold")
        assert held.status_code == 202 and "has not done it yet" in held.json()["why"]
        seen = client.get(url).json()
        assert seen["tasks"] == [] and not any(robot["latched"] for robot in seen["robots"])
        unknown = client.get(url.replace("plant", "tasks/a"))
        assert unknown.status_code == 503 and unknown.json()["key"] == "plant.not_kept"
        assert not disk.let_go.is_set()
