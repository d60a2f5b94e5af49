"""OPC UA view: the plant as a server that others browse and nobody writes to, in a process of its own."""

from __future__ import annotations

import json
import subprocess
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.model.messages import ENDED, TaskChanged, TaskState
from arboleda.oee.figures import Oee
from arboleda.runtime.parts.viewer_process import Snapshot, ViewerProcess
from arboleda.web.access.names import is_loopback

from .packml import Counts, Tag, tags

START_S = 60.0  # it makes the nodes that every server has, over a second of a processor


@dataclass(frozen=True, kw_only=True)
class OpcUaViewOptions:
    """The address of the server, and the folders that its plant is in, the outermost first."""

    host: str
    port: int
    plant: str
    folders: Sequence[str] = ()


class OpcUaViewPart(ViewerProcess):
    """OpcUaViewPart: keeps the server; `saw` takes snapshots, `changed` tasks, in the plant's thread."""

    def __init__(self, options: OpcUaViewOptions, oee: Callable[[], Sequence[Oee]]) -> None:
        super().__init__("opcua view", "shows the plant over OPC UA", "arboleda_fleet.opcua_view.process")
        self._options, self._oee = options, oee
        self._ended, self._failed = Counter[str](), Counter[str]()
        self._figures_of = -1  # ended tasks, when the figures were last asked for
        self._figures: dict[str, Mapping[str, Any]] = {}
        self._last_rows: dict[str, list[Any]] = {}

    def start(self) -> None:
        """Start the server, and wait for nothing: whatever becomes of it, the plant goes on."""
        options = self._options
        process = self.spawn(options.host, options.port, options.plant, list(options.folders))
        host = f"[{options.host}]" if ":" in options.host else options.host
        self.notes = [f"OPC UA: opc.tcp://{host}:{options.port}, read only"]
        if not is_loopback(options.host):
            self.notes.append("OPC UA: everybody on that network sees the plant; there is no user")
        self.begin(process)

    def changed(self, task: TaskChanged) -> None:
        """Count a task that ended; a repeated request gets the end once more, which does not count."""
        if task.state in ENDED and task.request is None:
            self._failed[task.cell or ""] += task.state is TaskState.FAILED
            self._ended[task.cell or ""] += 1

    def tell(self, process: subprocess.Popen[bytes]) -> None:
        answer = self.answer(process, START_S)
        if "port" in answer:
            super().tell(process)
        else:
            self.lost(
                answer.get("error", "its process did not start; is asyncua installed, arboleda[opcua]?")
            )

    def lines(self, at_us: int, snapshot: Snapshot) -> Iterator[bytes]:
        """A line for each cell with news: the values of its variables, by their paths."""
        cells = [cell["name"] for cell in snapshot["cells"]]
        self._look_up_figures()
        counts = {name: Counts(ended=self._ended[name], failed=self._failed[name]) for name in cells}
        for cell, found in tags(snapshot, counts, self._figures).items():
            rows = [row(tag) for tag in found]
            if self._last_rows.get(cell) != rows:
                self._last_rows[cell] = rows
                yield json.dumps({"at_us": at_us, "cell": cell, "tags": rows}).encode() + b"\n"

    def _look_up_figures(self) -> None:
        """Ask for the OEE of the last day, once a task has ended: until then its counts are the same."""
        ended = self._ended.total()
        if ended == self._figures_of:
            return
        self._figures_of = ended
        try:
            self._figures = {each.cell: each.data() for each in self._oee()}
        except ArboledaError:
            self._figures = {}  # the memory cannot be read now, which the plant says elsewhere


def row(tag: Tag) -> list[Any]:
    """A variable as plain data."""
    return [list(tag.path), tag.type, tag.value]
