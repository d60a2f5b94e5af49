"""Answers of a process that stands by: the address of the leader, and nothing of its own."""

from __future__ import annotations

import socket
from collections.abc import Callable
from pathlib import Path

import pytest
from tests.in_process import ORIGIN, Caller

from arboleda.runtime import tokens
from arboleda.runtime.leader import LeaderInfo
from arboleda.runtime.web_options import WebOptions
from arboleda_fleet.standby.waiting_room import WaitingRoom

LED = LeaderInfo(plant="demo", host="host-a", process=7, url="http://10.0.0.5:8080", epoch=3)
NEAR = "http://127.0.0.1:8081"
TASK = {"text": "sis_a 0B 7"}


@pytest.fixture
def rooms(tmp_path: Path) -> Callable[..., Caller]:
    """`rooms(led)`: a client of a room that knows of this leader."""

    def made(led: LeaderInfo | None, **options: object) -> Caller:
        room = WaitingRoom("demo", tmp_path, WebOptions(**{"port": 8080, **options}))
        room.show("waits for host-a", led)
        return Caller(room.app)

    return made


@pytest.fixture
def room(rooms: Callable[..., Caller]) -> Caller:
    return rooms(LED)


def test_it_says_that_it_stands_by_and_who_leads(room: Caller) -> None:
    said = room.get("/api/plant")
    assert said.status_code == 200
    assert said.json() == {
        "plant": "demo",
        "standby": True,
        "sentence": "waits for host-a",
        "leader": LED.url,
        "host": "host-a",
        "process": 7,
        "epoch": 3,
    }


@pytest.mark.parametrize("method", ["GET", "POST", "PATCH", "DELETE"])
def test_a_request_of_the_api_is_sent_on_as_it_was_made(room: Caller, method: str) -> None:
    answer = room.request(method, "/api/cells/a%2Fb%20c/hold?x=1&y=%C3%A9", json=TASK)
    assert answer.status_code == 307
    assert answer.headers["location"] == f"{LED.url}/api/cells/a%2Fb%20c/hold?x=1&y=%C3%A9"
    assert answer.json()["sentence"] == "this process stands by and does nothing itself: it waits for host-a"


@pytest.mark.parametrize(
    ("led", "options"),
    [
        (None, {}),
        (LeaderInfo(plant="demo", host="host-a", process=7, url="", epoch=3), {}),
        (LeaderInfo(plant="demo", host="host-a", process=7, url=NEAR, epoch=3), {}),
        (LED, {"public_url": LED.url}),
    ],
    ids=["nobody", "no address", "only its own host reaches it", "the name that both have"],
)
def test_where_nobody_is_to_be_reached_at_another_address_it_is_unavailable(
    rooms: Callable[..., Caller], tmp_path: Path, led: LeaderInfo | None, options: dict[str, str]
) -> None:
    known = tokens.read(tmp_path)
    room = rooms(led, **options)
    if options:
        room.headers["authorization"] = f"Bearer {known[tokens.Role.OPERATOR]}"
    answer = room.post("/api/tasks", json=TASK)
    assert (answer.status_code, answer.headers["retry-after"]) == (503, "1")


def test_on_one_machine_the_address_of_one_machine_will_do(rooms: Callable[..., Caller]) -> None:
    led = LeaderInfo(plant="demo", host=socket.gethostname(), process=7, url=NEAR, epoch=3)
    assert rooms(led).post("/api/tasks", json=TASK).headers["location"] == f"{NEAR}/api/tasks"


@pytest.mark.parametrize("path", ["/metrics", "/_nicegui/x.js", "/apiary"])
def test_what_is_no_question_to_the_plant_is_not_sent_on(room: Caller, path: str) -> None:
    assert room.get(path).status_code == 503  # who counts two hosts must not count one of them twice


def test_a_page_elsewhere_learns_nothing(room: Caller) -> None:
    assert room.post("/api/plant/stop", headers={"origin": "http://evil.example"}).status_code == 403


def test_who_means_another_plant_is_told_so(room: Caller) -> None:
    answer = room.post("/api/plant/stop", headers={"arboleda-plant": "painting"})
    assert answer.status_code == 421
    assert answer.json()["sentence"] == "This is the plant demo, and 'painting' is meant."


def test_its_page_leads_to_that_of_the_leader_where_that_can_be(rooms: Callable[..., Caller]) -> None:
    assert f'href="{LED.url}"' in rooms(LED).get("/").text
    far = rooms(LeaderInfo(plant="demo", host="host-a", process=7, url=NEAR, epoch=3)).get("/").text
    assert "Only host-a reaches that page." in far and "href" not in far


def test_a_person_logs_in_where_tokens_are_wanted(rooms: Callable[..., Caller], tmp_path: Path) -> None:
    token = tokens.read(tmp_path)[tokens.Role.VIEWER]
    room = rooms(LED, public_url="http://plant.lab")
    assert room.get("/api/plant").status_code == 401
    page = room.get("/", headers={"accept": "text/html"})
    assert (page.status_code, page.headers["location"]) == (303, "/login")
    entered = room.post("/login", data={"token": token}, headers={"origin": ORIGIN})
    assert entered.status_code == 303
    assert "stands by" in room.get("/").text
