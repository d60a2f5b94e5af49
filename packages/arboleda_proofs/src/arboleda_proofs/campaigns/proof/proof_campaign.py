"""Proof in a terminal: calm runs, then every portion within the budget, then the answer."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from typing import TypeVar

from rich.console import Console
from rich.text import Text

from arboleda.host.packages import extra
from arboleda.model.counting import counted
from arboleda.model.packages import MAKE
from arboleda.plant_check.check_answer import CheckAnswer

from ..campaign import Batch, Campaign, Crew, Runs
from ..plant_notes import notes
from ..screen import Show, ends_of, print_whole, progress, say_of
from ..seed_campaign import BROKEN, HELD, INTERRUPTED
from ..workers import Processes
from . import equal_cells, proof_report, proof_summary
from .badge import badge
from .breaches import breaches_of
from .calm import Calm, calm_runs, run_findings
from .checks import checks
from .forecast import Forecast
from .junit import as_junit
from .kept import Kept
from .outcome import End
from .page import ProofPage, page
from .pairs import PairProof, PairTally
from .proof import Proof, Proved
from .proof_lines import ProofLines
from .proof_request import ProofRequest
from .proof_tally import ProofTally
from .pytest_file import Breach, as_tests
from .recipe_digest import recipe_digests
from .scenario import Scenario, scenarios
from .single_faults import possible_kinds
from .spent import Spent

MEND_S = 120.0  # a mend is looked for so long
CALM_SHARE = 0.5  # of the budget, in which runs without faults begin
RUNS_SHARE = 0.95  # of the budget, in which runs begin; the rest is for checks of what nobody notices
LATE_S = 1.0  # after the budget, when runs that have begun are given up
Work = TypeVar("Work")
NOTHING_RUN = 2  # exit status: of nothing it cannot be said that it held


class _BudgetOver(Exception):
    """Raised where runs that have begun would go on for long after the budget."""


class ProofCampaign:
    """ProofCampaign: proves a plant in a terminal, and writes what is asked for."""

    def __init__(self, request: ProofRequest, console: Console, lines: ProofLines | None = None) -> None:
        self._request = request
        self._console = console
        self._lines = lines or ProofLines(None)
        self._plant, self._seen = request.simulated, request.seen
        self._calm: list[Calm] = []
        self._tally = ProofTally(proof=Proof(model=self._plant.model))
        self._pairs: PairTally | None = None
        self._tasks = 0  # of all recipes, before any answer leads elsewhere
        self._is_cut = False  # the budget left no time for all tasks without faults
        self._known = 0  # runs that were kept from before
        self._total = 0
        self._crew: Crew = Processes(1)
        self._simulated_s = 0.0  # without faults
        self._spent = Spent()  # by runs with faults, but for those that were kept
        self._began, self._began_work = time.monotonic(), time.process_time()

    def run(self, crew: Crew) -> int:
        """Prove, and return the exit status. Ctrl-C ends it with what was done so far."""
        self._crew = crew
        for note in notes([self._plant]):
            self._say(note, "dim")
        status = INTERRUPTED
        try:
            self._run_calmly()
            self._prove()
            if self._request.pairs:
                self._prove_pairs()
            held = HELD if self._tally.runs else NOTHING_RUN
            status = BROKEN if self._bad_calm or self._breaks else held
        except KeyboardInterrupt:
            self._say("interrupted; so far:", "yellow")
        self._report(complete=status != INTERRUPTED)
        return status

    @property
    def _breaks(self) -> bool:
        return bool(self._tally.breaches() or (self._pairs and self._pairs.breaches(frozenset())))

    @property
    def _bad_calm(self) -> int:
        """The tasks that break or fail where nothing goes wrong; those that wait for others do neither."""
        bad = (each.run.outcome for each in self._calm if not each.is_sound)
        return sum(outcome.broken is not None or outcome.end is not End.UNFINISHED for outcome in bad)

    def _run_calmly(self) -> None:
        found = [*scenarios(self._plant.model, self._request.recipes)]
        self._tasks = len(found)
        self._say(self._outset(found))
        doing, self._began_work = "running without faults", time.process_time()
        with progress(self._console, doing, None) as show, self._lines.progress(doing) as tell:
            for calm in self._within(CALM_SHARE, calm_runs(self._plant.model, found)):
                self._calm.append(calm)
                self._simulated_s += calm.run.seconds + calm.lasts_s
                show(counted(len(self._calm), "task"), len(self._calm))
                tell(len(self._calm), None)

    def _outset(self, found: Sequence[Scenario]) -> str:
        """Words for what is known of the work before anything has run, so the same each time."""
        recipes = counted(len({(each.cell, each.recipe) for each in found}), "recipe")
        kinds = counted(len(self._request.kinds or possible_kinds()), "kind")
        return f"{recipes}, {counted(len(found), 'task')}, {kinds} of fault; first each task without faults"

    def _proof(self) -> Proof:
        sound = tuple(each for each in self._calm if each.is_sound)
        request = self._request
        return Proof(
            model=self._plant.model,
            calm=sound,
            kinds=request.kinds,
            every=request.every,
            seen=self._seen,
        )

    def _forecast(self, proof: Proof, kept: int = 0) -> Forecast:
        pace = (time.process_time() - self._began_work) / max(self._simulated_s, 1.0)
        left_s = self._request.budget_s - (time.monotonic() - self._began)
        return Forecast(
            proof=proof,
            share=self._share_to_come,
            pace=pace,
            jobs=self._crew.jobs,
            budget_s=max(left_s, 0.0),
            kept=kept,
        )

    @property
    def _share_to_come(self) -> float:
        """The number of all tasks for each one that has run without faults: what is planned is of all."""
        ran = len({(each.scenario.cell, each.scenario.task) for each in self._calm})
        return self._tasks / ran if self._is_cut and ran else 1.0

    def _prove(self) -> None:
        proof = self._proof()
        kept = Kept(self._request.folder, recipe_digests(self._plant.model, self._request.files), proof)
        kept.forget(all=self._request.anew)
        self._tally = ProofTally(proof=proof, proved=kept.known(), is_cut=self._is_cut)
        self._total = round(proof.total * self._share_to_come)
        if self._total:
            self._say(self._forecast(proof, self._tally.runs).words)
        self._run(proof, range(len(proof.portions)), self._tally, kept, total=self._total)

    def _prove_pairs(self) -> None:
        pairs = PairProof(proof=self._tally.proof)
        kept = Kept(self._request.folder, recipe_digests(self._plant.model, self._request.files), pairs)
        self._pairs = PairTally(pairs=pairs, proved=kept.known())
        self._run(pairs, pairs.numbers(), self._pairs, kept, total=pairs.total)

    def _run(
        self,
        proof: Runs[Proved],
        numbers: Iterable[int],
        tally: ProofTally | PairTally,
        kept: Kept,
        *,
        total: int,
    ) -> None:
        """Run the portions of these numbers that are not in the tally, as long as the budget lasts."""
        known = tally.runs
        self._known += known
        waiting = (number for number in numbers if number not in tally.proved)
        name = "proving" if tally is self._tally else "proving pairs"
        with (
            progress(self._console, name, total) as show,
            self._lines.progress(name) as tell,
            suppress(_BudgetOver),
            self._campaign(proof, self._within(RUNS_SHARE, waiting), (known, total), show) as campaign,
        ):
            tell(known, total)
            for proved in campaign.results():
                tally.proved[proved.number] = proved
                self._spent.add(proved.spent or Spent())
                kept.keep(proved)
                tell(tally.runs, total)
                if isinstance(proof, Proof):
                    self._lines.broken(proof, proved)
        if kept.trouble is not None:
            self._say(f"not all is kept for the next time: {kept.trouble}", "yellow")

    def _campaign(
        self, proof: Runs[Proved], numbers: Iterator[int], so_far: tuple[int, int], show: Show
    ) -> Campaign[Proved]:
        began, (known, total) = time.monotonic(), so_far

        def tick() -> None:
            seconds = max(time.monotonic() - began, 1e-3)
            show(_progress(known, campaign.minutes, total, seconds), known + campaign.minutes)
            if time.monotonic() - self._began > self._request.budget_s + LATE_S:
                raise _BudgetOver

        # one ahead: none begins after the budget
        batch = Batch(runs=proof, seeds=numbers, tick=tick, plants=(self._plant,), ahead=1)
        campaign = self._crew.campaign(batch)
        return campaign

    def _within(self, share: float, work: Iterable[Work]) -> Iterator[Work]:
        """The pieces of work that begin within a share of the budget, and the first one in any case.

        A piece begins when it is asked for.
        """
        over_s, pieces, is_first = self._request.budget_s * share, iter(work), True
        while time.monotonic() - self._began < over_s or (is_first and over_s > 0.0):
            try:
                yield next(pieces)
            except StopIteration:
                return
            is_first = False
        self._is_cut |= share == CALM_SHARE

    def _report(self, *, complete: bool) -> None:
        tally, breaches = self._tally, breaches_of(self._tally, self._pairs)
        self._try_checks()
        for line in proof_report.calm_lines(self._calm, is_cut=self._is_cut):
            self._console.print(line, soft_wrap=True)
        for line in proof_report.unnoticed_lines(tally):
            self._console.print(line, soft_wrap=True)
        for line in proof_report.unmended_lines(tally.unmended()):
            self._console.print(line, soft_wrap=True)
        for table in proof_report.tables(tally, ends_of(self._console), say_of(self._console)):
            print_whole(self._console, table)
        for breach in breaches:
            proof_report.story(self._console, breach)
        for note in equal_cells.notes(self._plant.model):
            self._say(note)
        self._say(self._amount())
        if self._spent.runs:
            self._say(self._spent.words, "dim")
        if self._pairs is not None:
            line = proof_report.pairs_line(self._pairs, sum(each.then is not None for each in breaches))
            self._console.print(line, soft_wrap=True)
        self._console.print(proof_report.verdict(tally, self._total, bad_calm=self._bad_calm), soft_wrap=True)
        answer = self._answer()
        if answer.mend is not None:
            self._say(f"would mend it: {answer.mend.words}", "green")
        self._write(breaches, answer, complete=complete)

    def _answer(self) -> CheckAnswer:
        """The findings of the runs without faults; where it is wanted, with what would mend them, or notice
        what nobody notices."""
        findings = tuple(each for calm in self._calm for each in run_findings(calm))
        plant = self._request.plant
        if plant is None or not self._request.mend:
            return CheckAnswer(findings=findings)
        with progress(self._console, "looking for a mend", None):
            if findings:
                mend = extra("mend", MAKE, "--mend")(plant, findings, within_s=MEND_S)
            else:
                mend = extra("notice", MAKE, "--mend")(plant, self._tally, within_s=MEND_S)
            return CheckAnswer(findings=findings, mend=mend)

    def _try_checks(self) -> None:
        """Try the checks of what nobody notices and will be named, in time; a check takes a few runs."""
        is_whole = self._request.html or self._request.json or self._console.quiet
        found = self._tally.unnoticed()[: None if is_whole else proof_report.MOST_UNNOTICED]
        with progress(self._console, "trying checks", len(found)) as show:
            for number, (case, _) in enumerate(self._within(1.0, found), start=1):
                checks(self._tally.proof, case)
                show(f"{number:,} of {len(found):,}", number)

    def _amount(self) -> str:
        runs, seconds = (
            self._tally.runs + (self._pairs.runs if self._pairs else 0),
            time.monotonic() - self._began,
        )
        kept = f", {self._known:,} of them kept from before" if self._known else ""
        alone = (
            f"; after {self._tally.alone:.1%} the cell got ready again without a person{self._acts}"
            if runs
            else ""
        )
        return f"{counted(runs, 'run')}{kept} in {seconds:,.0f} s{alone}"

    @property
    def _acts(self) -> str:
        most = self._tally.most_acts
        return f", after all others with at most {counted(most, 'act')} of one" if most else ""

    def _write(self, breaches: list[Breach], mended: CheckAnswer, *, complete: bool) -> None:
        request = self._request
        answer = proof_summary.summary(
            request.plant,
            self._calm,
            self._tally,
            breaches,
            self._total,
            complete=complete and not self._is_cut,
            pairs=self._pairs,
            mended=mended,
        )
        self._lines.answer(answer)
        if request.json is not None:
            proof_summary.write(request.json, proof_summary.as_json(answer))
        if request.html is not None:
            shown = ProofPage(
                name=self._plant.name,
                plant=request.plant,
                calm=self._calm,
                tally=self._tally,
                breaches=breaches,
                total=self._total,
                pairs=self._pairs,
            )
            proof_summary.write(request.html, page(shown))
        if request.junit is not None:
            proof_summary.write(request.junit, as_junit(self._calm, self._tally, breaches))
        if request.badge is not None:
            broken = bool(breaches or self._bad_calm)
            proof_summary.write(request.badge, badge(self._tally, self._total, broken=broken))
        if request.tests is not None and breaches:
            proof_summary.write(request.tests, as_tests(breaches, request.plant))
            self._say(f"{request.tests} has {counted(len(breaches), 'test')}")
        elif request.tests is not None and not request.tests.read_bytes():
            request.tests.unlink()  # it was made to see whether that is possible

    def _say(self, line: str, style: str = "") -> None:
        self._console.print(Text(line, style=style), soft_wrap=True)


def _progress(known: int, runs: int, total: int, seconds: float) -> str:
    done, rate = known + runs, runs / seconds
    left = (total - done) / rate if rate else math.inf
    ends = f", {left / 60:,.0f} min left for all" if math.isfinite(left) else ""
    return f"{done:,} of {counted(total, 'run')}, {rate:,.0f}/s{ends}"
