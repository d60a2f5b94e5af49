"""One seed, told line by line as it happens: printed, recorded or both; the same every time."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

from rich.console import Console
from rich.text import Text

from arboleda.simulator.run import Result

from . import report, story, summary
from .many import BROKEN, HELD, INTERRUPTED
from .request import Request
from .tally import Tally
from .told import Teller, Unheard


def run(request: Request, console: Console, *, trace: bool, record: Path | None, file: Path | None) -> int:
    """Runs the first seed; the exit status."""
    if trace:
        story.plant(console, request.plants.of(request.first))
    try:
        result = _told(request, trace=trace, record=record)
    except KeyboardInterrupt:
        console.print(Text("interrupted", style="yellow"))
        return INTERRUPTED
    except Unheard as unheard:
        raise unheard.error from None
    tally = Tally(setting=request.setting)
    tally.add(result)
    if file is not None:
        summary.write(file, request, tally, None, complete=True)
    story.breach(console, result, request.setting.plant(result.seed).name)
    console.print(Text(f"digest {result.digest}: {report.amount(tally)}"), soft_wrap=True)
    console.print(report.verdict(tally), soft_wrap=True)
    return BROKEN if result.broken else HELD


def _told(request: Request, *, trace: bool, record: Path | None) -> Result:
    with record.open("wb", buffering=0) if record else nullcontext() as file:
        return request.setting.run(request.first, tell=Teller(printed=trace, file=file))
