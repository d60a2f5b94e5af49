"""Crew that a person asks for: processes of this machine, or the workers of a scheduler."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext

from rich.console import Console
from rich.text import Text

from arboleda.extension import StartError
from arboleda.runtime import invocation

from .campaign import Crew
from .workers import Processes, processors


def crew(jobs: int | None, on: str | None, console: Console) -> AbstractContextManager[Crew]:
    """The workers of the scheduler at the address `on`, else `jobs` processes, or one per processor.

    StartError without the library of workers, ArboledaError where no scheduler answers.
    """
    if on is None:
        return nullcontext(Processes(jobs or processors()))
    try:
        from .cluster import connected
    except ImportError as error:
        install = f"{invocation.pip_install()} 'arboleda[cluster]'"
        raise StartError(f"--on needs the library distributed: type `{install}` ({error})") from error
    return connected(on, lambda line: console.print(Text(line, style="yellow"), soft_wrap=True))
