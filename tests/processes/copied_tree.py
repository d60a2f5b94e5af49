"""A copy of the product in which a test adds something, and a Python of its own that sees what came of it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
UNSEEN = shutil.ignore_patterns("test")


class CopiedTree:
    """A copy of `src` and `scripts`; `changed` has the files of the product that were touched."""

    def __init__(self, folder: Path) -> None:
        self._root = folder
        self._package = folder / "src/arboleda/arboleda"
        self.changed: set[str] = set()
        for each in ("src/arboleda", "src/arboleda_ros", "scripts"):
            shutil.copytree(ROOT / each, folder / each, ignore=UNSEEN)

    def insert(self, file: str, before: str, text: str) -> None:
        """Put text before the only place of the file that begins so."""
        path = self._package / file
        whole = path.read_text(encoding="utf-8")
        assert whole.count(before) == 1, f"{file} has {whole.count(before)} times {before!r}"
        self._write(path, whole.replace(before, text + before))

    def add(self, file: str, text: str) -> None:
        """Add a file."""
        path = self._package / file
        assert not path.exists()
        path.parent.mkdir(parents=True, exist_ok=True)
        self._write(path, text)

    def run(self, code: str) -> Any:
        """What the code, which sees the copy, prints as JSON."""
        folders = [self._root / "src/arboleda", self._root / "src/arboleda_ros"]
        environ = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, folders)), "COLUMNS": "200"}
        command = [sys.executable, "-c", code]
        done = subprocess.run(
            command, env=environ, cwd=self._root, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    def _write(self, path: Path, text: str) -> None:
        path.write_text(text, encoding="utf-8")
        self.changed.add(str(path.relative_to(self._package)))
