"""Two processes of one plant on one database: one leads, one stands by and takes over."""

from __future__ import annotations

import re
import socket
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.postgres import Server
from tests.system.two_hosts import PATIENCE_S, Hosts

from arboleda.runtime.state import find_running

pytestmark = pytest.mark.system

LED_HERE = f"plant arboleda is led on {socket.gethostname()}: "


def test_a_standby_takes_over_from_a_leader_that_is_killed_and_commands_follow(
    hosts: Hosts, arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    hosts.led_by_a()
    at_a, at_b = (("--state", str(tmp_path / name)) for name in "ab")
    stopped = arboleda("stop", "sis_b", *at_b)
    assert stopped.wait() == 0 and f"{LED_HERE}asked there" in stopped.output
    waiting = [arboleda("submit", "--wait", "sis_b 0B 1 #lot-2", *at) for at in (at_a, at_b)]
    for each in waiting:
        each.wait_for("queued: sis_b 0B 1 (id lot-2)")
    hosts.drives()

    hosts.plants["a"].kill()
    hosts.until(lambda: hosts.cell("b"))
    cancelled = arboleda("cancel", "lot-2", *at_a)  # nothing runs there, and its database knows who leads
    assert cancelled.wait() == 0 and f"{LED_HERE}asked there" in cancelled.output
    for each in waiting:
        assert each.wait() == 1 and "cancelled: sis_b 0B 1 (id lot-2)" in each.output
        assert "followed there" in each.output
    hosts.finish_with("b")


def test_a_leader_that_was_frozen_steps_down_and_moves_nothing(hosts: Hosts, tmp_path: Path) -> None:
    hosts.at_work()
    hosts.plants["a"].freeze(on=True)
    hosts.until(lambda: hosts.cell("b"))
    hosts.until(lambda: hosts.cell("b").get("state") == "held")
    told = len(hosts.boards.deeds)
    hosts.plants["a"].freeze(on=False)
    status, words = hosts.plants["a"].ended()
    assert status == 1 and "this one steps down" in words
    assert len(hosts.boards.deeds) == told
    hosts.finish_with("b")


def test_a_planned_handover_fails_no_task_and_needs_nobody_to_resume(
    hosts: Hosts, arboleda: Callable[..., Any], tmp_path: Path, page_ports: tuple[int, int]
) -> None:
    hosts.at_work(page_ports)
    waited_at = find_running(tmp_path / "b").url
    asked = arboleda("handover", "--state", str(tmp_path / "a"))
    assert asked.wait() == 0, asked.output
    hosts.until(lambda: hosts.cell("b"))
    assert find_running(tmp_path / "b").url == waited_at
    assert f"process {hosts.plants['b'].pid} on" in asked.output
    gap_s = float(re.search(r"for ([\d.]+) s of them nobody did", asked.output)[1])
    assert gap_s < PATIENCE_S
    assert hosts.plants["a"].ended()[0] == 0
    hosts.done_with("b")
    alone = arboleda("handover", "--state", str(tmp_path / "b"))
    assert alone.wait() == 1 and "start `arboleda up --standby` on another host" in alone.output


def test_a_standby_waits_for_a_database_that_is_away(
    hosts: Hosts, postgres: Server, arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    hosts.at_work()
    postgres.stop()
    try:
        hosts.until(lambda: "waits for the database" in hosts.ask("b").get("sentence", ""))
        assert hosts.plants["a"].ended()[0] == 1
    finally:
        postgres.start()
    # its robots were stopped by commands that nobody could keep: where it stands is for a person to say
    hosts.until(
        lambda: hosts.cell("b").get("state") == "held" and "abandon" not in hosts.cell("b")["refused"]
    )
    plant = hosts.plants["b"]
    assert plant.await_api(time.time() + PATIENCE_S)
    assert plant.ask("POST", "/api/cells/sis_a/abandon")[0] == 200
    hosts.until(lambda: [row["state"] for row in plant.ask("GET", "/api/history")[1]] == ["failed"])
    assert not hosts.parts()
