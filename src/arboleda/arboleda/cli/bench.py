"""The command `arboleda bench`: its options; the benchmarks themselves are in bench/."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from arboleda.host.packages import registered
from arboleda.model.errors import StartError

GROUP = "arboleda.bench"
MISSING = "the benchmarks are not installed here; `make install` in Arboleda's own folder brings them"
HELP = """Measure this machine: our figures beside the least that the same run can take.

\b
arboleda bench                   all of them, about twenty minutes
arboleda bench --quick           all of them, at most ten minutes, figures less certain
arboleda bench reaction chain    only these two
arboleda bench --list            name all that there are

Leave the machine alone meanwhile. What falls short of its aim is marked.
What the figures mean: docs/performance.md.

Exit status: 0 measured, 1 a benchmark could not run, 2 bad input, 130 Ctrl-C."""

Names = Annotated[list[str] | None, typer.Argument(metavar="NAME", help="Benchmarks. [default: all]")]
Json = Annotated[
    Path | None,
    typer.Option(
        "--json",
        metavar="FILE",
        help="Write every figure, and on which machine it was measured, to this file.",
    ),
]
Quick = Annotated[bool, typer.Option("--quick", help="Short runs: at most ten minutes for all of them.")]
Listed = Annotated[bool, typer.Option("--list", help="Name the benchmarks and what they measure, and exit.")]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""

    def bench(names: Names = None, json: Json = None, quick: Quick = False, listed: Listed = False) -> None:
        found = registered(GROUP)
        if not found:
            raise StartError(MISSING)
        raise typer.Exit(found[0].load()(names or [], quick=quick, file=json, listed=listed))

    cli.command("bench", help=HELP, short_help=HELP.partition("\n")[0])(bench)
