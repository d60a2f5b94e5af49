"""Options of the commands of virtual controllers, and the loop that runs one until Ctrl-C."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Protocol

import typer

from .faults import Faults

FaultNames = Annotated[
    list[str] | None,
    typer.Option("--fault", metavar="NAME", help="A fault that is on from the beginning; may be repeated."),
]
FaultPort = Annotated[
    int,
    typer.Option(
        metavar="PORT",
        help="Port where faults are switched over HTTP, PUT and DELETE /faults/NAME; 0: any free one.",
    ),
]


class Controller(Protocol):
    """Virtual controller that listens from `start` to `stop`."""

    @property
    def says(self) -> str:
        """Description in one line, with its address."""

    def start(self) -> None: ...
    def stop(self) -> None: ...


def adding(name: str, text: str, run: Callable[..., None]) -> Callable[[typer.Typer], None]:
    """The `add_to` of a module with this command, whose help is the text."""

    def add_to(cli: typer.Typer) -> None:
        cli.command(name, help=text)(run)

    return add_to


def with_faults(text: str, known: Mapping[str, str], title: str = "Faults") -> str:
    """The help of a command, with its faults listed."""
    rows = "\n".join(f"  {name}: {what}" for name, what in known.items())
    return f"{text}\n\n\b\n{title}:\n{rows}"


def serve(
    make: Callable[[Faults], Controller], known: Mapping[str, str], on: Sequence[str] | None, port: int
) -> None:
    """Run the controller that `make` makes until Ctrl-C or SIGTERM."""
    from .switchboard import Switchboard  # HTTP takes a while to load, and no other command needs it

    try:
        faults = Faults(known, on or ())
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--fault") from error
    over = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: over.set())
    signal.signal(signal.SIGINT, lambda *_: over.set())
    switchboard = Switchboard(faults, port)  # first: if its port is taken nothing else has begun
    controller = make(faults)
    controller.start()
    switchboard.start()
    print(controller.says, flush=True)
    print(f"faults are switched on http://127.0.0.1:{switchboard.port}/faults", flush=True)
    over.wait()
    switchboard.stop()
    controller.stop()
