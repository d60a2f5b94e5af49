"""Pages that are open while a plant goes from one host to the other, in a real browser."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda.app.state import find_running

from .page import PATIENCE_MS
from .two_hosts import Hosts

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]


def test_a_page_that_is_open_at_the_standby_becomes_that_of_the_plant(
    hosts: Hosts, browser: Any, arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    hosts.led_by_a()
    context = browser.new_context(locale="es")
    waiting = context.new_page()
    waiting.set_default_timeout(PATIENCE_MS)
    waiting.goto(find_running(tmp_path / "b").url)
    assert "en reserva" in waiting.inner_text("main")
    assert waiting.get_attribute("a", "href") == find_running(tmp_path / "a").url
    assert arboleda("handover", "--state", str(tmp_path / "a")).wait() == 0
    waiting.wait_for_function("document.getElementById('connection')?.hidden")
    assert waiting.inner_text("h1") == "arboleda"
    context.close()
