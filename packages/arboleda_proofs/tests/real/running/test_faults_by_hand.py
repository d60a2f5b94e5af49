"""Faults by hand at the virtual devices of a real start: by command and on the page."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from tests.patience import PATIENCE_MS, PATIENCE_S
from tests.system.page import connected, operate, running, show, until

pytestmark = pytest.mark.system


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


@pytest.mark.requires("chromium", "playwright")
def test_a_fault_begins_shows_and_ends_by_command_and_in_the_drawer_of_the_page(
    browser: Any, plant: tuple[str, httpx.Client], typed: Callable[..., tuple[int, str]]
) -> None:
    address, http = plant
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

    page = browser.new_context().new_page()
    page.set_default_timeout(PATIENCE_MS)
    held: list[Any] = []  # the menu is open before the script of its drawer has come
    page.route("**/faults.js", lambda route: held.append(route))
    page.goto(f"{address}/?lang=es")
    connected(page)
    operate(page, "sis_a")
    page.click("#faults summary")
    held[0].continue_()
    page.wait_for_selector("#fault-target option[hidden]", state="attached")
    assert page.locator("#fault-target option:not([hidden])").all_text_contents() == ["ra1", "rm_sis_a"]
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
