"""A plant that speaks TLS everywhere."""

from __future__ import annotations

import ssl
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest

from ..patience import PATIENCE_S
from ..tls_lab import Lab

pytestmark = pytest.mark.system
Typed = Callable[..., tuple[int, str]]


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    return Lab(tmp_path / "lab")


@pytest.fixture
def shown(lab: Lab) -> tuple[str, ...]:
    certificate, key = lab.sign("localhost")
    return "--tls-cert", str(certificate), "--tls-key", str(key)


@pytest.mark.smoke
def test_page_boards_and_commands_speak_tls(
    arboleda: Callable[..., Any],
    typed: Typed,
    lab: Lab,
    shown: tuple[str, ...],
    free_port: int,
    browser: Any,
    require: Callable[[str], str],
    tmp_path: Path,
) -> None:
    users = tmp_path / "users.txt"
    users.write_text("ra_9:secret\n")
    broker = (
        "--broker-host",
        "127.0.0.1",
        "--broker-users",
        str(users),
        "--broker-tls",
        "--boards",
        "virtual",
    )
    web = ("--host", "0.0.0.0", "--port", str(free_port))
    up = arboleda("up", "--no-ros", "--rate", "10", *broker, *web, *shown)
    up.wait_for("Page: https://")
    up.wait_for("MQTT broker: mqtts://127.0.0.1:8883")
    assert "travels in clear" not in up.output
    assert typed("submit", "--wait", "sis_a 0B 7")[0] == 0
    token = typed("token", "operator")[1]
    believing = ssl.create_default_context(cafile=lab.certificate)
    asks = {"verify": believing, "trust_env": False, "headers": {"authorization": f"Bearer {token}"}}
    assert (
        httpx.get(f"https://localhost:{free_port}/api/plant", timeout=PATIENCE_S, **asks).status_code == 200
    )
    page = browser.new_page(ignore_https_errors=True)
    try:
        page.goto(f"https://127.0.0.1:{free_port}/?lang=en")
        page.fill("input[name=token]", token)
        page.click("button")
        page.wait_for_selector("text=sis_a >> visible=true", timeout=1000 * PATIENCE_S)
        cookie = next(each for each in page.context.cookies() if each["name"].startswith("arboleda_"))
        assert cookie["secure"]
        assert typed("submit", "sis_b 0B 7 #over_tls")[0] == 0
        row = '[data-rows=tasks] [data-row="over_tls"]'  # the websocket brings it
        page.wait_for_selector(row, state="attached", timeout=1000 * PATIENCE_S)
    finally:
        page.close()
    assert up.interrupt() == 0, up.output
    assert "Traceback" not in up.output
