"""One run of a plant in a terminal: start it, show it, end it cleanly."""

from __future__ import annotations

import logging
import shutil
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from importlib.metadata import entry_points
from logging.handlers import RotatingFileHandler
from pathlib import Path
from queue import SimpleQueue
from types import FrameType
from typing import Any

from rich.console import Console
from rich.text import Text

from arboleda.core.errors import StartError

from .build import App
from .errand import Errand
from .parts.orchestrator import TASKS
from .screen import Screen, parting, summary

NO_ROS = (
    "ROS 2 for Python is not installed here; install it with `pip install 'arboleda[ros]'`, "
    "source a ROS 2 installation, or start with --no-ros"
)
LOG_BYTES = 1_000_000


def ros_link(*, lan: bool) -> Any:
    """The ROS 2 link behind the entry point `arboleda.links: ros`; StartError where there is none."""
    found = next(iter(entry_points(group="arboleda.links", name="ros")), None)
    if found is None:
        raise StartError(NO_ROS)
    try:
        connect = found.load()
    except ImportError as error:
        raise StartError(f"{NO_ROS} ({error})") from error
    return connect(lan=lan)


class Session:
    """A plant in a terminal. Whatever is printed is printed by the thread that calls `run`: no trouble with
    the terminal can reach the plant."""

    def __init__(self, app: App, texts: Sequence[str], console: Console, *, stay: bool) -> None:
        self._app = app
        self._console = console
        self._stay = stay
        self._news: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._errand = Errand(texts, lambda: self._news.put(self._finished))
        self._screen = Screen(console, app.snapshot)
        self._stopping = False

    def run(self) -> int:
        """Run the plant, without `stay` until the tasks ended; 0, or 1 where one was not done."""
        self._app.listen(lambda change: self._later(self._screen.changed, change), self._errand.changed)
        self._app.watch(lambda snapshot: self._later(self._screen.stepped, snapshot))
        self._app.watch(self._errand.seen)
        self._app.when_over(lambda: self._news.put(None))
        with _interruptible(), _logging(self._say, self._app.log_file):
            self._start()
            try:
                self._errand.start(self._app.submit)
                with self._screen, suppress(KeyboardInterrupt):
                    self._show()
                    self._app.wait()
            finally:
                self._stop()
        return 0 if self._stay or self._errand.ok else 1

    def _later(self, show: Callable[[Any], None], what: Any) -> None:
        self._news.put(partial(show, what))

    def _say(self, line: str, style: str = "") -> None:
        self._later(self._console.print, Text(line, style=style))

    def _show(self) -> None:
        for news in iter(self._news.get, None):
            news()

    def _start(self) -> None:
        with self._console.status("starting ..."):
            self._app.start()
        for line in self._app.notes:
            self._console.print(Text(line, style="dim"))

    def _finished(self) -> None:
        if not self._errand.texts or self._stopping:
            return
        self._console.print(summary(self._errand.results, self._errand.seconds))
        if not self._stay:
            self._app.end()
            return
        hint = f"The plant stays up for more tasks: {_command()} submit 'TASK'. Ctrl-C ends it."
        self._console.print(Text(hint))

    def _stop(self) -> None:
        """Halt everything and say how each robot was left."""
        self._stopping = True
        self._console.print(Text("stopping: whatever moves is halted ...", style="dim"))
        self._app.stop()
        self._news.put(None)
        self._show()
        for line in parting(self._app.snapshot()):
            self._console.print(Text(f"  {line}", style="dim"))


def _command() -> str:
    """How the person who started this calls the command."""
    return "arboleda" if shutil.which("arboleda") else sys.argv[0]


@contextmanager
def _interruptible() -> Iterator[None]:
    """SIGTERM ends the plant like Ctrl-C; a second signal does not break the clean end."""

    def interrupt(number: int, frame: FrameType | None) -> None:
        for each in before:
            signal.signal(each, signal.SIG_IGN)
        raise KeyboardInterrupt

    before = {number: signal.signal(number, interrupt) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


class _Teller(logging.Handler):
    """Has every log line said."""

    def __init__(self, say: Callable[[str, str], None]) -> None:
        super().__init__(logging.INFO)
        self._say = say

    def emit(self, record: logging.LogRecord) -> None:
        if record.name == TASKS.name:  # the screen says these itself
            return
        style = "dim" if record.levelno < logging.WARNING else "yellow"
        self._say(record.getMessage(), "red" if record.levelno >= logging.ERROR else style)


@contextmanager
def _logging(say: Callable[[str, str], None], file: Path) -> Iterator[None]:
    """What matters to the terminal; details, tracebacks among them, to a file for whoever has to look."""
    details = RotatingFileHandler(file, maxBytes=LOG_BYTES, backupCount=1, encoding="utf-8", delay=True)
    details.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s: %(message)s"))
    handlers = (details, _Teller(say))
    log = logging.getLogger("arboleda")
    log.setLevel(logging.DEBUG)
    for handler in handlers:
        log.addHandler(handler)
    try:
        yield
    finally:
        for handler in handlers:
            log.removeHandler(handler)
            handler.close()
