"""Pages that are open while a plant goes from one host to the other, in a real browser."""

from __future__ import annotations

import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.chromium import leave
from tests.patience import PATIENCE_MS
from tests.system.two_hosts import Hosts

from arboleda.runtime.state import find_running

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]


def test_a_page_at_the_standby_becomes_the_plants_and_one_at_the_old_leader_leads_there(
    hosts: Hosts, browser: Any, arboleda: Callable[..., Any], tmp_path: Path, page_ports: tuple[int, int]
) -> None:
    hosts.led_by_a(page_ports)
    at_a, at_b = (find_running(tmp_path / name).url for name in "ab")
    context = browser.new_context(locale="es")
    left, waiting = context.new_page(), context.new_page()
    for page, url in ((left, at_a), (waiting, at_b)):
        page.set_default_timeout(PATIENCE_MS)
        page.goto(f"{url}/?tab=links")
    assert "en reserva" in waiting.inner_text("main")
    assert waiting.get_attribute("a", "href") == at_a
    host = socket.gethostname()
    left.wait_for_function(f"document.getElementById('part-links')?.innerText.includes('En reserva: {host}')")

    assert arboleda("handover", "--state", str(tmp_path / "a")).wait() == 0
    waiting.wait_for_function("document.getElementById('connection')?.hidden")
    assert waiting.inner_text("h1") == "arboleda" and waiting.url.startswith(f"{at_b}/?tab=links")
    left.click("#standbys a")
    left.wait_for_function("document.getElementById('connection')?.hidden")
    assert left.url.startswith(f"{at_b}/?tab=links")
    leave(context)
