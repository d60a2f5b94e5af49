"""Two processes of one plant on one database: one leads, one stands by and takes over."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.app.state import find_running
from arboleda_kills.deeds import Did
from arboleda_kills.processes import Boards, Plant

from ..postgres import Server

pytestmark = pytest.mark.system

TASK = {"text": "sis_a 0B 7 #lot-1"}
PATIENCE_S = 75.0
TAKEN_OVER_S = 20.0  # 3 s on a machine that has time; how long it takes is measured, not tested


class Hosts:
    """The processes, their boards and their broker; `ask` asks one of them."""

    def __init__(self, folder: Path, database: str, port: int) -> None:
        self._folder = folder
        self._broker = EmbeddedBroker(port=port)
        self._broker.start()
        self._options = ("--store", database, "--broker", f"127.0.0.1:{port}")
        self.boards = Boards(1.0, folder / "boards.log")
        self.boards.broker("127.0.0.1", port)
        self.plants: dict[str, Plant] = {}

    def up(self, name: str, *options: str) -> Plant:
        log = self._folder / f"{name}.log"
        made = Plant(self._folder / name, log, lambda *_: None, (*self._options, *options))
        self.plants[name] = made
        return made

    def ask(self, name: str) -> dict[str, Any]:
        """What its API says of the plant; {} where nobody answers."""
        running = find_running(self._folder / name)
        if running is None or running.port is None:
            return {}
        try:
            return httpx.get(f"{running.url}/api/plant", trust_env=False, timeout=2.0).json()
        except httpx.HTTPError:
            return {}

    def cell(self, name: str) -> dict[str, Any]:
        return next((row for row in self.ask(name).get("cells", ()) if row["name"] == "sis_a"), {})

    def until(self, true: Callable[[], Any]) -> float:
        """How long it took, in s."""
        began = time.monotonic()
        while not true():
            assert time.monotonic() - began < PATIENCE_S
            time.sleep(0.02)
        return time.monotonic() - began

    def at_work(self) -> None:
        """A leader that drives, and a standby that waits for it."""
        self.up("a")
        self.until(lambda: self.cell("a").get("not_ready", "no") is None)
        self.up("b", "--standby")
        self.until(lambda: "process" in self.ask("b").get("sentence", ""))
        assert self.plants["a"].await_api(time.time() + PATIENCE_S)
        assert self.plants["a"].ask("POST", "/api/tasks", TASK)[0] == 202
        self.until(lambda: self.cell("a").get("step") == "drive path 0B")

    def parts(self) -> list[tuple[Did, str]]:
        return [(deed.did, deed.what) for deed in self.boards.deeds if deed.did is not Did.WAS_TOLD]

    def finish_with(self, name: str) -> None:
        """The task that was at work comes to its end there, once somebody lets it go on."""
        self.until(
            lambda: self.cell(name).get("state") == "held" and "resume" not in self.cell(name)["refused"]
        )
        assert self.plants[name].await_api(time.time() + PATIENCE_S)
        assert self.plants[name].ask("POST", "/api/cells/sis_a/resume")[0] == 200
        self.done_with(name)

    def done_with(self, name: str) -> None:
        self.until(lambda: self.cell(name).get("state") == "idle")
        assert self.plants[name].await_api(time.time() + PATIENCE_S)
        (row,) = self.plants[name].ask("GET", "/api/history")[1]
        assert (row["id"], row["state"]) == ("lot-1", "done")
        assert self.parts() == [(Did.PICKED, "pick-up"), (Did.LET_GO, "station 7")]

    def end(self) -> None:
        for each in self.plants.values():
            each.kill()
        self.boards.end()
        self._broker.stop()


@pytest.fixture
def hosts(tmp_path: Path, postgres: Server, database: str, free_port: int) -> Iterator[Hosts]:
    with postgres.connection() as db:
        db.execute("DROP SCHEMA IF EXISTS plant_arboleda CASCADE")
    made = Hosts(tmp_path, database, free_port)
    yield made
    made.end()


def test_a_standby_takes_over_from_a_leader_that_is_killed(
    hosts: Hosts, arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    hosts.at_work()
    status = arboleda("status", "--state", str(tmp_path / "b"))
    assert status.wait() == 0
    pid = hosts.plants["a"].pid
    assert f"this process stands by; it waits for the end of process {pid} on" in status.output
    refused = arboleda("submit", "sis_a 0B 1", "--state", str(tmp_path / "b"))
    assert refused.wait() == 1 and "stands by and does nothing itself" in refused.output
    page = httpx.get(find_running(tmp_path / "b").url, trust_env=False).text
    assert find_running(tmp_path / "a").url in page and "en reserva" in page
    hosts.plants["a"].kill()
    assert hosts.until(lambda: hosts.cell("b")) < TAKEN_OVER_S
    hosts.finish_with("b")


def test_a_leader_that_was_frozen_steps_down_and_moves_nothing(hosts: Hosts, tmp_path: Path) -> None:
    hosts.at_work()
    hosts.plants["a"].freeze(on=True)
    assert hosts.until(lambda: hosts.cell("b")) < TAKEN_OVER_S
    hosts.until(lambda: hosts.cell("b").get("state") == "held")
    told = len(hosts.boards.deeds)
    hosts.plants["a"].freeze(on=False)
    status, words = hosts.plants["a"].ended()
    assert status == 1 and "this one steps down" in words
    assert len(hosts.boards.deeds) == told
    hosts.finish_with("b")


def test_a_planned_handover_fails_no_task_and_needs_nobody_to_resume(
    hosts: Hosts, arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    hosts.at_work()
    asked = arboleda("handover", "--state", str(tmp_path / "a"))
    assert asked.wait() == 0, asked.output
    assert f"process {hosts.plants['b'].pid} on" in asked.output
    gap_s = float(re.search(r"for ([\d.]+) s of them nobody did", asked.output)[1])
    assert gap_s < TAKEN_OVER_S
    assert hosts.plants["a"].ended()[0] == 0
    hosts.done_with("b")
    alone = arboleda("handover", "--state", str(tmp_path / "b"))
    assert alone.wait() == 1 and "start `arboleda up --standby` on another host" in alone.output


def test_a_standby_needs_a_database(arboleda: Callable[..., Any]) -> None:
    refused = arboleda("up", "--no-ros", "--standby")
    assert refused.wait() == 1 and "--standby needs a memory that both hosts reach" in refused.output
    asked = arboleda("handover")
    assert asked.wait() == 1 and "give it a database" in asked.output


def test_a_standby_waits_for_a_database_that_is_away(
    hosts: Hosts, postgres: Server, arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    hosts.at_work()
    postgres.stop()
    try:
        hosts.until(lambda: "waits for the database" in hosts.ask("b").get("sentence", ""))
        assert hosts.plants["a"].ended()[0] == 1
    finally:
        postgres.start()
    # its robots were stopped by commands that nobody could keep: where it stands is for a person to say
    hosts.until(
        lambda: hosts.cell("b").get("state") == "held" and "abandon" not in hosts.cell("b")["refused"]
    )
    plant = hosts.plants["b"]
    assert plant.await_api(time.time() + PATIENCE_S)
    assert plant.ask("POST", "/api/cells/sis_a/abandon")[0] == 200
    hosts.until(lambda: [row["state"] for row in plant.ask("GET", "/api/history")[1]] == ["failed"])
    assert not hosts.parts()
