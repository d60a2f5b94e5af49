"""The firmware's board of a declared device as a program: in a plant, and with what goes wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from .test_linux_boards import Desk

pytestmark = pytest.mark.system

PRESS = Path(__file__).parents[2] / "examples/press_board/plant.yaml"


@pytest.fixture
def desk(device_board: str, mosquitto: Callable[[int], Any], free_port: int) -> Iterator[Desk]:
    mosquitto(free_port)
    made = Desk(device_board, free_port, name="press_1", words=("--name", "press_1"))
    yield made
    made.close()


def test_the_firmwares_board_sticks_remembers_nothing_after_a_reboot_does_a_task_and_says_no(
    arboleda: Callable[..., Any], desk: Desk, free_port: int
) -> None:
    before = desk.wait(lambda said: True)
    desk.send("orden", verbo="clamp", valores={"on": True})
    desk.wait(lambda said: said["datos"]["clamped"])
    desk.type("stick 1")
    desk.send("orden", verbo="open")
    said = desk.wait(lambda said: "fallos" in said)
    assert (said["fallos"], said["estado"], said["datos"]["gate"]) == ([[2, "plazo"]], 0, "closed")
    desk.type("reboot")
    after = desk.wait(lambda said: said["arranque"] != before["arranque"])
    assert "ack" not in after and after["estado"] == 0
    assert after["datos"]["clamped"] is True  # its switch is still closed: inputs are asked, not memory

    desk.type("stick 0")
    desk.send("orden", verbo="clamp", valores={"on": False})
    desk.wait(lambda said: not said["datos"]["clamped"])
    where = ("--plant", str(PRESS), "--broker", f"127.0.0.1:{free_port}", "--boards", "real", "--no-ros")
    desk.type("input part_in 1")
    good = arboleda("up", "--once", "bench stamp 2", *where)
    assert good.wait() == 0, good.output
    data = desk.wait(lambda said: True)["datos"]
    found = {name: data[name] for name in ("gate", "clamped", "program", "pressed")}
    assert found == {"gate": "open", "clamped": False, "program": 2, "pressed": False}
    desk.type("input part_in 0")
    empty = arboleda("up", "--once", "bench stamp 1", *where)
    assert empty.wait() == 1
    assert "there is no part" in " ".join(empty.output.split())
