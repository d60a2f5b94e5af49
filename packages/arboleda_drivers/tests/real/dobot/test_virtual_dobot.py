"""The shipped plant with its CR10A behind the driver `dobot`, as it is typed, against the virtual one."""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

from ..played import play

pytestmark = pytest.mark.system

LINK = "      twin: r3\n      link: mqtt\n"


def shipped(folder: Path, line: str) -> str:
    """The shipped plant file with that line in the place of ra3's link."""
    text = (files("arboleda") / "plants/plant.yaml").read_text("utf-8")
    assert LINK in text
    (folder / "plant.yaml").write_text(text.replace(LINK, f"      twin: r3\n      {line}\n"), "utf-8")
    return str(folder / "plant.yaml")


@pytest.mark.smoke
def test_a_part_is_stored_by_a_dobot_and_a_collision_fails_the_next(
    start: Callable[..., Any], arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    played = play(start, "dobot", "--enabled", "--port", "0", "--feedback-port", "0")
    port, feedback = played.found(r"dashboard (\d+), feedback (\d+)")
    line = f"driver: {{dobot: {{host: 127.0.0.1, port: {port}, feedback_port: {feedback}}}}}"
    up = arboleda("up", "sis_c 0B 7", "--plant", shipped(tmp_path, line), "--boards", "drivers", "--no-ros")
    up.wait_for("done      sis_c 0B 7")
    played.switch("collision", on=True)
    arboleda("submit", "sis_c palletizing").wait()
    up.wait_for("ra3: gave up (collision) while")
    played.switch("collision", on=False)
    assert up.interrupt() == 0, up.output
    assert played.process.interrupt() == 0 and "Traceback" not in up.output + played.process.output
