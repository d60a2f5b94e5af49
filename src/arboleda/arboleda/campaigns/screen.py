"""Progress of something long: a bar in a terminal, else a plain line every few seconds."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from rich.table import Column
from rich.text import Text

EVERY_S = 5.0  # between plain lines
WIDTH = 120  # columns where there is no terminal that has a width
Show = Callable[[str, int], None]  # (what to say, how much is done)


def console(*, quiet: bool = False) -> Console:
    """Standard output, wide enough for a table in a file too; `quiet`: nothing is printed there."""
    made = Console(highlight=False, quiet=quiet)
    if not made.is_terminal:
        made.width = max(made.width, WIDTH)
    return made


@contextmanager
def progress(console: Console, doing: str, total: int | None) -> Iterator[Show]:
    """The function that shows the progress towards `total`; None: the end is unknown."""
    with _bar(console, doing, total) if console.is_terminal else _lines(console, doing) as show:
        yield show


@contextmanager
def _bar(console: Console, doing: str, total: int | None) -> Iterator[Show]:
    elapsed = TimeElapsedColumn(table_column=Column(no_wrap=True, min_width=len("0:00:00")))
    words = (TextColumn("{task.description}"), elapsed, TextColumn("{task.fields[said]}"))
    with Progress(SpinnerColumn(), BarColumn(bar_width=20), *words, console=console, transient=True) as bar:
        task = bar.add_task(doing, total=total, said="")
        yield lambda text, done: bar.update(task, said=text, completed=done)


@contextmanager
def _lines(console: Console, doing: str) -> Iterator[Show]:
    last = time.monotonic()

    def show(text: str, done: int) -> None:
        nonlocal last
        if time.monotonic() - last >= EVERY_S:
            last = time.monotonic()
            console.print(Text(f"{doing}: {text}"), soft_wrap=True)

    yield show
