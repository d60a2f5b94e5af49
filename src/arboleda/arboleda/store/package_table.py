"""Table of a package in the memory of a plant."""

from __future__ import annotations

from collections.abc import Mapping

from .rows import Rows, row_of_fact

PREFIX = "package."  # no `Fact` begins so


class PackageTable:
    """PackageTable: texts by name. `name` is that of the package, or PACKAGE.WHAT where it has several.

    The next start finds what was put, also after a kill; a power cut may undo the last of it. The thread that
    makes parts may read and write it, then that of the plant, as its observers do, and after the end of the
    plant the one that ends parts.
    """

    def __init__(self, memory: Rows, name: str) -> None:
        self._memory = memory
        self._fact = f"{PREFIX}{name}"

    def rows(self) -> dict[str, str]:
        """All rows; raises ArboledaError."""
        return dict(
            self._memory.read("SELECT name, value FROM fact WHERE fact = ? ORDER BY name", self._fact)
        )

    def put(self, rows: Mapping[str, str | None]) -> None:
        """Write all of these rows, or none, and delete those that are None; raises ArboledaError."""
        statements = [row_of_fact((self._fact, name), value) for name, value in rows.items()]
        if statements:
            self._memory.write(*statements, durable=False)
