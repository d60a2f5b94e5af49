"""A plant is reached where it was started: by the commands, and at the address that it prints."""

from __future__ import annotations

import re
import socket
from collections.abc import Callable
from typing import Any

import httpx
import pytest

from ..patience import PATIENCE_S

pytestmark = pytest.mark.system
Typed = Callable[..., tuple[int, str]]


def test_commands_and_browsers_reach_a_plant_at_any_address_of_this_machine(
    arboleda: Callable[..., Any], typed: Typed, free_port: int
) -> None:
    with socket.create_server(("127.0.0.1", free_port)):  # somebody else, who must not be taken for the plant
        up = arboleda("up", "--no-ros", "--host", "::1", "--port", str(free_port))
        up.wait_for("HTTP API")
        assert shown_page(up) == f"http://[::1]:{free_port}"
        check_reached(typed, up)


def check_reached(typed: Typed, up: Any) -> None:
    browser = httpx.Client(headers={"accept": "text/html"}, trust_env=False, timeout=PATIENCE_S)
    with browser:
        assert browser.get(shown_page(up), follow_redirects=True).status_code == 200
    for words in (["status"], ["submit", "sis_a 0B 7"], ["stop"]):
        status, said = typed(*words)
        assert status == 0, said
    up.wait_for("failed    sis_a 0B 7")
    assert up.interrupt() == 0, up.output


def shown_page(up: Any) -> str:
    found = re.search(r"Page: (\S+)", up.output)
    assert found, up.output
    return found[1]
