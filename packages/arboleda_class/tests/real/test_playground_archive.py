"""The archive of the playground has all Python that a tab of a browser runs."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from importlib.metadata import distribution
from pathlib import Path
from typing import Any

import pytest
from tests.scripts import load

IN_A_TAB = """
import sys
sys.path.insert(0, sys.argv[1])
from arboleda_class.playground.tab import hear
for line in sys.stdin:
    print(hear(line))
"""
pytestmark = pytest.mark.smoke
PLANT = {"plant": None, "languages": ["en"], "seed": 0, "level": "none"}


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files of the archive in a folder, with the core of pydantic that is built for this machine."""
    folder = tmp_path_factory.mktemp("archive")
    core = distribution("pydantic-core")
    of_core = [(Path(str(core.locate_file(each))), each.as_posix()) for each in core.files or ()]
    for file, name in (*load("playground").python_files(), *of_core):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, folder / name)
    return folder


def answers(archive: Path, *requests: dict[str, Any]) -> list[dict[str, Any]]:
    """The answers of a tab whose Python has nothing but the archive and the standard library."""
    python = [sys.executable, "-I", "-S", "-c", IN_A_TAB, str(archive)]
    lines = "".join(f"{json.dumps(each)}\n" for each in requests)
    done = subprocess.run(python, input=lines, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_a_tab_runs_a_plant_and_the_program_of_a_lesson_and_judges_an_exercise(archive: Path) -> None:
    books = load("workbooks.py")
    (lesson,) = [each for each in books.lessons() if each["name"] == "02_first_tree"]
    (exercise,) = [each for each in books.exercises() if each["name"] == "retry"]
    program = {key: lesson[key] for key in ("files", "program", "arguments")}
    opened, advanced, befallen, printed, verdict = answers(
        archive,
        {"do": "open", **PLANT},
        {"do": "advance", "ticks": 32},
        {"do": "befall", "name": "reboot", "target": "ra_1", "seconds": 1},
        {"do": "program", "typed": "", "language": "es", **program},
        {"do": "judge", "exercise": "retry", "files": exercise["files"], "language": "es"},
    )
    assert 'id="twin"' in opened["html"]
    assert advanced["frame"]["clock"]["tick"] == 32
    assert befallen["frame"]["clock"]["marks"] == [[32, "0:02 ra1: Reboot its board"]]
    assert "recorrer el camino: nodo" in printed["output"] and printed["problem"] is None
    assert verdict["findings"] and verdict["film"]
