"""Progress of something long: a bar in a terminal, else a plain line every few seconds."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any

from rich.console import Console, ConsoleOptions, RenderableType
from rich.measure import Measurement
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from rich.table import Column, Table
from rich.text import Text

from arboleda.dashboard.findings import findings
from arboleda.extension import words
from arboleda.web.languages import FIRST
from arboleda.web.languages.templates import heading

EVERY_S = 5.0  # between plain lines
FIRST_S = 1.0  # until the first of a command that loads for a second before
WIDTH = 120  # columns where there is no terminal that has a width
WIDEST = 1000  # columns of a table there
Show = Callable[[str, int], None]  # (what to say, how much is done)


class SpeakingConsole(Console):
    """Standard output in a language: lines go through its templates, headings of tables through its own."""

    def __init__(self, language: str, *, quiet: bool) -> None:
        super().__init__(highlight=False, quiet=quiet)
        self._language = language

    def say(self, text: str) -> str:
        """A line in the language."""
        return findings(self._language)(text)

    def end(self, name: str) -> str:
        """An end of a task, or its cause, in the language."""
        return words(self._language).ends.get(name, name)

    def print(self, *objects: Any, **how: Any) -> None:
        super().print(*map(self._spoken, objects), **how)

    def measure(self, renderable: RenderableType, *, options: ConsoleOptions | None = None) -> Measurement:
        """The columns of characters that something takes as it is printed, in the language."""
        return super().measure(self._spoken(renderable), options=options)

    def _spoken(self, shown: Any) -> Any:
        if isinstance(shown, Text) and not shown.spans:
            return Text(self.say(shown.plain), style=shown.style)
        if isinstance(shown, Table):
            for column in shown.columns:
                if isinstance(column.header, str):
                    column.header = heading(self._language, column.header)
                for cell in column.cells:
                    if isinstance(cell, Table):
                        self._spoken(cell)
        return shown


def console(*, language: str = FIRST, quiet: bool = False) -> SpeakingConsole:
    """Standard output, wide enough for a table in a file too; `quiet`: nothing is printed there."""
    made = SpeakingConsole(language, quiet=quiet)
    if not made.is_terminal:
        made.width = max(made.width, WIDTH)
    return made


def print_whole(console: Console, table: Table) -> None:
    """Print a table; where no terminal has a width, as wide as it is."""
    if not console.is_terminal:
        as_wide_as_it_is = console.options.update(max_width=WIDEST)
        console.width = max(console.width, console.measure(table, options=as_wide_as_it_is).maximum)
    console.print(table)


def ends_of(console: Console) -> Callable[[str], str]:
    """The function that says an end of a task, or its cause, in the language of this console."""
    return console.end if isinstance(console, SpeakingConsole) else str


def say_of(console: Console) -> Callable[[str], str]:
    """The function that says a line in the language of this console."""
    return console.say if isinstance(console, SpeakingConsole) else str


def waiting(console: SpeakingConsole, doing: str) -> AbstractContextManager[object]:
    """A line in a terminal that says so, for as long as it takes."""
    return console.status(Text(console.say(doing))) if console.is_terminal else nullcontext()


@contextmanager
def progress(
    console: Console,
    doing: str,
    total: int | None,
    *,
    first_s: float = EVERY_S,
    forks: bool = False,
    clock: Callable[[], float] = time.monotonic,
) -> Iterator[Show]:
    """The function that shows the progress towards `total`; None: the end is unknown.

    `first_s`: when the first plain line comes. `forks`: processes are forked meanwhile, so no thread draws.
    """
    say = console.say if isinstance(console, SpeakingConsole) else str
    shown = say(doing)
    bar = _bar(console, shown, total, refreshed_by_thread=not forks) if console.is_terminal else None
    with bar or _lines(console, shown, first_s, clock) as show:
        yield lambda sentence, done: show(say(sentence), done)


@contextmanager
def _bar(console: Console, doing: str, total: int | None, *, refreshed_by_thread: bool) -> Iterator[Show]:
    elapsed = TimeElapsedColumn(table_column=Column(no_wrap=True, min_width=len("0:00:00")))
    said = TextColumn("{task.fields[said]}", table_column=Column(no_wrap=True))
    columns = (SpinnerColumn(), BarColumn(bar_width=20), TextColumn("{task.description}"), elapsed, said)
    with Progress(*columns, console=console, transient=True, auto_refresh=refreshed_by_thread) as bar:
        task = bar.add_task(doing, total=total, said="")
        yield lambda text, done: bar.update(task, said=text, completed=done, refresh=not refreshed_by_thread)


@contextmanager
def _lines(console: Console, doing: str, first_s: float, clock: Callable[[], float]) -> Iterator[Show]:
    due = clock() + first_s

    def show(text: str, done: int) -> None:
        nonlocal due
        if clock() >= due:
            due = clock() + EVERY_S
            console.print(Text(f"{doing}: {text}"), soft_wrap=True)

    yield show
