"""A campaign that workers on any number of hosts share: its seeds are rows of a database."""

from __future__ import annotations

import hashlib
import json
import time
from collections import Counter
from pathlib import Path

from rich.console import Console
from rich.text import Text

from arboleda import __version__
from arboleda.extension import ArboledaError, StartError
from arboleda.model.counting import counted
from arboleda.store.schemes import databases
from arboleda.store.seeds import SeedRow
from arboleda_proofs.simulator.levels import LEVELS

from . import report
from .request import Request
from .seed_campaign import BROKEN, HELD, INTERRUPTED
from .tally import Tally

LOOK_S = 1.0  # between two looks for a seed that a worker has given back


def campaign_of(request: Request) -> str:
    """The name of a campaign, made of its options, so that workers with other options have another one."""
    faults = "" if request.faults in LEVELS else Path(request.faults).read_text(encoding="utf-8")
    files = (each.files.contents for each in request.listed)
    contents = [{name: text.hex() for name, text in each.items()} for each in files]
    identity = [__version__, request.first, request.count, request.cycles, request.faults, faults, contents]
    identity += [request.any_of, request.two_hosts]
    identity += [True] if request.changes_files else []  # else the same as before there were any
    return hashlib.sha256(json.dumps(identity).encode()).hexdigest()[:16]


def work(request: Request, console: Console, store: str, file: Path | None) -> int:
    """Run seeds until all of the campaign are done, by any worker; the exit status."""
    if request.count is None:
        raise StartError("workers share a number of seeds: say how many with --seeds")
    began, mine, name = time.monotonic(), 0, campaign_of(request)
    rows = databases(store).seeds(store, name)
    try:
        rows.lay_out(request.first, request.count)
        console.print(Text(f"campaign {name}: {counted(request.count, 'seed')}", style="dim"))
        while True:
            row = rows.do_next(lambda seed: _run(request, seed))
            if row is not None:
                mine += 1
                if row.broken:
                    _say(console, f"seed {row.seed} breaks {row.broken}")
            elif all(each.digest is not None for each in rows.rows()):
                break
            else:
                time.sleep(LOOK_S)
        done = rows.rows()
    except KeyboardInterrupt:
        _say(
            console,
            f"interrupted after {counted(mine, 'seed')}; another worker does what was under way",
        )
        return INTERRUPTED
    finally:
        rows.close()
    _report(request, console, done, mine, time.monotonic() - began)
    if file is not None:
        _write(file, name, done)
    return BROKEN if any(row.broken for row in done) else HELD


def _run(request: Request, seed: int) -> SeedRow:
    result = request.setting.run(seed)
    tally = Tally(setting=request.setting)
    tally.add(result)
    found = "; ".join(map(str, report.findings(tally))) if result.findings else None
    found = str(report.verdict(tally)) if result.in_vain and found is None else found
    broken = found if result.broken is None else str(result.broken)
    return SeedRow(seed=seed, digest=result.digest, broken=broken, cycles=result.cycles)


def _report(request: Request, console: Console, done: list[SeedRow], mine: int, seconds: float) -> None:
    by_worker = Counter(row.worker for row in done)
    broken = [row for row in done if row.broken]
    for row in broken:
        _say(console, f"seed {row.seed} breaks {row.broken}; replay: {request.replay(row.seed)}")
    cycles = sum(row.cycles or 0 for row in done)
    console.print(
        Text(
            f"{counted(len(done), 'seed')} by {counted(len(by_worker), 'worker')}, {mine:,} of them here in"
            f" {seconds:.0f} s; {cycles:,} cycles"
        )
    )
    verdict = f"BROKEN: {counted(len(broken), 'seed')}" if broken else "HELD: every seed"
    console.print(Text(verdict, style="bold red" if broken else "bold green"))


def _write(file: Path, campaign: str, done: list[SeedRow]) -> None:
    text = json.dumps({"campaign": campaign, "seeds": [vars(row) for row in done]}, indent=1)
    try:
        file.write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise ArboledaError(f"{file}: cannot be written: {error.strerror}") from None


def _say(console: Console, line: str) -> None:
    console.print(Text(line, style="yellow"), soft_wrap=True)
