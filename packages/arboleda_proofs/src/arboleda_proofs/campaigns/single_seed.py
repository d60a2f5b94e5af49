"""One seed, line by line as it happens: printed, recorded or both; the same every time."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

from rich.console import Console
from rich.text import Text

from arboleda_proofs.simulator.run import Result

from . import breach_text, flight, report, summary
from .line_output import LineWriter, OutputLost
from .request import Request
from .seed_campaign import BROKEN, HELD, INTERRUPTED
from .tally import Tally


def run(request: Request, console: Console, *, trace: bool, record: Path | None, file: Path | None) -> int:
    """Run the first seed and return the exit status."""
    if trace:
        breach_text.plant(console, request.plants.of(request.first))
    flown: list[str] = []
    try:
        if record is not None and record.suffix == flight.SUFFIX:
            result = _flown(request, trace=trace, record=record, lines=flown)
        else:
            result = _run(request, trace=trace, record=record)
    except KeyboardInterrupt:
        console.print(Text("interrupted", style="yellow"))
        return INTERRUPTED
    except OutputLost as unheard:
        raise unheard.error from None
    tally = Tally(setting=request.setting)
    tally.add(result)
    if file is not None:
        summary.write(file, request, tally, None, complete=True)
    breach_text.breach(console, result, request.plants.of(result.seed))
    for line in flown:
        console.print(Text(line), soft_wrap=True)
    console.print(Text(f"digest {result.digest}: {report.amount(tally)}"), soft_wrap=True)
    for finding in report.findings(tally):
        console.print(finding, soft_wrap=True)
    console.print(report.verdict(tally), soft_wrap=True)
    return HELD if tally.holds else BROKEN


def _flown(request: Request, *, trace: bool, record: Path, lines: list[str]) -> Result:
    """Run the seed with a flight record; `lines` gets a line for each file."""
    tell = LineWriter(printed=True, file=None) if trace else None
    with flight.recorded(record, request.plants.of(request.first)) as flown:
        result = request.setting.run(request.first, tell=tell, make_plant=flown.make_plant)
    lines += flown.lines
    return result


def _run(request: Request, *, trace: bool, record: Path | None) -> Result:
    with record.open("wb", buffering=0) if record else nullcontext() as file:
        return request.setting.run(request.first, tell=LineWriter(printed=trace, file=file))
