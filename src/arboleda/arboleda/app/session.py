"""One run of a plant in a terminal: start it, show it, end it cleanly."""

from __future__ import annotations

import logging
import signal
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib.metadata import entry_points
from logging.handlers import RotatingFileHandler
from pathlib import Path
from types import FrameType
from typing import Any

from rich.console import Console
from rich.logging import RichHandler
from rich.text import Text

from arboleda.core.errors import StartError

from .build import App
from .errand import Errand
from .screen import Screen, effector, summary

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


def run(app: App, texts: list[str], console: Console, *, stay: bool) -> int:
    """Run the plant with these tasks, without `stay` until they ended; 0, or 1 where one was not done."""
    errand = Errand(texts, lambda: _finished(app, errand, console, stay=stay))
    screen = Screen(console, app.snapshot)
    app.listen(screen.changed, errand.changed)
    app.watch(screen.stepped)
    with _interruptible(), _logging(console, app.log_file):
        try:
            _start(app, console)
            errand.start(app.submit)
            with screen, suppress(KeyboardInterrupt):
                app.wait()
        finally:
            _stop(app, console)
    return 0 if stay or errand.ok else 1


def _start(app: App, console: Console) -> None:
    with console.status("starting ..."):
        app.start()
    for line in app.notes:
        console.print(Text(line, style="dim"))


def _finished(app: App, errand: Errand, console: Console, *, stay: bool) -> None:
    if errand.texts:
        console.print(summary(errand.results, errand.seconds))
    if not stay:
        app.end()
    elif errand.texts:
        console.print(Text("The plant stays up for more tasks: arboleda submit 'TASK'. Ctrl-C ends it."))


def _stop(app: App, console: Console) -> None:
    """Halt everything and say how each robot was left."""
    console.print(Text("stopping: whatever moves is halted ...", style="dim"))
    app.stop()
    for robot in app.snapshot()["robots"]:
        if robot["state"] is None:
            continue
        left = "still" if robot["state"] in (0, 3, 4) else "NOT confirmed still"
        grip = f", effector {effector(robot)}" if robot["effector"] is not None else ""
        console.print(Text(f"  {robot['name']}: {left}{grip}", style="dim"))


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


@contextmanager
def _logging(console: Console, file: Path) -> Iterator[None]:
    """Warnings to the terminal; details, tracebacks among them, to a file for whoever has to look."""
    details = RotatingFileHandler(file, maxBytes=LOG_BYTES, backupCount=1, encoding="utf-8", delay=True)
    details.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s: %(message)s"))
    shown = RichHandler(console=console, show_path=False, show_time=False, level=logging.INFO)
    log = logging.getLogger("arboleda")
    log.setLevel(logging.DEBUG)
    for handler in (details, shown):
        log.addHandler(handler)
    try:
        yield
    finally:
        for handler in (details, shown):
            log.removeHandler(handler)
            handler.close()
