"""`arboleda oee`: how much of their planned time the cells did good work."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from datetime import datetime
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from arboleda.cli import plant_options
from arboleda.cli.tasks import moment
from arboleda.drivers import plain
from arboleda.extension import Phrase, RunningPlant, StateFolder, StoreAddress, say
from arboleda.oee.figures import Oee

from .api import OeeQuery
from .rows import figures

HEADINGS = (
    Phrase("cli.oee.cell", "cell"),
    Phrase("cli.oee.oee", "OEE"),
    Phrase("cli.oee.availability", "availability"),
    Phrase("cli.oee.performance", "performance"),
    Phrase("cli.oee.quality", "quality"),
    Phrase("cli.oee.planned", "planned"),
    Phrase("cli.oee.done", "done"),
    Phrase("cli.oee.failed", "failed"),
)
NO_CELL = Phrase("cli.oee.no_cell", "no cell had a task in that time")
SINCE = Phrase("cli.oee.since", "since {begin}")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(oee)


def oee(
    cell: Annotated[str, typer.Option(metavar="CELL", help="Only this cell.")] = "",
    since: Annotated[
        str, typer.Option(metavar="TIME", help="From then on: 8h (eight hours ago), 7d, or 2026-11-21T06:00.")
    ] = "24h",
    until: Annotated[str | None, typer.Option(metavar="TIME", help="Until then. [default: now]")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print an object per line.")] = False,
    plant: RunningPlant = None,
    state: StateFolder = None,
    store: StoreAddress = "",
) -> None:
    """OEE of the cells, availability x performance x quality, whether the plant runs or not.

    docs/how-to/oee.md says how each figure is counted. Only cells that had a task are shown, from what the
    history keeps.

    Exit status: 0 printed, 1 the plant's memory cannot be read, 2 bad input.
    """
    query = OeeQuery(cell=cell, since_s=moment(since), until_s=moment(until))
    rows = figures(plant_options.history(plant, state, store), query, time.time())
    if as_json:
        for row in rows:
            print(json.dumps(row.data(), ensure_ascii=False))
        return
    console = Console(highlight=False)
    if not rows:
        console.print(say(NO_CELL()))
        return
    console.print(_table(rows))
    for row in rows:
        if row.missing is not None:
            console.print(Text(f"{plain(row.cell)}: {say(row.missing)}"), soft_wrap=True)


def _table(rows: Sequence[Oee]) -> Table:
    begin = datetime.fromtimestamp(max(row.since_s for row in rows)).isoformat(sep=" ", timespec="minutes")
    drawn = Table(box=None, pad_edge=False, title=say(SINCE(begin=begin)), title_justify="left")
    for heading in HEADINGS:
        drawn.add_column(say(heading()), overflow="fold")
    for row in rows:
        shares = (row.oee, row.availability, row.performance, row.quality)
        numbers = (f"{row.planned_s / 3600:.1f} h", str(row.done), str(row.failed))
        drawn.add_row(Text(plain(row.cell)), *map(percent, shares), *numbers)
    return drawn


def percent(share: float | None) -> str:
    """`87 %`; a dash if it is unknown."""
    return "-" if share is None else f"{100 * share:.0f} %"
