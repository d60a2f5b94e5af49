"""The plant as the web side sees it, and where the server listens."""

from __future__ import annotations

import ssl
from concurrent.futures import Future
from pathlib import Path

import pytest

from arboleda.adapters.server_tls import ServerTls
from arboleda.model.errors import ArboledaError, QueueFull, StartError
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.runtime.parts.local_plant import LocalPlant
from arboleda.runtime.parts.web import WebPart
from arboleda.runtime.web_options import WebOptions
from arboleda.store.task_rows import TaskHistory
from arboleda.web.access.names import names_for

NO_HISTORY = TaskHistory(Path("none"))


class Plant:
    def __init__(self) -> None:
        self.asked: list[Future] = []

    def snapshot(self, within_s: float = 0.0) -> dict:
        return {}

    def offers(self) -> list[dict]:
        return []

    def spelled(self, **_asked: object) -> str:
        return ""

    def find(self, task: str) -> None:
        return None

    def operate(self, *_args: object, **_options: object) -> Future:
        return Future()

    def act(self, _number: int) -> None:
        return None

    def promises(self, _text: str) -> list[dict]:
        return []

    def submit(self, _text: str, _asked_by: str, _choice: str = "", version: str = "") -> Future:
        self.asked.append(Future())
        return self.asked[-1]


@pytest.fixture
def side() -> LocalPlant:
    return LocalPlant(Plant(), NO_HISTORY)


def test_every_watcher_is_told_until_it_ends_that(side: LocalPlant) -> None:
    one, other = [], []
    end = side.watch(one.append)
    side.watch(other.append)
    side.saw({"at": 1})
    end()
    end()
    side.saw({"at": 2})
    assert (one, other) == ([{"at": 1}], [{"at": 1}, {"at": 2}])


def test_a_watcher_that_fails_is_told_no_more_and_the_others_are(side: LocalPlant, caplog) -> None:
    heard = []
    side.watch(lambda snapshot: 1 / 0)
    side.watch(heard.append)
    side.saw({"at": 1})
    side.saw({"at": 2})
    assert len(heard) == 2
    assert [record.levelname for record in caplog.records] == ["ERROR"]


def test_a_task_and_an_error_come_as_plain_data_and_as_the_error() -> None:
    plant = Plant()
    side = LocalPlant(plant, NO_HISTORY)
    good, bad = side.submit("a", "http"), side.submit("b", "http")
    plant.asked[0].set_result(TaskChanged(task="t-1", text="a", cell="sis_a", state=TaskState.QUEUED))
    plant.asked[1].set_exception(ArboledaError("The disk is full."))
    assert good.result(0)["state"] == "queued"
    with pytest.raises(ArboledaError, match="The disk is full"):
        bad.result(0)


def test_a_task_that_is_refused_for_now_is_an_error_of_its_own() -> None:
    plant = Plant()
    side = LocalPlant(plant, NO_HISTORY)
    full, wrong = side.submit("a", "http"), side.submit("b", "http")
    facts = {"task": "", "cell": None, "state": TaskState.REFUSED}
    plant.asked[0].set_result(TaskChanged(text="a", sentence="20 tasks wait", for_now=True, **facts))
    plant.asked[1].set_result(TaskChanged(text="b", sentence="no cell b", **facts))
    with pytest.raises(QueueFull, match=r"^20 tasks wait$"):
        full.result(0)
    assert wrong.result(0)["sentence"] == "no cell b"


@pytest.mark.parametrize(
    ("options", "guarded", "near"),
    [
        ({}, False, "127.0.0.1"),
        ({"host": "localhost"}, False, "127.0.0.1"),
        ({"host": "127.0.0.2"}, False, "127.0.0.2"),
        ({"host": "::1"}, False, "[::1]"),
        ({"host": "0.0.0.0"}, True, "127.0.0.1"),
        ({"host": "::"}, True, "[::1]"),
        ({"host": "192.168.1.5"}, True, "192.168.1.5"),
        ({"public_url": "https://plant.example"}, True, "127.0.0.1"),
    ],
)
def test_a_token_is_demanded_wherever_others_may_come_from(options: dict, guarded: bool, near: str) -> None:
    web = WebOptions(**options)
    assert (web.guarded, web.near) == (guarded, near)


def test_a_host_that_is_no_address_is_refused() -> None:
    with pytest.raises(StartError):
        _ = WebOptions(host="plant").guarded


def test_with_a_certificate_its_address_is_that_of_tls() -> None:
    tls = ServerTls(certificate=Path("x.crt"), context=ssl.create_default_context(), pem="", until=0.0)
    assert (WebOptions().scheme, WebOptions(tls=tls).scheme) == ("http", "https")
    names = names_for("0.0.0.0", None, scheme="https")
    assert names.knows_origin("https://10.0.0.7:8080", "10.0.0.7:8080")
    assert not names.knows_origin("http://10.0.0.7:8080", "10.0.0.7:8080")


@pytest.mark.parametrize(
    ("options", "page", "api"),
    [
        ({}, "http://127.0.0.1:0", "http://127.0.0.1:0"),
        ({"host": "0.0.0.0"}, "http://10.0.0.5:0", "http://10.0.0.5:0"),
        ({"public_url": "https://plant.lab"}, "https://plant.lab", "http://127.0.0.1:0"),
    ],
)
def test_people_are_told_the_address_that_they_open(
    options: dict, page: str, api: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("arboleda.web.access.names.interface_addresses", lambda: ["127.0.0.1", "10.0.0.5"])
    side, web = LocalPlant(Plant(), NO_HISTORY), WebOptions(port=0, **options)
    part = WebPart(side, "demo", tmp_path, lambda *_, **__: None, web, mount=lambda app: None)
    assert part.notes[:2] == [f"Page: {page}", f"HTTP API: {api}/api/plant"]
    assert part.address_of("sis_a", None) == f"{page}/?tab=cells&cell=sis_a"
