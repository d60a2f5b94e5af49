"""Many seeds: runs them, shrinks the first breach, prints the result."""

from __future__ import annotations

import time
from pathlib import Path

from rich.console import Console
from rich.text import Text

from arboleda.model.counting import counted
from arboleda_proofs.simulator.run import Result

from . import breach_text, report, summary
from .campaign import Campaign
from .request import Request
from .screen import ends_of, progress
from .search import ShrunkBreach, shrunk
from .setting import Tick
from .tally import Tally
from .words import short
from .workers import Workers

HELD, BROKEN, INTERRUPTED = 0, 1, 130  # exit statuses


class SeedCampaign:
    """SeedCampaign: a campaign in a terminal; `file` gets its result, `shrunk` is a breach of it."""

    def __init__(self, request: Request, console: Console, file: Path | None) -> None:
        self._request = request
        self._console = console
        self._file = file
        self._tally = Tally(setting=request.setting)
        self._began = time.monotonic()
        self._elapsed_s = 0.0
        self.shrunk: ShrunkBreach | None = None
        self._tick: Tick = lambda: None

    def run(self, jobs: int) -> int:
        """Run all seeds and return the exit status. Ctrl-C ends the campaign with the seeds done so far."""
        status = INTERRUPTED
        try:
            self._simulate(jobs)
            self._shrink()
            status = BROKEN if self._tally.broken or self._tally.findings else HELD
        except KeyboardInterrupt:
            self._say("interrupted; so far:", "yellow")
        self._report()
        if self._file is not None:
            complete = status != INTERRUPTED
            summary.write(self._file, self._request, self._tally, self.shrunk, complete=complete)
        return status

    def _simulate(self, jobs: int) -> None:
        tally, count = self._tally, self._request.count
        try:
            with self._campaign(jobs) as campaign, progress(self._console, "simulating", count) as show:
                self._tick = lambda: show(self._so_far(campaign.minutes), len(tally.rows))
                for result in campaign.results():
                    tally.add(result)
                    if result.broken:
                        self._say(f"seed {result.seed} breaks {result.broken.invariant}", "red")
                    self._tick()
        finally:
            self._elapsed_s = self._since()

    def _campaign(self, jobs: int) -> Campaign[Result]:
        request = self._request
        jobs = jobs if request.count is None else min(jobs, request.count)
        tick, until_failure = lambda: self._tick(), request.until_failure
        if jobs == 1:
            return Campaign(request.setting, request.turn, until_failure=until_failure, tick=tick)
        return Workers(request.setting, request.turn, until_failure=until_failure, tick=tick, jobs=jobs)

    def _so_far(self, minutes: int) -> str:
        tally, count = self._tally, self._request.count
        done = len(tally.rows)
        parts = [
            f"{done:,} of {counted(count, 'seed')}" if count else counted(done, "seed"),
            f"{minutes:,} min",
            counted(tally.cycles, "cycle"),
            f"{tally.cycles / self._since():,.0f}/s",
            counted(tally.faults.total(), "fault"),
            *([f"{short(tally.checks)} checks"] if tally.checks else []),
            *([f"{len(tally.broken)} BROKEN"] if tally.broken else []),
        ]
        return ", ".join(parts)

    def _shrink(self) -> None:
        lowest = self._tally.lowest
        if lowest is None:
            return
        injected = len(lowest.faults)
        with progress(self._console, f"shrinking seed {lowest.seed}", None) as show:
            all_of_them = counted(injected, "fault")
            show(all_of_them, 0)
            self.shrunk = shrunk(
                self._request.setting,
                lowest,
                lambda runs, left: show(f"{left} of {all_of_them} left after {counted(runs, 'run')}", runs),
            )

    def _report(self) -> None:
        tally = self._tally
        if tally.rows:
            self._console.print(report.tables(tally, ends_of(self._console)))
            self._say(f"{report.amount(tally)} {report.speed(tally, self._elapsed_s)}")
        for seed, result in sorted(tally.broken.items()):
            if self.shrunk is not None and self.shrunk.result.seed == seed:
                self._story(self.shrunk, len(result.faults))
            else:
                self._line(seed, result)
        for line in report.findings(tally):
            self._console.print(line, soft_wrap=True)
        self._console.print(report.verdict(tally), soft_wrap=True)

    def _story(self, shrunk: ShrunkBreach, injected: int) -> None:
        result = shrunk.result
        self._say("")
        breach_text.breach(self._console, result, shrunk.plant)
        breach_text.faults(self._console, result, injected)
        breach_text.plant(self._console, shrunk.plant)
        breach_text.timeline(self._console, result)
        self._say(f"  replay     {self._request.replay(result.seed)}", "bold")
        if self._file:
            self._say(f"             {self._request.replay_shrunk(self._file, result.seed)}", "bold")
        self._say("")

    def _line(self, seed: int, result: Result) -> None:
        self._say(f"seed {seed} breaks {result.broken}; replay: {self._request.replay(seed)}", "red")

    def _since(self) -> float:
        return max(time.monotonic() - self._began, 1e-3)

    def _say(self, line: str, style: str = "") -> None:
        self._console.print(Text(line, style=style), soft_wrap=True)
