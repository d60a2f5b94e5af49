"""`arboleda.client` and plants that really run: an example, a restart in the middle, two hosts."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from arboleda.client import Plant

from .conftest import ROOT, paths
from .test_walk_back import Site
from .two_hosts import PATIENCE_S, Hosts

pytestmark = pytest.mark.system
PROPOSAL = ROOT / "examples/client/proposal_to_task.py"
PROPOSES = "\nassistants: submit\nassistant_limits: {cells: [cell]}\n"
EXAMPLE = ROOT / "examples/client/task_to_report.py"


class Waiting:
    """Client in a thread that waits for a task, and notes each of its states."""

    def __init__(self, task: str, *addresses: str) -> None:
        self.states: list[str] = []
        self._plant = Plant(*addresses, patience_s=PATIENCE_S)
        self._thread = threading.Thread(target=self._follow, args=(task,))
        self._thread.start()

    def _follow(self, task: str) -> None:
        self.states += [each.state for each in self._plant.follow(task)]
        self._plant.close()

    def ended(self) -> list[str]:
        self._thread.join(PATIENCE_S)
        return self.states


@pytest.fixture
def site(tmp_path: Path, free_port: int) -> Iterator[Site]:
    made = Site(tmp_path, "--port", str(free_port))
    yield made
    made.end()


@pytest.mark.smoke
def test_the_example_shows_a_task_from_its_submission_to_its_report(
    arboleda: Callable[..., Any], start: Callable[..., Any], free_port: int
) -> None:
    up = arboleda("up", "--no-ros", "--rate", "10", "--port", str(free_port))
    up.wait_for("HTTP API")
    url = f"http://127.0.0.1:{free_port}"
    ran = start(sys.executable, str(EXAMPLE), env={"PYTHONPATH": paths(), "PLANT": url})
    assert ran.wait() == 0, ran.output
    shown = ran.output
    assert "refused: '99' is not a station of sis_a" in shown
    states = [line.split()[1] for line in ran.lines if line.startswith("c-")]
    assert states[-1] == "failed" and "done" in states
    assert "cause: operator: an operator ended it: stop sis_a" in shown
    assert "advice: clear sis_a" in shown
    assert up.interrupt() == 0, up.output


def test_a_proposal_is_written_tried_approved_and_its_task_done(
    arboleda: Callable[..., Any], start: Callable[..., Any], free_port: int, tmp_path: Path
) -> None:
    program = "from arboleda.cli.main import main; main()"
    new = start(sys.executable, "-c", program, "new", str(tmp_path / "presses"), env={"PYTHONPATH": paths()})
    assert new.wait() == 0, new.output
    file = tmp_path / "presses" / "plant.yaml"
    file.write_text(file.read_text("utf-8") + PROPOSES, "utf-8")
    up = arboleda("up", "--no-ros", "--plant", str(file), "--port", str(free_port))
    up.wait_for("HTTP API")
    address = {"PLANT": f"http://127.0.0.1:{free_port}", "PYTHONPATH": paths()}
    ran = start(sys.executable, str(PROPOSAL), env=address)
    assert ran.wait() == 0, ran.output
    shown = ran.output
    assert "kept: None - problems: " in shown and "refused: the task has 2 words" in shown
    assert "+      <press_close/>" in shown and "simulated: held" in shown
    assert "approved by Ana - version 2" in shown and "the recipe was approved by Ana" in shown
    assert up.interrupt() == 0, up.output


def test_who_waits_for_a_task_goes_on_after_the_plant_was_killed(site: Site, free_port: int) -> None:
    site.until(lambda cell: cell["not_ready"] is None)
    address = f"http://127.0.0.1:{free_port}"
    with Plant(address, patience_s=PATIENCE_S) as plant:
        assert plant.submit("sis_a 0B 7 #lot-1").id == "lot-1"
        waiting = Waiting("lot-1", address)
        site.until(lambda cell: cell["step"] == "drive path 0B")
        site.kill()
        site.until(lambda cell: cell["state"] == "held" and "resume" not in cell["refused"])
        assert plant.submit("sis_a 0B 7 #lot-1").state == "running"
        plant.operate("resume", "sis_a")
        assert waiting.ended()[-1] == "done"
        assert [row.state for row in plant.history(words="lot-1")] == ["done"]


def test_who_waits_for_a_task_follows_the_next_leader(hosts: Hosts, page_ports: tuple[int, int]) -> None:
    hosts.led_by_a(page_ports)
    at_a, at_b = (f"http://127.0.0.1:{port}" for port in page_ports)
    with Plant(at_b, patience_s=PATIENCE_S) as plant:  # which stands by, and names the leader
        assert plant.submit("sis_a 0B 7 #lot-1").state in ("queued", "running")
        waiting = Waiting("lot-1", at_a, at_b)
        hosts.until(lambda: hosts.cell("a").get("step") == "drive path 0B")
        hosts.plants["a"].kill()
        hosts.until(
            lambda: hosts.cell("b").get("state") == "held" and "resume" not in hosts.cell("b")["refused"]
        )
        plant.operate("resume", "sis_a")
        assert waiting.ended()[-1] == "done"
    hosts.done_with("b")
