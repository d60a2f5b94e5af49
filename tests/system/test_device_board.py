"""The firmware's board of a declared device as a program: in a plant, and with what goes wrong."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from ..patience import PATIENCE_S
from .test_linux_boards import Desk

pytestmark = pytest.mark.system

PRESS = Path(__file__).parents[2] / "examples/press_board/plant.yaml"


@pytest.fixture
def desk(device_board: str, mosquitto: Callable[[int], Any], free_port: int) -> Iterator[Desk]:
    mosquitto(free_port)
    made = Desk(device_board, free_port, name="press_1", words=("--name", "press_1"))
    yield made
    made.close()


def test_a_task_is_done_with_the_firmwares_board_and_fails_where_a_switch_says_no(
    arboleda: Callable[..., Any], desk: Desk, free_port: int
) -> None:
    where = ("--plant", str(PRESS), "--broker", f"127.0.0.1:{free_port}", "--boards", "real", "--no-ros")
    desk.wait(lambda said: True)
    desk.type("input part_in 1")
    good = arboleda("run", "bench stamp 2", *where)
    assert good.wait() == 0, good.output
    said = desk.wait(lambda said: True)
    assert said["datos"] == {
        **said["datos"],
        "gate": "open",
        "clamped": False,
        "program": 2,
        "pressed": False,
    }
    desk.type("input part_in 0")
    empty = arboleda("run", "bench stamp 1", *where)
    assert empty.wait() == 1
    assert "there is no part" in " ".join(empty.output.split())


def test_a_press_that_does_not_move_says_that_its_time_is_over(desk: Desk) -> None:
    desk.wait(lambda said: True)
    desk.type("stick 1")
    desk.send("orden", verbo="open")
    said = desk.wait(lambda said: "fallos" in said)
    assert (said["fallos"], said["estado"], said["datos"]["gate"]) == ([[1, "plazo"]], 0, "closed")


def test_a_reboot_is_another_boot_with_outputs_safe_and_nothing_remembered(desk: Desk) -> None:
    before = desk.wait(lambda said: True)
    desk.send("orden", verbo="clamp", valores={"on": True})
    desk.wait(lambda said: said["datos"]["clamped"])
    desk.type("reboot")
    after = desk.wait(lambda said: said["arranque"] != before["arranque"])
    assert "ack" not in after and after["estado"] == 0
    assert after["datos"]["clamped"] is True  # its switch is still closed: inputs are asked, not memory


def test_bad_options_are_one_sentence(device_board: str) -> None:
    run = subprocess.run(
        [device_board, "--name", "a b"], capture_output=True, text=True, timeout=PATIENCE_S, check=False
    )
    assert (run.returncode, run.stderr) == (
        2,
        "board: --name is 'a b'; allowed: 1 to 64 of A-Z a-z 0-9 _ -\n",
    )
