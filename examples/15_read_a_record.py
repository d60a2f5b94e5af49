"""Lesson 15: a task fails in a plant that runs; its record says why, and becomes a test."""

from __future__ import annotations

import re
import subprocess
import time
from html import unescape
from pathlib import Path
from tempfile import TemporaryDirectory

from real_start import ARBOLEDA, running

from arboleda_class.lessons import spoken

LOOK_S = 0.02
TEST = re.compile(r"(def test_.*?)</pre>", re.DOTALL)


def fail(state: Path) -> None:
    """Run a plant until its oven has jammed in a task, and end it."""
    with running("workshop.yaml", state, rate=2) as plant:  # the oven bakes for 2 s
        task = plant.submit("bench bake shelf_1 4 #lot7")
        while plant.snapshot().cells[0].step != "oven bake 4":
            time.sleep(LOOK_S)
        plant.provoke("jam", "oven", 60.0)
        ended = plant.wait(task.id)
        print(f"#lot7 {ended.state}: {ended.sentence}")


def main() -> None:
    with TemporaryDirectory() as folder:
        fail(Path(folder))
        page = Path(folder) / "lot7.html"
        print("arboleda report lot7")
        command = ("report", "lot7", "--state", folder, "--output", str(page))
        told = subprocess.run([*ARBOLEDA, *command], stdout=subprocess.PIPE, text=True, check=True).stdout
        print(f"  {told.splitlines()[0]}")
        found = TEST.search(page.read_text("utf-8"))
        print("the test at its end:")
        print(unescape(found[1]).rstrip() if found else "none")


if __name__ == "__main__":
    spoken(main)
