"""One run of a plant in a terminal: start it, show it, end it cleanly."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from queue import SimpleQueue
from typing import Any

from rich.console import Console
from rich.text import Text

from arboleda.host.packages import registered
from arboleda.model.errors import StartError
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase
from arboleda.runtime import invocation
from arboleda.runtime.build import App
from arboleda.runtime.interrupts import interruptible, taken_from, until_interrupted
from arboleda.runtime.log_file import LogFile
from arboleda.runtime.log_queue import LogQueue, log_to

from .errand import Errand
from .language import finding, say
from .screen import LONGEST, Screen, logged, parting, summary

NO_ROS = Phrase(
    "cli.no_ros",
    "ROS 2 for Python is not installed here; `make install ROS=1` in a clone of Arboleda installs it, "
    "`pip install 'arboleda[ros]'` elsewhere; or source a ROS 2 installation",
)
ROS_BROKEN = Phrase("cli.ros_broken", "{no_ros} ({error})")
STARTING = Phrase("cli.session.starting", "starting ...")
STOPPING = Phrase("cli.session.stopping", "stopping: whatever moves is halted ...")
WAITED = Phrase(
    "cli.session.waited",
    "After {seconds} s no task can begin without devices that are offline; "
    "--wait-for-devices SECONDS waits longer:",
)
NEEDS_PERSON = Phrase(
    "cli.session.needs_person",
    "A person has to act before that can begin: start the plant without --once to do so.",
)
STAYS = Phrase(
    "cli.session.stays", "The plant stays up for more tasks: {command} submit 'TASK'. Ctrl-C ends it."
)


class RosMissing(StartError):
    """There is no rclpy here."""


def ros_link(*, lan: bool) -> Any:
    """The ROS 2 link of the entry point `arboleda.links: ros`; RosMissing if there is none."""
    found = next((each for each in registered("arboleda.links") if each.name == "ros"), None)
    if found is None:
        raise RosMissing(NO_ROS())
    try:
        connect = found.load()
    except ImportError as error:
        if error.name == "rclpy":
            raise RosMissing(NO_ROS()) from error
        raise RosMissing(ROS_BROKEN(no_ros=NO_ROS(), error=str(error))) from error
    return connect(lan=lan)


class Session:
    """Session: a plant in a terminal. Only the thread that calls `run` prints, so that no trouble with the
    terminal can reach the plant."""

    def __init__(
        self,
        app: App,
        texts: Sequence[str],
        console: Console,
        *,
        stay: bool,
        patience_s: float | None = None,
    ) -> None:
        self._app = app
        self._console = console
        self._stay = stay
        self._news: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._patience_s = patience_s  # for devices that are offline, where it does not stay
        self._errand = Errand(
            texts,
            lambda: self._log.then(lambda: self._news.put(self._finished)),
            patience_s=patience_s,
        )
        self._screen = Screen(console, app.plant.screens.snapshot, app.log_file)
        self._stopping = False
        self._noted: list[str] = []

    def run(self) -> int:
        """Run the plant, without `stay` until the tasks have ended; 0, or 1 if one was not done."""
        self._app.listen(self._errand.changed)
        self._app.watch(lambda snapshot: self._later(self._screen.stepped, snapshot, time.time()))
        self._app.watch(self._errand.note_snapshot)
        self._app.when_over(lambda: self._news.put(None))
        with interruptible(), self._logging() as self._log:
            self._start()
            try:
                with until_interrupted():
                    self._tell_notes()
                    self._errand.start(self._app.plant.submit)
                    with self._screen:
                        self._show()
                        self._app.wait()
            finally:
                self._stop()
        return 0 if self._stay or self._errand.ok else 1

    @contextmanager
    def _logging(self) -> Iterator[LogQueue]:
        """Log to the terminal what matters there, and to a file the details, tracebacks among them."""
        tell = partial(self._later, self._console.print)
        details = LogFile(self._app.log_file, tell)
        try:
            with log_to(details.handle, self._say, *self._app.log_outputs) as queue:
                yield queue
        finally:
            details.close()

    def _say(self, line: logging.LogRecord) -> None:
        if line.levelno >= logging.INFO:
            self._later(self._show_line, line)

    def _show_line(self, line: logging.LogRecord) -> None:
        """A line of the log, which a note about the start may have said."""
        if line.getMessage() not in self._noted:
            self._screen.say(logged(line), line.created)

    def _later(self, show: Callable[..., None], *what: Any) -> None:
        self._news.put(partial(show, *what))

    def _show(self) -> None:
        for news in taken_from(self._news):
            news()

    def _start(self) -> None:
        with self._console.status(say(STARTING())):
            self._app.start()

    def _tell_notes(self) -> None:
        self._noted = self._app.notes
        for line in self._noted:
            self._console.print(Text(finding(line), style="dim"))

    def _finished(self) -> None:
        if not self._errand.texts or self._stopping:
            return
        self._console.print(summary(self._errand.results, self._errand.seconds))
        if self._errand.missing:
            waited = WAITED(seconds=f"{self._patience_s:g}")
            self._console.print(Text(say(waited), style="red"))
        for line in self._errand.missing:
            self._console.print(Text(f"  {plain(say(line), LONGEST)}", style="red"), soft_wrap=True)
        if not self._stay:
            if self._errand.needs_person:
                self._console.print(Text(say(NEEDS_PERSON()), style="red"))
            self._app.end()
            return
        self._console.print(Text(say(STAYS(command=invocation.command()))))

    def _stop(self) -> None:
        """Halt everything and print the state in which each robot was left."""
        self._stopping = True
        self._console.print(Text(say(STOPPING()), style="dim"))
        self._app.stop()
        self._log.flush()
        self._news.put(None)
        self._show()
        for line in parting(self._app.plant.screens.snapshot()):
            self._console.print(Text(f"  {line}", style="dim"))
