"""Report of a run: one row per file, every survivor with its change, and all of it as JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from .book import Verdict
from .mutant import Mutant

ENDS = ("both", "tests", "simulator", "survived", "argued")


@dataclass(frozen=True, kw_only=True)
class Row:
    """One mutant and what both judges said; None where one was not asked.

    `reason`: why nobody can notice it, where that is argued.
    """

    mutant: Mutant
    tests: Verdict | None
    simulator: Verdict | None
    reason: str | None

    @property
    def end(self) -> str:
        """One of ENDS."""
        tests, simulator = (bool(each and each.killed) for each in (self.tests, self.simulator))
        if tests and simulator:
            return "both"
        if tests or simulator:
            return "tests" if tests else "simulator"
        return "argued" if self.reason else "survived"


def totals(rows: Sequence[Row]) -> dict[str, Any]:
    """Number of mutants by their end, and the shares in per cent."""
    ends = Counter(row.end for row in rows)
    killed = ends["both"] + ends["tests"] + ends["simulator"]
    alone = ends["both"] + ends["simulator"]
    return {
        "mutants": len(rows),
        **{end: ends[end] for end in ENDS},
        "killed_percent": _share(killed, len(rows)),
        "killed_or_argued_percent": _share(killed + ends["argued"], len(rows)),
        "by_simulator_alone_percent": _share(alone, len(rows)),
    }


def as_json(rows: Sequence[Row], **about: Any) -> dict[str, Any]:
    return {**about, "totals": totals(rows), "mutants": [_json(row) for row in rows]}


def show(console: Console, rows: Sequence[Row]) -> None:
    """The survivors, then a table of all."""
    for row in sorted(rows, key=lambda row: (row.mutant.file, row.mutant.line)):
        if row.end in ("survived", "argued"):
            console.print(_line(row))
    console.print(_table(rows))
    found = totals(rows)
    console.print(
        f"{found['mutants']} mutants: {found['killed_percent']} % killed, "
        f"{found['killed_or_argued_percent']} % with those that are argued to be no bugs; "
        f"{found['by_simulator_alone_percent']} % by the simulator alone"
    )


def _table(rows: Sequence[Row]) -> Table:
    table = Table(box=None, pad_edge=False)
    table.add_column("file")
    for head in ("mutants", *ENDS):
        table.add_column(head, justify="right")
    for file in sorted({row.mutant.file for row in rows}):
        ends = Counter(row.end for row in rows if row.mutant.file == file)
        table.add_row(file, str(ends.total()), *(str(ends[end] or "") for end in ENDS))
    return table


def _line(row: Row) -> Text:
    mutant = row.mutant
    text = Text(
        f"{mutant.place}  {mutant.function or 'module'}  {mutant.operator}  {row.end}\n", style="bold"
    )
    text.append(_marked("-", mutant.removed), style="red")
    text.append(_marked("+", mutant.added), style="green")
    text.append(f"    {mutant.key}\n", style="dim")
    return text.append(f"    {row.reason}\n") if row.reason else text


def _marked(sign: str, lines: str) -> str:
    return "".join(f"  {sign} {line}\n" for line in lines.splitlines())


def _json(row: Row) -> dict[str, Any]:
    judged = {"tests": row.tests, "simulator": row.simulator}
    verdicts = {name: asdict(verdict) if verdict else None for name, verdict in judged.items()}
    return {"key": row.mutant.key, **asdict(row.mutant), "end": row.end, "reason": row.reason, **verdicts}


def _share(part: int, whole: int) -> float:
    return round(100 * part / whole, 1) if whole else 0.0
