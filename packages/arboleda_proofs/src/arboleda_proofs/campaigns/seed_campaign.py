"""Many seeds: runs them, shrinks the first breach, prints the result."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from rich.console import Console
from rich.text import Text

from arboleda.model.counting import counted
from arboleda_proofs.simulator.run import Result

from . import breach_text, report, summary
from .campaign import Batch, Campaign, Crew, SoFar, Tick
from .request import Request
from .screen import FIRST_S, progress
from .search import ShrunkBreach, shrunk
from .setting import rules
from .tally import Tally
from .words import short

HELD, BROKEN, INTERRUPTED = 0, 1, 130  # exit statuses


class SeedCampaign:
    """SeedCampaign: a campaign in a terminal; `file` gets its result, `shrunk` is a breach of it."""

    def __init__(
        self,
        request: Request,
        console: Console,
        file: Path | None,
        *,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._request = request
        self._console = console
        self._file = file
        self._tally = Tally(setting=request.setting)
        self._clock = clock
        self._began = clock()
        self._elapsed_s = 0.0
        self.shrunk: ShrunkBreach | None = None
        self._tick: Tick = lambda: None

    def run(self, crew: Crew) -> int:
        """Run all seeds and return the exit status. Ctrl-C ends the campaign with the seeds done so far, or
        with the fewest faults so far that break one.
        """
        status = INTERRUPTED
        try:
            self._simulate(crew)
            self._shrink(crew)
            status = HELD if self._tally.holds else BROKEN
        except KeyboardInterrupt:
            self._say("interrupted; so far:", "yellow")
        self._report()
        if self._file is not None:
            complete = status != INTERRUPTED and (self.shrunk is None or self.shrunk.complete)
            summary.write(self._file, self._request, self._tally, self.shrunk, complete=complete)
        return status

    def _simulate(self, crew: Crew) -> None:
        tally, count = self._tally, self._request.count
        try:
            with (
                self._campaign(crew) as campaign,
                progress(self._console, "simulating", count, first_s=FIRST_S, clock=self._clock) as show,
            ):
                self._tick = lambda: show(self._so_far(campaign.so_far), len(tally.rows))
                for result in campaign.results():
                    tally.add(result)
                    if result.broken:
                        self._say(f"seed {result.seed} breaks {result.broken.invariant}", "red")
                    self._tick()
        finally:
            self._elapsed_s = self._since()

    def _campaign(self, crew: Crew) -> Campaign[Result]:
        request = self._request
        batch = Batch(
            runs=request.setting,
            seeds=request.turn,
            tick=lambda: self._tick(),
            plants=request.listed,
            until_failure=request.until_failure,
        )
        return crew.campaign(batch)

    def _so_far(self, passed: SoFar) -> str:
        tally, count = self._tally, self._request.count
        done = len(tally.rows)
        parts = [
            f"{done:,} of {counted(count, 'seed')}" if count else counted(done, "seed"),
            f"{passed.minutes:,} min",
            *([f"{tally.seconds / done:,.0f} s of plant time a seed"] if done else []),
            counted(passed.cycles, "cycle"),
            f"{passed.cycles / self._since():,.0f}/s",
            counted(passed.faults, "fault"),
            *([f"{short(tally.checks)} checks"] if tally.checks else []),
            *([f"{len(tally.broken)} BROKEN"] if tally.broken else []),
        ]
        return ", ".join(parts)

    def _shrink(self, crew: Crew) -> None:
        lowest = self._tally.lowest
        if lowest is None:
            return
        runs, best = 0, lowest
        doing = f"shrinking seed {lowest.seed}"
        with progress(self._console, doing, None, first_s=FIRST_S, forks=True, clock=self._clock) as show:

            def tick() -> None:
                show(self._shrunk_so_far(lowest, runs, best), runs)

            def better(runs_so_far: int, best_so_far: Result) -> None:
                nonlocal runs, best
                runs, best = runs_so_far, best_so_far
                tick()

            tick()
            self.shrunk = shrunk(self._request.setting, lowest, better, tick=tick, crew=crew)
        if not self.shrunk.complete:
            self._say("interrupted; the fewest faults so far:", "yellow")

    def _shrunk_so_far(self, broken: Result, runs: int, best: Result) -> str:
        assert broken.broken is not None
        plant = self._request.plants.of(broken.seed)
        must_hold = rules(plant).get(broken.broken.invariant, broken.broken.invariant)
        drawn, few = counted(len(broken.faults), "fault"), len(best.faults)
        return f"{drawn} to {few} so far, {counted(runs, 'run')}, still breaks: {must_hold}"

    def _report(self) -> None:
        tally = self._tally
        if tally.rows:
            self._console.print(report.tables(tally, self._console))
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
        return max(self._clock() - self._began, 1e-3)

    def _say(self, line: str, style: str = "") -> None:
        self._console.print(Text(line, style=style), soft_wrap=True)
