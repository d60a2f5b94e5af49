"""Check of a draft in a process of its own, which takes neither time nor memory from a plant that runs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.host.limits import give_way
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.draft import DraftCheck, Shade, Unstated
from arboleda.plant_file.recipe_trial import PATH

START = PATH + "from arboleda_make.drafts import process; process.main()"
AT_MOST_S = 300.0
IN_LINE = 4  # checks that may wait: each keeps a thread of the server
KINDNESS = 10  # that of `nice`: whatever the plant does comes first
NO_ANSWER = "the draft could not be checked, its check gave no answer; `arboleda check` says more"
BUSY = "too many checks of the draft are waiting; try again in some seconds"
ENDING = "the draft is not checked any more: the plant ends"


class CheckProcess:
    """Check process: one check at a time, for any thread; others wait in line. `stop` ends it."""

    def __init__(self) -> None:
        self._turns = threading.Condition()
        self._run: subprocess.Popen[bytes] | None = None
        self._waiting = 0
        self._ended = False

    def check(self, files: PlantFiles, plant_file: Path) -> DraftCheck:
        """The same as `draft_check.check`, without the plant, and files are named as in the draft. It waits;
        ArboledaError if no answer comes.
        """
        request = {"plant_file": str(plant_file), "plant": files.plant, "contents": texts(files.contents)}
        run = self._start()
        try:
            output, _ = run.communicate(json.dumps(request).encode(), AT_MOST_S)
        except (OSError, subprocess.TimeoutExpired):
            output = b""
        finally:
            run.kill()
            run.communicate()
            with self._turns:
                self._run = None
                self._turns.notify()
        return _answer(output, files.plant)

    def stop(self) -> None:
        """End the check that is under way, and begin no other; idempotent."""
        with self._turns:
            self._ended = True
            if self._run is not None:
                self._run.kill()
            self._turns.notify_all()

    def _start(self) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-I", "-c", START, json.dumps(sys.path)]
        with self._turns:
            if self._run is not None and self._waiting < IN_LINE:
                self._waiting += 1
                self._turns.wait_for(lambda: self._ended or self._run is None, AT_MOST_S)
                self._waiting -= 1
            if self._ended or self._run is not None:
                raise ArboledaError(ENDING if self._ended else BUSY)
            pipe = subprocess.PIPE
            self._run = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL)
            return self._run


def main() -> None:
    """Run as the other process: read the request, answer on the last line, end."""
    from arboleda.plant_check import draft_check  # which the plant's own process does not need

    give_way(KINDNESS)
    request = json.load(sys.stdin)
    files = PlantFiles(plant=request["plant"], contents=from_texts(request["contents"]))
    found = draft_check.check(files, Path(request["plant_file"]), Shade.shortened)
    read = None if found.read is None else texts(found.read.contents)
    lacks = [asdict(each) for each in found.unstated]
    answer = {"problems": found.problems, "warnings": found.warnings, "unstated": lacks, "read": read}
    print(f"\n{json.dumps(answer)}", flush=True)
    os._exit(0)  # whatever threads the plant's Python has started


def _answer(output: bytes, plant: str) -> DraftCheck:
    """The verdict on the last line of the process's output; ArboledaError if there is none."""
    try:
        found: dict[str, Any] = json.loads(output.splitlines()[-1])
        read = found["read"]
        return DraftCheck(
            problems=tuple(found["problems"]),
            warnings=tuple(found["warnings"]),
            unstated=tuple(map(_lack, found["unstated"])),
            read=None if read is None else PlantFiles(plant=plant, contents=from_texts(read)),
        )
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise ArboledaError(NO_ANSWER) from error


def _lack(found: Mapping[str, Any]) -> Unstated:
    return Unstated(unknown=found["unknown"], place=tuple(found["place"]), values=tuple(found["values"]))


def texts(contents: Mapping[str, bytes]) -> dict[str, str]:
    return {name: each.decode("utf-8", "surrogateescape") for name, each in contents.items()}


def from_texts(texts: Mapping[str, str]) -> dict[str, bytes]:
    return {name: each.encode("utf-8", "surrogateescape") for name, each in texts.items()}
