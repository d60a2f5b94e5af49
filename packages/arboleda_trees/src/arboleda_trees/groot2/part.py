"""Groot2 part: shows the cells' trees to Groot2, from a process of its own that gets snapshots."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

from arboleda.extension import StartError
from arboleda.model.messages import TaskState
from arboleda.runtime.parts.viewer_process import Snapshot, ViewerProcess
from arboleda.web.access.names import LOCAL, is_loopback

START_S = 20.0
LIBRARIES = ("msgpack", "zmq")
MISSING = "pyzmq and msgpack are not installed, which it needs: pip install 'arboleda[groot2]'"
OF_TASK = ("id", "text", "state", "answers")


@dataclass(frozen=True, kw_only=True)
class Groot2Options:
    """The address for Groot2; `port` is that of the first cell, None for 1667 or any free one."""

    host: str = LOCAL
    port: int | None = None


class Groot2Part(ViewerProcess):
    """Groot2Part: keeps the process; `saw` takes each snapshot, in the plant's thread."""

    def __init__(self, cells: Sequence[str], options: Groot2Options) -> None:
        super().__init__("groot2", "shows trees to Groot2", "arboleda_trees.groot2.process")
        self._cells = cells
        self._options = options
        self._tasks: dict[str, str] = {}  # the one whose tree each cell showed last
        self._last_lines: dict[str, bytes] = {}

    def start(self) -> None:
        """Start the process; StartError if a named port is taken, or a library is missing."""
        if not all(map(find_spec, LIBRARIES)):
            raise StartError(f"Groot2: {MISSING}")
        process = self.spawn(self._options.host, list(self._cells), self._options.port)
        answer = self.answer(process, START_S)
        if "ports" not in answer:
            self.stop()
            why = answer.get("error", "its process did not start; is pyzmq installed, and msgpack?")
            raise StartError(f"Groot2: {why}")
        self.notes = self._notes(answer["ports"])
        self.begin(process)

    def _notes(self, ports: Mapping[str, int]) -> list[str]:
        rows = ", ".join(f"{cell} {port}/{port + 1}" for cell, port in ports.items())
        notes = [f"Groot2: {rows} on {self._options.host}"]
        if not is_loopback(self._options.host):
            notes.append("Groot2: everybody on that network sees the trees; its protocol knows no token")
        return notes

    def lines(self, at_us: int, snapshot: Snapshot) -> Iterator[bytes]:
        """The lines for the process, one for each cell with news."""
        done = {task["id"] for task in snapshot["tasks"] if task["state"] == TaskState.DONE.value}
        for cell in snapshot["cells"]:
            if cell["task"] is not None:
                self._tasks[cell["name"]] = cell["task"]["id"]
            has_succeeded = self._tasks.get(cell["name"]) in done
            shown = {**cell_for_viewers(cell), "has_succeeded": has_succeeded}
            line = json.dumps(shown, default=str).encode()
            if self._last_lines.get(cell["name"]) != line:
                self._last_lines[cell["name"]] = line
                yield b'{"at_us": %d, %s\n' % (at_us, line[1:])


def cell_for_viewers(cell: Mapping[str, Any]) -> dict[str, Any]:
    """The part of a cell's snapshot that viewers get."""
    task, shown = cell["task"], ("path", "name", "kind", "status", "parameters")
    facts = {"cell": cell["name"], "state": cell["state"], "step": cell["step"]}
    if task is not None:
        facts |= {f"task_{key}": task[key] for key in OF_TASK}
    tree = [{key: row[key] for key in shown} for row in cell["tree"]]
    return {"name": cell["name"], "facts": facts, "tree": tree}
