"""Tests and seeds that come by a line: only they can find what is wrong with it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from coverage import Coverage

from .mutant import Mutant


@dataclass
class Reach:
    """`names` in the order in which they ran, `cpu_s` what each took.

    `lines` are numbers in hexadecimal with a bit per name, by file and line.
    """

    names: list[str] = field(default_factory=list)
    cpu_s: list[float] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)
    lines: dict[str, dict[str, str]] = field(default_factory=dict)

    def of(self, mutant: Mutant) -> list[str]:
        """Those who come by the statement of a mutant, or by its file if that is read at import."""
        rows = {int(line): int(bits, 16) for line, bits in self.lines.get(mutant.file, {}).items()}
        first, last = mutant.lines
        bits = 0
        for line, those in rows.items():
            if first <= line <= last or not mutant.function:
                bits |= those
        if not mutant.function or self._at_import(mutant):
            for those in rows.values():
                bits |= those
        return [name for number, name in enumerate(self.names) if bits >> number & 1]

    def _at_import(self, mutant: Mutant) -> bool:
        """True if its statement was carried out while nobody ran: in a class body, or a default."""
        imported = self.lines.get(f"{mutant.file}@import", {})
        return any(str(line) in imported for line in range(mutant.lines[0], mutant.lines[1] + 1))

    def taken_s(self, name: str) -> float:
        return self.cpu_s[self.names.index(name)]

    def breadth(self) -> dict[str, int]:
        """Number of lines that each comes by."""
        found = [0] * len(self.names)
        for rows in self.lines.values():
            for bits in rows.values():
                number, left = 0, int(bits, 16)
                while left:
                    if left & 1:
                        found[number] += 1
                    left >>= 1
                    number += 1
        return dict(zip(self.names, found, strict=True))

    def as_json(self) -> dict[str, Any]:
        return dict(vars(self))


class Tracer:
    """Measures the files in folders of `package`, and in `beside`; `during(name)` says who runs."""

    def __init__(self, package: Path, folders: tuple[str, ...], *beside: Path) -> None:
        self._packages = (*(each.parent for each in beside), package)
        source = [str(each) for each in (*(package / folder for folder in folders), *beside)]
        self._coverage = Coverage(data_file=None, source=source, config_file=False, messages=False)
        self.reach = Reach()

    @contextmanager
    def running(self) -> Iterator[None]:
        self._coverage.start()
        try:
            yield
        finally:
            self._coverage.stop()
            self._take_over()

    @contextmanager
    def during(self, name: str) -> Iterator[None]:
        self._coverage.switch_context(str(len(self.reach.names)))
        self.reach.names.append(name)
        try:
            yield
        finally:
            self._coverage.switch_context("")

    def _take_over(self) -> None:
        data = self._coverage.get_data()
        for path in data.measured_files():
            package = next(each for each in self._packages if Path(path).is_relative_to(each))
            file = Path(path).relative_to(package).as_posix()
            rows, imported = {}, {}
            for line, contexts in data.contexts_by_lineno(path).items():
                bits = sum(1 << int(context) for context in contexts if context)
                if bits:
                    rows[str(line)] = f"{bits:x}"
                if "" in contexts:
                    imported[str(line)] = "0"
            self.reach.lines[file], self.reach.lines[f"{file}@import"] = rows, imported
