"""Groot2 part: shows the cells' trees to Groot2, from a process of its own that gets snapshots."""

from __future__ import annotations

import json
import logging
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from arboleda.model.errors import StartError
from arboleda.model.messages import TaskState
from arboleda.web.access.names import LOCAL, is_loopback

LOG = logging.getLogger(__name__)
START_S = 20.0
BEGIN = "import sys, json; path, *given = map(json.loads, sys.argv[1:]); sys.path[:] = path; "
PROCESS = BEGIN + "from arboleda.adapters import groot2_process; groot2_process.main(*given)"
OF_TASK = ("id", "text", "state", "answers")


@dataclass(frozen=True, kw_only=True)
class Groot2Options:
    """The address for Groot2; `port` is that of the first cell, None for 1667 or any free one."""

    host: str = LOCAL
    port: int | None = None


class Groot2Part:
    """Groot2Part: keeps the process; `saw` takes each snapshot, in the plant's thread."""

    def __init__(self, cells: Sequence[str], options: Groot2Options) -> None:
        self._cells = cells
        self._options = options
        self._process: subprocess.Popen[bytes] | None = None
        self._thread: threading.Thread | None = None
        self._news = threading.Event()
        self._latest: deque[tuple[int, Mapping[str, Any]]] = deque(maxlen=1)
        self._tasks: dict[str, str] = {}  # the one whose tree each cell showed last
        self._stopping = False
        self._told: dict[str, bytes] = {}
        self.notes: list[str] = []

    def saw(self, snapshot: Mapping[str, Any]) -> None:
        """Queue a snapshot's trees; an older one that was not shown yet is dropped."""
        self._latest.append((time.time_ns() // 1000, snapshot))
        self._news.set()

    def start(self) -> None:
        """Start the process; StartError if a named port is taken, or a library is missing."""
        given = [sys.path, self._options.host, list(self._cells), self._options.port]
        self._process = subprocess.Popen(
            [sys.executable, "-c", PROCESS, *map(json.dumps, given)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        self.notes = self._notes(self._ports(self._process))
        self._thread = threading.Thread(target=self._tell, args=(self._process,), name="groot2", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        self._stopping = True
        self._news.set()
        if self._process is not None:
            self._process.kill()  # it holds nothing; and a thread that is writing to it goes on
        if self._thread is not None:
            self._thread.join()
            self._thread = None
        if self._process is not None:
            self._process.wait()
            for pipe in (self._process.stdin, self._process.stdout):
                with suppress(BrokenPipeError):
                    pipe.close()  # type: ignore[union-attr]
            self._process = None

    def _ports(self, process: subprocess.Popen[bytes]) -> dict[str, int]:
        """The port of each cell, as the process reports it."""
        slow = threading.Timer(START_S, process.kill)
        slow.start()
        line = process.stdout.readline()  # type: ignore[union-attr]
        slow.cancel()
        slow.join()
        said: dict[str, Any] = json.loads(line or b"{}")
        if "ports" not in said:
            self.stop()
            why = said.get("error", "its process did not start; is pyzmq installed, and msgpack?")
            raise StartError(f"Groot2: {why}")
        return dict(said["ports"])

    def _notes(self, ports: Mapping[str, int]) -> list[str]:
        rows = ", ".join(f"{cell} {port}/{port + 1}" for cell, port in ports.items())
        found = [f"Groot2: {rows} on {self._options.host}"]
        if not is_loopback(self._options.host):
            found.append("Groot2: everybody on that network sees the trees; its protocol knows no token")
        return found

    def _tell(self, process: subprocess.Popen[bytes]) -> None:
        """Send news to the process until the end; in a thread of its own, which may have to wait."""
        try:
            while not self._stopping:
                self._news.wait()
                self._news.clear()
                for line in self._lines(*self._latest.popleft()) if self._latest else ():
                    process.stdin.write(line)  # type: ignore[union-attr]
                    process.stdin.flush()  # type: ignore[union-attr]
        except OSError:
            if not self._stopping:
                LOG.error("what shows trees to Groot2 has ended; the plant goes on without it")

    def _lines(self, at_us: int, snapshot: Mapping[str, Any]) -> Iterator[bytes]:
        """The lines for the process, one for each cell with news."""
        done = {task["id"] for task in snapshot["tasks"] if task["state"] == TaskState.DONE.value}
        for cell in snapshot["cells"]:
            if cell["task"] is not None:
                self._tasks[cell["name"]] = cell["task"]["id"]
            has_succeeded = self._tasks.get(cell["name"]) in done
            shown = {**cell_for_viewers(cell), "has_succeeded": has_succeeded}
            line = json.dumps(shown, default=str).encode()
            if self._told.get(cell["name"]) != line:
                self._told[cell["name"]] = line
                yield b'{"at_us": %d, %s\n' % (at_us, line[1:])


def cell_for_viewers(cell: Mapping[str, Any]) -> dict[str, Any]:
    """The part of a cell's snapshot that viewers get."""
    task, shown = cell["task"], ("path", "name", "kind", "status", "parameters")
    facts = {"cell": cell["name"], "state": cell["state"], "step": cell["step"]}
    if task is not None:
        facts |= {f"task_{key}": task[key] for key in OF_TASK}
    tree = [{key: row[key] for key in shown} for row in cell["tree"]]
    return {"name": cell["name"], "facts": facts, "tree": tree}
