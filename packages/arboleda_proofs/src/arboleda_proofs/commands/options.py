"""Options that several commands have."""

from __future__ import annotations

from typing import Annotated

import typer

On = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Have the workers of a scheduler of Dask do it, which may be on other hosts: tcp://HOST:8786.",
    ),
]
