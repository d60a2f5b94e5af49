"""Errands about a draft, each in a process of its own: how far it is, what came of it, and its end."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import threading
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.recipe_trial import PATH

START = PATH + "from arboleda_make.trying.processes import {module}; {module}.main()"
ENDING = "nothing is begun any more: the plant ends"
NO_RESULT = "it ended without a result; try again, or run `arboleda {command}` on the plant file"


@dataclass(frozen=True, kw_only=True)
class Work:
    """Work that is done in a process: its `module`, and the command that does the same in a terminal."""

    module: str
    command: str


class ErrandRun:
    """ErrandRun: one piece of work at a time, the last one counts; `folder` gets its results."""

    def __init__(self, work: Work, folder: Path) -> None:
        self._work = work
        self.folder = folder
        self._turns = threading.Lock()
        self._ended = False
        self._run: subprocess.Popen[str] | None = None
        self._state: dict[str, Any] = {"state": "idle"}

    def state(self) -> dict[str, Any]:
        """`state`: idle, running, done, failed or stopped; how far it is, and the sentence why it failed."""
        with self._turns:
            return dict(self._state)

    def begin(self, files: PlantFiles, plant_file: Path, wanted: Mapping[str, Any]) -> None:
        """Begin anew, with these files as those beside `plant_file`; ArboledaError after `end`."""
        request = {
            "plant": files.plant,
            "plant_file": str(plant_file.absolute()),
            "files": {name: each.decode("utf-8", "surrogateescape") for name, each in files.contents.items()},
            "folder": str(self.folder.absolute()),
            "wanted": dict(wanted),
        }
        command = [sys.executable, "-I", "-c", START.format(module=self._work.module), json.dumps(sys.path)]
        pipe = subprocess.PIPE
        with self._turns:
            if self._ended:
                raise ArboledaError(ENDING)
            self._kill()
            shutil.rmtree(self.folder, ignore_errors=True)
            self.folder.mkdir(parents=True)
            run = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, text=True)
            self._run, self._state = run, {"state": "running"}
        threading.Thread(target=self._follow, args=(run, json.dumps(request)), daemon=True).start()

    def stop(self) -> None:
        """End what is under way; idempotent."""
        with self._turns:
            self._kill()

    def end(self) -> None:
        """End what is under way, and begin nothing any more; idempotent."""
        with self._turns:
            self._ended = True
            self._kill()

    def _kill(self) -> None:
        run, self._run = self._run, None
        if self._state["state"] == "running":
            self._state = {"state": "stopped"}
        if run is not None:
            run.kill()

    def _follow(self, run: subprocess.Popen[str], request: str) -> None:
        """Hear the process until it has ended."""
        assert run.stdin is not None and run.stdout is not None
        try:
            with run.stdin as pipe:
                pipe.write(request)
            for line in run.stdout:
                self._hear(run, json.loads(line))
        except (OSError, ValueError):
            run.kill()
        run.wait()
        run.stdout.close()
        with self._turns:
            if self._run is run and self._state["state"] == "running":
                sentence = NO_RESULT.format(command=self._work.command)
                self._state = {"state": "failed", "sentence": sentence}

    def _hear(self, run: subprocess.Popen[str], what: dict[str, Any]) -> None:
        with self._turns:
            if self._run is not run:
                return
            if "failed" in what:
                self._state = {"state": "failed", "sentence": what["failed"]}
            elif "ended" in what:
                self._state = {"state": "done"}
            else:
                self._state = {"state": "running", **what}
