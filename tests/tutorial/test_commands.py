"""What a person types in the tutorial is run as it stands there, and must print what stands below it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from PIL import Image

from ..patience import PATIENCE_S

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "tutorial"
CONSOLE = re.compile(r"^```console\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LEFT_OUT = "..."
REAL = (
    "07_ros2_cell",
    "09_mqtt_board",
    "10_plant",
    "14_break_it",
    "15_read_a_record",
)  # real time, sockets, processes


def commands(page: Path) -> Iterator[tuple[str, list[str]]]:
    """Each command of a page with the lines that it prints; LEFT_OUT stands for any lines, or any words."""
    for box in CONSOLE.findall(page.read_text("utf-8")):
        for part in re.split(r"^\$ ", box, flags=re.MULTILINE)[1:]:
            command, *expected = part.splitlines()
            yield command, expected


def cases() -> Iterator[pytest.param]:
    for page in sorted(FOLDER.glob("[0-9]*[a-z].md")):
        if page.name.endswith(".es.md"):
            continue
        marks = [pytest.mark.system] if page.stem in REAL else []
        marks += [pytest.mark.requires("rclpy")] if page.stem == "07_ros2_cell" else []
        for number, (command, expected) in enumerate(commands(page), start=1):
            yield pytest.param(command, expected, id=f"{page.stem}-{number}", marks=marks)


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder that looks like one of Arboleda after `make install`, and keeps what commands write."""
    folder = tmp_path / "checkout"
    programs = folder / ".venv" / "bin"
    programs.mkdir(parents=True)
    (folder / "examples").symlink_to(ROOT / "examples")
    write_program(programs / "python", "")
    write_program(programs / "arboleda", ' -c "from arboleda.cli.main import main; main()"')
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(path for path in sys.path if path))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("COLUMNS", "200")
    return folder


def write_program(file: Path, words: str) -> None:
    file.write_text(f'#!/bin/sh\nexec "{sys.executable}"{words} "$@"\n')
    file.chmod(0o755)


def type_in(command: str, folder: Path) -> list[str]:
    """What a command prints, on both channels, without empty lines."""
    ran = subprocess.run(
        command,
        shell=True,
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    return [line.rstrip() for line in ran.stdout.splitlines() if line.strip()]


def pattern(expected: list[str]) -> str:
    """A regular expression for the output of a page."""
    lines = [line.rstrip() for line in expected if line.strip()]
    parts = [
        r"(?:.*\n)*?" if line == LEFT_OUT else re.escape(line).replace(re.escape(LEFT_OUT), ".*") + r"\n"
        for line in lines
    ]
    return "".join(parts)


@pytest.mark.parametrize(("command", "expected"), list(cases()))
def test_a_command_prints_what_the_page_says(
    command: str, expected: list[str], checkout: Path, ros_domain: int
) -> None:
    printed = type_in(command, checkout)
    assert not any("Traceback" in line for line in printed), "\n".join(printed)
    assert re.fullmatch(pattern(expected), "".join(f"{line}\n" for line in printed)), "\n".join(printed)


@pytest.mark.parametrize("picture", ["first_tree", "storage"])
def test_the_pictures_of_the_page_are_there(picture: str, checkout: Path) -> None:
    for command, _ in commands(FOLDER / "02_first_tree.md"):
        if picture in command:
            type_in(command, checkout)
    assert (checkout / f"{picture}.svg").read_text().startswith("<svg")
    with Image.open(checkout / f"{picture}.png") as image:
        assert min(image.size) > 200


def test_left_out_lines_may_be_any_and_others_may_not() -> None:
    page = ["one", LEFT_OUT, "port 127.0.0.1:...", "two"]
    assert re.fullmatch(pattern(page), "one\nsomething\nelse\nport 127.0.0.1:1883\ntwo\n")
    assert re.fullmatch(pattern(page), "one\nport 127.0.0.1:1\ntwo\n")
    assert not re.fullmatch(pattern(page), "one\nport 127.0.0.1:1\ntwo\nthree\n")
    assert not re.fullmatch(pattern(page), "port 127.0.0.1:1\ntwo\n")
