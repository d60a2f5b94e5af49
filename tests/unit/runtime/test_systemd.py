"""What systemd is told of a plant that it started."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from arboleda.adapters import clock
from arboleda.runtime.parts.systemd import systemd_part

from .notified import asked
from .notified import heard as heard


def test_without_a_watchdog_nothing_is_said_between_beginning_and_end(heard: socket.socket) -> None:
    part = systemd_part(asked(heard), lambda: pytest.fail("nobody wants to know"))
    assert part
    part.start()
    part.stop()
    assert [heard.recv(100), heard.recv(100)] == [b"READY=1", b"STOPPING=1"]


def test_the_watchdog_of_another_process_is_none_of_ours(heard: socket.socket) -> None:
    part = systemd_part(asked(heard, WATCHDOG_USEC="30000", WATCHDOG_PID="1"), clock.seconds)
    assert part
    part.start()
    part.stop()
    assert [heard.recv(100), heard.recv(100)] == [b"READY=1", b"STOPPING=1"]


@pytest.mark.parametrize("environment", [{}, {"NOTIFY_SOCKET": ""}, {"NOTIFY_SOCKET": "vsock:2:3"}])
def test_where_systemd_did_not_start_it_there_is_no_such_part(environment: dict[str, str]) -> None:
    assert systemd_part(environment, clock.seconds) is None


def test_children_of_the_plant_cannot_speak_for_it(heard: socket.socket) -> None:
    environment = asked(heard, WATCHDOG_USEC="30000", WATCHDOG_PID="1", HOME="/")
    systemd_part(environment, clock.seconds)
    assert environment == {"HOME": "/"}


def test_a_plant_starts_though_nobody_hears_it(tmp_path: Path) -> None:
    part = systemd_part({"NOTIFY_SOCKET": str(tmp_path / "nobody")}, clock.seconds)
    assert part
    part.start()
    part.stop()
