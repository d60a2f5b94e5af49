"""Faults by hand at the virtual devices of a real start: over HTTP, by command, and on the page."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from ..patience import PATIENCE_MS, PATIENCE_S
from .conftest import Process
from .page import connected, running, show, until

pytestmark = pytest.mark.system
NO_GRIP = {"kind": "no_grip", "robot": "ra1", "seconds": 600}


@pytest.fixture
def plant(tmp_path: Path) -> Iterator[tuple[str, httpx.Client]]:
    with (
        running(tmp_path / "state") as address,
        httpx.Client(base_url=address, trust_env=False, timeout=PATIENCE_S) as http,
    ):
        yield address, http


def robot(http: httpx.Client, name: str) -> dict[str, Any]:
    robots = http.get("/api/plant").raise_for_status().json()["robots"]
    found: dict[str, Any] = next(each for each in robots if each["name"] == name)
    return found


def faults(http: httpx.Client) -> list[dict[str, Any]]:
    begun: list[dict[str, Any]] = http.get("/api/faults").raise_for_status().json()["begun"]
    return begun


def test_a_board_without_power_is_offline_until_the_fault_is_ended_by_command(
    plant: tuple[str, httpx.Client], typed: Callable[..., tuple[int, str]]
) -> None:
    _, http = plant
    until(lambda: robot(http, "ra1")["online"])
    boot = robot(http, "ra1")["boot_id"]
    assert typed("fault", "reboot", "ra1", "--for", "10m") == (
        0,
        "ra1: no_power (Take its power away), for 600 s",
    )
    until(lambda: not robot(http, "ra1")["online"])
    assert [(each["robot"], each["kind"]) for each in faults(http)] == [("ra1", "no_power")]
    assert robot(http, "rm_sis_a")["online"]
    assert typed("fault", "end", "ra1") == (0, "ra1: no_power (Take its power away): ended")
    until(lambda: robot(http, "ra1")["online"])
    assert robot(http, "ra1")["boot_id"] != boot
    assert typed("fault") == (0, "no fault goes on")
    told = [each["sentence"] for each in http.get("/api/plant").json()["faults"]]
    assert told[0] == "fault by hand: Take its power away, for 600 s"
    assert told[-1] == "fault by hand is over: Take its power away"


def test_a_part_that_is_not_gripped_fails_its_task_and_the_report_names_the_hand(
    plant: tuple[str, httpx.Client],
) -> None:
    _, http = plant
    assert http.post("/api/faults", json=NO_GRIP).raise_for_status().json()["left_s"] == pytest.approx(600)
    task = http.post("/api/tasks", json={"text": "sis_a 0B 7"}).raise_for_status().json()["id"]
    until(lambda: http.get(f"/api/tasks/{task}").json()["state"] == "failed")
    ended = http.post("/api/faults/end", json={"robot": "ra1"}).raise_for_status().json()
    assert [each["kind"] for each in ended] == ["no_grip"]
    until(lambda: http.get(f"/api/tasks/{task}/report").status_code == 200)
    report = http.get(f"/api/tasks/{task}/report").json()
    assert "Shortly before: fault by hand: Grip beside the part, for 600 s" in json.dumps(report)


@pytest.mark.parametrize(
    ("path", "body", "status", "said"),
    [
        ("", {"kind": "no_grip", "robot": "ra9"}, 409, "there is no device ra9; virtual ones are ra1"),
        ("", {"kind": "nonsense", "robot": "ra1"}, 409, "nonsense cannot be provoked at ra1; what can is"),
        ("", {"kind": "no_grip", "robot": "ra1", "seconds": 1e9}, 409, "from 0.1 s to 3600 s"),
        ("", {"kind": "no_grip", "robot": "ra1", "seconds": "5"}, 422, "seconds"),
        ("", {"kind": "no_grip"}, 422, "robot"),
        ("/end", {"number": 77}, 409, "no fault 77 goes on now"),
    ],
)
def test_a_wrong_request_changes_nothing_and_says_why(
    shared: httpx.Client, path: str, body: dict[str, Any], status: int, said: str
) -> None:
    answer = shared.post(f"/api/faults{path}", json=body)
    assert (answer.status_code, faults(shared)) == (status, [])
    assert said in answer.json()["sentence"]


def test_the_command_says_what_it_does_not_understand(
    typed: Callable[..., tuple[int, str]], plant: tuple[str, httpx.Client]
) -> None:
    for words, said in (
        (("no_grip",), "which device?"),
        (("no_grip", "ra1", "--for", "soon"), "'soon' is no time"),
        (("end", "--for", "5s"), "--for is of a fault that begins"),
        (("no_grip", "ra9"), "there is no device ra9"),
    ):
        status, out = typed("fault", *words)
        assert status == 2
        assert said in " ".join(out.split())
    assert "no_grip" in typed("fault", "--list")[1]


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    with (
        running(tmp_path_factory.mktemp("faults")) as address,
        httpx.Client(base_url=address, trust_env=False, timeout=PATIENCE_S) as http,
    ):
        yield http


def test_nothing_is_offered_where_boards_are_real(arboleda: Callable[..., Process], free_port: int) -> None:
    up = arboleda("up", "--no-ros", "--boards", "real", "--port", str(free_port))
    up.wait_for("HTTP API")
    with httpx.Client(base_url=f"http://127.0.0.1:{free_port}", trust_env=False, timeout=PATIENCE_S) as http:
        assert http.get("/api/faults").json() == {"begun": [], "offers": []}
        answer = http.post("/api/faults", json=NO_GRIP)
        assert answer.status_code == 409
        assert "only at virtual devices" in answer.json()["sentence"]
        assert 'id="faults"' not in http.get("/").text


@pytest.mark.requires("chromium", "playwright")
def test_the_drawer_of_the_page_begins_a_fault_shows_it_and_ends_it(
    browser: Any, plant: tuple[str, httpx.Client]
) -> None:
    address, http = plant
    page = browser.new_context().new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.goto(f"{address}/?lang=es")
    connected(page)
    page.click("#faults summary")
    page.select_option("#fault-target", "rm_sis_a")
    page.wait_for_selector("[data-fault=no_grip]", state="hidden")
    page.select_option("#fault-target", "ra1")
    page.select_option("#fault-seconds", "60")
    page.click("[data-fault=no_grip]")
    page.wait_for_selector(".fault-rows .row:has-text('ra1: Cerrar junto a la pieza')")
    assert [(each["robot"], each["kind"]) for each in faults(http)] == [("ra1", "no_grip")]
    page.click(".fault-rows [data-act=end_fault]")
    page.wait_for_selector(".fault-rows .row", state="detached")
    assert faults(http) == []
    page.click("[data-fault=lost_part]")
    show(page, "events")
    page.wait_for_selector("#part-events .row:has-text('fallo provocado: Perder la pieza')")
    page.wait_for_selector("#part-events .row:has-text('fallo provocado terminado: Cerrar junto a la pieza')")


def test_a_viewer_may_look_and_provoke_nothing(
    arboleda: Callable[..., Process], typed: Callable[..., tuple[int, str]], free_port: int
) -> None:
    up = arboleda("up", "--no-ros", "--host", "0.0.0.0", "--port", str(free_port))
    up.wait_for("HTTP API")
    shown = {"Authorization": f"Bearer {typed('token', 'viewer')[1]}"}
    where = f"http://127.0.0.1:{free_port}"
    with httpx.Client(base_url=where, headers=shown, trust_env=False, timeout=PATIENCE_S) as http:
        for path in ("", "/end"):
            answer = http.post(f"/api/faults{path}", json=NO_GRIP if not path else {})
            assert answer.status_code == 403
            assert "provoking a fault needs the operator's token" in answer.json()["sentence"]
        assert faults(http) == []
        assert 'id="faults"' not in http.get("/").text
