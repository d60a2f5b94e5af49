"""Table of a package for any thread: what is put is written by the plant's thread, which has its memory."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Mapping
from typing import Any

from arboleda.model.errors import ArboledaError
from arboleda.store.package_table import PackageTable

LOOK_S, LOOKS = 0.1, 100
NOT_WRITTEN = f"the plant has not written this within {LOOK_S * LOOKS:g} s; nothing of it is kept"


class _Put:
    """Rows that wait to be written; `error` says why they are not."""

    def __init__(self, table: PackageTable, rows: Mapping[str, str | None]) -> None:
        self._table = table
        self._rows = rows
        self.error: Exception | None = None
        self.written = threading.Event()

    def write(self) -> None:
        try:
            self._table.put(self._rows)
        except Exception as error:  # noqa: BLE001 - it is raised where somebody waits for it
            self.error = error
        self.written.set()


class Writes:
    """Writes of packages: `flush` makes them in the thread of the plant, which `wake` has make a step.

    Where no plant `runs` they are made by whoever asks: before its start, and after its end.
    """

    def __init__(self, wake: Callable[[], None], runs: Callable[[], bool]) -> None:
        self._wake = wake
        self._runs = runs
        self._waiting: list[_Put] = []
        self._lock = threading.Lock()

    def make(self, table: PackageTable, rows: Mapping[str, str | None]) -> None:
        """Return once these rows are written; raises ArboledaError where they are not."""
        put = _Put(table, rows)
        with self._lock:
            self._waiting.append(put)
        for _ in range(LOOKS):
            if not self._runs():
                self.flush()
            self._wake()
            if put.written.wait(LOOK_S):
                break
        else:
            self._give_up(put)
        if put.error is not None:
            raise put.error

    def flush(self, _plant: object = None) -> None:
        """Write what waits; a listener after each step of the plant."""
        if not self._waiting:
            return
        with self._lock:
            waiting, self._waiting = self._waiting, []
            for each in waiting:
                each.write()

    def _give_up(self, put: _Put) -> None:
        """Write it no more; it may have been written meanwhile."""
        with self._lock:
            if put in self._waiting:
                self._waiting.remove(put)
                put.error = ArboledaError(NOT_WRITTEN)


class Table:
    """Rows of plain data by name, in the memory of the plant; any thread may use it.

    The next start finds what was put, on whichever host leads then, also after a kill; a power cut may undo
    the last second. Values are what JSON has: texts, numbers, bool, lists and mappings of these.
    """

    def __init__(self, kept: PackageTable, writes: Writes) -> None:
        self._kept = kept
        self._writes = writes
        self._texts = kept.rows()

    def rows(self) -> dict[str, Any]:
        """All rows, by name."""
        return {name: json.loads(text) for name, text in [*self._texts.items()]}

    def get(self, name: str, default: Any = None) -> Any:
        """The value of a row; `default` where there is none."""
        text = self._texts.get(name)
        return default if text is None else json.loads(text)

    def put(self, rows: Mapping[str, Any]) -> None:
        """Write all of these rows, or none, and delete those that are None; returns once they are written.

        Raises ArboledaError where the plant cannot keep them; ValueError or TypeError, and nothing is
        written, where a value is no plain data.
        """
        texts = {
            name: None if each is None else json.dumps(each, allow_nan=False) for name, each in rows.items()
        }
        self._writes.make(self._kept, texts)
        for name, text in texts.items():
            if text is None:
                self._texts.pop(name, None)
            else:
                self._texts[name] = text
