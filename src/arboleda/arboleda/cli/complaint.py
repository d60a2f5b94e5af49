"""Complaint of a command: one sentence on standard error, and its exit status."""

from __future__ import annotations

from arboleda.model.errors import ArboledaError, ConfigError, QueueFull, TextError
from arboleda.model.outside import plain

from .language import say_error

FAILED, BAD_INPUT = 1, 2
LONGEST = 1000  # characters of a line on the terminal


def complain(error: ArboledaError) -> None:
    """Print an error in the language of the terminal."""
    from rich.console import Console  # takes longer to load than most commands, and few complain
    from rich.text import Text

    lines = "\n".join(plain(line, LONGEST) for line in f"arboleda: {say_error(error)}".splitlines())
    Console(stderr=True, highlight=False).print(Text(lines, style="red"), soft_wrap=True)


def status_of(error: ArboledaError) -> int:
    """The exit status of a command that ends with this error."""
    from arboleda.client.errors import Conflict  # loads what checks the answers of a plant
    from arboleda.recorder.errors import NoRecord

    bad = ConfigError, NoRecord, TextError, QueueFull, Conflict
    return BAD_INPUT if isinstance(error, bad) else FAILED
