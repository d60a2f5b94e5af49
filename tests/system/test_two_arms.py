"""docs/how-to/two-arms.md: its commands do what the page says, where a person types them."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.system

PAGE = (Path(__file__).parents[2] / "docs/how-to/two-arms.md").read_text("utf-8")
BROKER = "192.168.1.10:1883"
# test_scara_pair.py of arboleda_proofs and tests/real of arboleda_boards have these
ELSEWHERE = ("python", "arboleda conformance")
PICKUPS = {"ra_1": "45,10,0", "ra_2": "35,10,0"}


def commands() -> list[list[str]]:
    """What a person types, in the order of the page."""
    boxes = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    typed = "".join(text for language, text in boxes if not language)
    lines = [line for line in typed.splitlines() if not line.startswith(ELSEWHERE)]
    return [shlex.split(line)[1:] for line in lines]


TYPED = commands()
REAL = next(number for number, words in enumerate(TYPED) if BROKER in words)


@pytest.fixture
def type_in(
    arboleda: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., Any]:
    """`type_in(["check", "my_plant/plant.yaml"])`: the command in a folder of one's own, to its end."""
    monkeypatch.chdir(tmp_path)

    def go(words: list[str]) -> Any:
        process = arboleda(*words)
        assert process.wait() == 0, process.output
        return process

    return go


def test_tasks_are_done_on_virtual_boards(arboleda: Callable[..., Any], type_in: Callable[..., Any]) -> None:
    (new, check, up, *operating) = TYPED[:REAL]
    type_in(new)
    assert "good: plant scara_pair; cells sis_a, sis_b" in type_in(check).output
    plant = arboleda(*up, "--no-ros")
    plant.wait_for("done      sis_a 0B 7")
    plant.wait_for("done      sis_b fetch 1C 4")
    assert [words[0] for words in operating] == ["submit", "stop", "clear", "reset", "resume"]
    for words in operating:
        type_in(words)
    plant.wait_for("done      sis_a palletizing")
    assert plant.interrupt() == 0


def test_the_arms_do_a_task_with_the_firmwares_boards_and_no_mobile_robot(
    arboleda: Callable[..., Any],
    type_in: Callable[..., Any],
    start: Callable[..., Any],
    mosquitto: Callable[[int], Any],
    board: str,
    free_port: int,
    tmp_path: Path,
) -> None:
    address = f"127.0.0.1:{free_port}"
    mosquitto(free_port)
    for name, place in PICKUPS.items():
        start(board, "--robot", name, "--broker", address, "--place", place)
    type_in(TYPED[0])
    plant_file = tmp_path / "my_plant/plant.yaml"
    drawn = re.sub(r"(mobile: .*)link: mqtt", r"\1link: none", plant_file.read_text("utf-8"))
    plant_file.write_text(drawn, "utf-8")
    up, home, submit, status = TYPED[REAL:]
    plant = arboleda(*(address if word == BROKER else word for word in up), "--no-ros")
    plant.wait_for("Page: ")
    for words in (home, submit):
        type_in(words)
    plant.wait_for("done      sis_a palletizing")
    assert "rm_sis_a is only drawn (link: none)" in type_in(status).output
