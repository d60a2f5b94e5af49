"""Commands on a host that does not lead the plant: they go to who does, or say why they cannot."""

from __future__ import annotations

import json
import os
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from arboleda.cli import remote_plant
from arboleda.cli.client import PlantClient
from arboleda.cli.remote_plant import NoLeader, RemotePlant
from arboleda.client import NoAnswer
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Verb
from arboleda.runtime.standby.leader import LeaderInfo
from arboleda.runtime.standby.waiting_room import WaitingRoom
from arboleda.runtime.state import StateDir
from arboleda.runtime.tokens import TOKENS as FILE
from arboleda.runtime.web_options import WebOptions
from arboleda.web.access.auth import Role

from ...patience import SOON_S
from .conftest import QUEUED, TASK, TOKENS, VIEW, Plant, Web

HERE = LeaderInfo(plant="demo", host=socket.gethostname(), process=7, url="", epoch=7)
ASKED = f"plant demo is led on {HERE.host}: asked there\n"
STORE = "postgresql://db"


@pytest.fixture
def state(tmp_path: Path) -> Path:
    return tmp_path / "state"


@contextmanager
def standing_by(state: Path, led: LeaderInfo | None) -> Iterator[None]:
    """A process on this state directory that stands by."""
    room = WaitingRoom("demo", state, WebOptions(port=0))
    with StateDir(state, plant="demo", store=STORE) as made:
        room.start(made.announce)
        room.show("waits for its end", led)
        try:
            yield
        finally:
            room.stop()


def led_at(port: int) -> LeaderInfo:
    return replace(HERE, url=f"http://127.0.0.1:{port}")


class Database:
    """Says who leads, as `leadership_of`."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.led: LeaderInfo | None = None
        self.standbys = 0
        self.name = STORE
        monkeypatch.setattr(remote_plant, "leadership_of", lambda store, plant: self)

    def leader(self):
        from arboleda.store.postgres.leadership import Leader

        led = self.led or HERE
        return Leader(
            epoch=led.epoch,
            host=led.host,
            process=led.process,
            url=led.url,
            leads=self.led is not None,
            standbys=self.standbys,
        )

    def close(self) -> None:
        pass


@pytest.fixture
def database(monkeypatch: pytest.MonkeyPatch) -> Database:
    pytest.importorskip("psycopg")
    return Database(monkeypatch)


def client(state: Path, known: dict[str, str] | None = None) -> PlantClient:
    return PlantClient(state, RemotePlant(state, lambda: (STORE, "demo"), lambda: known or {}))


def keep_tokens(state: Path) -> None:
    state.mkdir(exist_ok=True)
    (state / FILE).write_text(json.dumps({role.value: token for role, token in TOKENS.items()}))
    (state / FILE).chmod(0o600)


def test_what_is_asked_of_a_standby_is_asked_of_the_leader_and_said_once(
    state: Path, local: Web, plant: Plant, capsys: pytest.CaptureFixture[str]
) -> None:
    with standing_by(state, led_at(local.port)):
        reached = PlantClient(state)
        assert reached.submit("sis_a 0B 7") == QUEUED
        assert reached.operate(Verb.STOP) == {"verb": "stop", "scope": ""}
        assert reached.status() == VIEW and reached.task("t-1") == QUEUED
        assert next(reached.changes())[0] == "snapshot"
    assert (plant.texts, plant.asked_by) == (["sis_a 0B 7"], ["command"])
    assert plant.acts == [(Verb.STOP, "", False)]
    assert capsys.readouterr().err == ASKED


@pytest.mark.parametrize("by", ["state directory", "name", "address"])
def test_a_leader_that_wants_a_token_is_shown_one_that_is_known_for_it(
    state: Path, open_to_all: Web, by: str
) -> None:
    known = {"name": "demo", "address": open_to_all.origin}.get(by)
    if known is None:
        keep_tokens(state)
    with standing_by(state, led_at(open_to_all.port)):
        reached = client(state, {known: TOKENS[Role.OPERATOR]} if known else {})
        assert reached.submit("sis_a 0B 7") == QUEUED


@pytest.mark.parametrize("known", [{}, {"demo": "x" * 32}], ids=["none", "a wrong one"])
def test_a_leader_that_refuses_the_token_has_it_said_where_one_belongs(
    state: Path, open_to_all: Web, known: dict[str, str]
) -> None:
    with standing_by(state, led_at(open_to_all.port)), pytest.raises(ArboledaError) as refused:
        client(state, known).status()
    said = str(refused.value)
    assert said.startswith(f"Plant demo is led on {HERE.host}, which refuses this at {open_to_all.origin}: ")
    assert ("no token is known for it" in said) is (not known)
    assert f"copy tokens.json of the state directory there into {state}" in said
    assert "`demo TOKEN`" in said and "--tokens or $ARBOLEDA_TOKENS" in said


def test_a_viewers_token_lets_it_look_and_stop(state: Path, open_to_all: Web) -> None:
    with standing_by(state, led_at(open_to_all.port)):
        reached = client(state, {"demo": TOKENS[Role.VIEWER]})
        assert reached.operate(Verb.STOP)["verb"] == "stop"
        with pytest.raises(ArboledaError, match="A viewer may look and stop"):
            reached.submit("sis_a 0B 7")


def test_a_leader_that_is_not_there_is_said_to_at_once(state: Path, free_port: int) -> None:
    began = time.monotonic()
    with standing_by(state, led_at(free_port)), pytest.raises(NoAnswer) as silent:
        PlantClient(state).operate(Verb.STOP)
    assert time.monotonic() - began < SOON_S
    assert f"which cannot be reached at http://127.0.0.1:{free_port} (" in str(silent.value)


def test_an_address_that_only_the_leaders_host_reaches_is_said_to_be_that(state: Path) -> None:
    with standing_by(state, replace(led_at(8080), host="host-a")), pytest.raises(ArboledaError) as far:
        PlantClient(state).status()
    assert str(far.value).endswith(
        "it waits for its end. Plant demo is led on host-a, at http://127.0.0.1:8080, which is reached from"
        " host-a alone: start both hosts with `--host ADDRESS`, 0.0.0.0 or an address that other hosts reach."
    )


def test_an_address_where_another_plant_answers_gets_nothing_done(
    state: Path, serve: Callable[..., Web], plant: Plant
) -> None:
    web = serve(name="painting")
    with standing_by(state, led_at(web.port)), pytest.raises(ArboledaError, match="'demo' is meant"):
        PlantClient(state).operate(Verb.STOP)
    assert plant.acts == []


def test_where_what_answers_stands_by_as_well_nothing_goes_round_and_round(
    state: Path, tmp_path: Path
) -> None:
    other = WaitingRoom("demo", tmp_path, WebOptions(port=0))
    other.start(lambda *_, **__: None)
    other.show("waits", led_at(9))
    try:
        with standing_by(state, led_at(other.port)), pytest.raises(ArboledaError, match="changes just now"):
            PlantClient(state).submit("sis_a 0B 7")
    finally:
        other.stop()


def test_while_nobody_leads_a_standby_says_what_it_waits_for(state: Path) -> None:
    with standing_by(state, None), pytest.raises(ArboledaError, match=r"stands by and .* waits for its end$"):
        PlantClient(state).status()


def test_where_nothing_runs_the_database_knows_who_leads(
    state: Path, local: Web, database: Database, capsys: pytest.CaptureFixture[str]
) -> None:
    database.led = led_at(local.port)
    assert client(state).submit("sis_a 0B 7") == QUEUED
    assert capsys.readouterr().err == ASKED


@pytest.mark.parametrize("standbys", [0, 1])
def test_where_nobody_leads_that_is_said(state: Path, database: Database, standbys: int) -> None:
    database.standbys = standbys
    with pytest.raises(NoLeader) as nobody:
        client(state).status()
    assert str(nobody.value) == f"No plant is running on {state}. Nobody leads the plant of {STORE} now."
    assert nobody.value.awaited is bool(standbys)


@pytest.fixture
def cutting() -> Iterator[int]:
    """The port of a process that takes connections and cuts them without an answer."""
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def cut() -> None:
            while True:
                try:
                    listener.accept()[0].close()
                except OSError:
                    return

        thread = threading.Thread(target=cut, daemon=True)
        thread.start()
        yield listener.getsockname()[1]
        listener.shutdown(socket.SHUT_RDWR)
        thread.join()


def test_after_silence_here_only_what_is_done_once_is_asked_of_the_next_leader(
    state: Path, cutting: int, local: Web, plant: Plant, database: Database
) -> None:
    database.led = led_at(local.port)
    with StateDir(state, plant="demo") as here:
        here.announce(cutting)
        assert client(state).operate(Verb.STOP) == {"verb": "stop", "scope": ""}
        assert client(state).submit("sis_a 0B 7 #lot-1") == QUEUED
        with pytest.raises(
            NoAnswer, match=r"did not answer\. Plant demo is led .* It may have taken the task"
        ):
            client(state).submit("sis_a 0B 7")
        with pytest.raises(NoAnswer, match="Plant demo is led on"):
            client(state).operate(Verb.CLEAR)
    assert plant.texts == ["sis_a 0B 7 #lot-1"] and plant.acts == [(Verb.STOP, "", False)]


def test_where_nobody_else_leads_silence_here_is_said(state: Path, cutting: int, database: Database) -> None:
    database.led = replace(led_at(cutting), process=os.getpid())
    with StateDir(state, plant="demo") as here:
        here.announce(cutting)
        with pytest.raises(NoAnswer, match=r"did not answer\.$"):
            client(state).operate(Verb.STOP)


def test_a_stop_that_a_slow_leader_has_not_answered_at_once_is_told_it_again(
    state: Path, database: Database
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener, StateDir(state, plant="demo") as here:

        def answer_the_second() -> None:
            first, second = listener.accept()[0], listener.accept()[0]
            second.recv(4096)
            second.sendall(b'HTTP/1.1 200 OK\r\nContent-Length: 15\r\n\r\n{"verb":"stop"}')
            second.close()
            first.close()

        thread = threading.Thread(target=answer_the_second, daemon=True)
        thread.start()
        here.announce(listener.getsockname()[1])
        database.led = replace(led_at(listener.getsockname()[1]), process=os.getpid())
        assert client(state).operate(Verb.STOP) == {"verb": "stop"}
        thread.join()


def test_who_follows_a_task_goes_on_with_the_next_leader(
    state: Path,
    serve: Callable[..., Web],
    plant: Plant,
    database: Database,
    capsys: pytest.CaptureFixture[str],
) -> None:
    before, after = serve(), serve()
    plant.view = VIEW | {"tasks": [TASK | {"state": "running"}]}
    with StateDir(state, plant="demo") as here:
        here.announce(before.port)
        told = client(state).follow(QUEUED)
        assert next(told)["state"] == "running"
        before.server.stop()
    database.standbys = 1
    plant.view = VIEW | {"epoch": 8, "tasks": [TASK | {"state": "done"}]}
    database.led = replace(led_at(after.port), epoch=8)
    assert [row["state"] for row in told] == ["done"]
    assert capsys.readouterr().err == f"plant demo is led on {HERE.host}: followed there\n"


def test_of_a_task_that_ended_between_two_leaders_the_history_tells(
    state: Path, local: Web, plant: Plant
) -> None:
    plant.view = VIEW | {"tasks": []}
    with StateDir(state, plant="demo") as here:
        here.announce(local.port)
        assert [row["state"] for row in client(state).follow(QUEUED | {"id": "t-2"})] == ["failed"]
