"""What a person types in the tutorial prints what stands below it, where it needs a shell or a real clock."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from PIL import Image

from ..patience import PATIENCE_S
from ..tutorial_pages import REAL, ROOT, commands, differs, is_plain, pages

REAL_CLOCK = (*REAL, "10_plant")  # in Spanish these are compared with their English pages only


def cases() -> Iterator[pytest.param]:
    """The commands of a page that are left, in their order."""
    for page in (
        *pages(),
        *(each for each in pages("es") if each.stem.removesuffix(".es") not in REAL_CLOCK),
    ):
        left = [each for each in commands(page) if not is_plain(page, each[0])]
        if left:
            marks = [pytest.mark.system] if page.stem in REAL_CLOCK else []
            marks += [pytest.mark.requires("rclpy")] if page.stem == "07_ros2_cell" else []
            yield pytest.param(left, id=page.stem, marks=marks)


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


def type_in(command: str, folder: Path) -> str:
    """What a command prints, on both channels."""
    return subprocess.run(
        command,
        shell=True,
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    ).stdout


@pytest.mark.parametrize("typed", list(cases()))
def test_the_commands_of_a_page_print_what_it_says(
    typed: list[tuple[str, list[str]]],
    checkout: Path,
    ros_domain: int,
    monkeypatch: pytest.MonkeyPatch,
    request: pytest.FixtureRequest,
) -> None:
    monkeypatch.setenv("ARBOLEDA_LANG", "es" if request.node.callspec.id.endswith(".es") else "en")
    for command, expected in typed:
        assert not (printed := differs(expected, type_in(command, checkout))), f"$ {command}\n{printed}"
    for picture in checkout.glob("*.svg"):
        assert picture.read_text().lstrip().startswith("<svg"), picture.name
    for picture in checkout.glob("*.png"):
        with Image.open(picture) as image:
            assert min(image.size) > 200, picture.name
