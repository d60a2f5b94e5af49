"""Report of a proof for a person: what nobody notices, what broke, and a table for each recipe."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from rich.console import Console
from rich.table import Table
from rich.text import Text

from arboleda.model.counting import counted
from arboleda_proofs.simulator.faults.titles import title

from .. import breach_text
from ..setting import rules
from .calm import Calm
from .checks import Check, tried_checks
from .outcome import MOST_ACTS, End
from .pairs import PairTally
from .proof_tally import Case, ProofTally, Row
from .pytest_file import Breach

SHOWN = (End.DONE, End.RECOVERED, End.HELD, End.FAILED)
MOST_UNNOTICED = 40  # lines
MOVED = "*"  # the end of the same fault is another one at another moment


def calm_lines(calm: Sequence[Calm], *, is_cut: bool = False) -> Iterator[Text]:
    """Findings of the calm runs, in which nothing goes wrong; `is_cut`: the budget left no time for all."""
    if is_cut:
        ran = f"half of --budget was over when {counted(len(calm), 'task')} had run without faults"
        yield Text(f"{ran}: nothing is known of the others; give more", "yellow")
    for each in (each for each in calm if not each.is_sound):
        outcome, name = each.run.outcome, each.scenario.name
        if outcome.broken:
            yield Text(f"{name}: breaks a rule without any fault: {outcome.broken[1]}", "red")
        elif outcome.end is End.UNFINISHED:
            sentence = f"{name}: alone it never ends, it waits for what others do: nothing is proved of it"
            yield Text(f"{sentence}{each.why and f' ({each.why})'}", "yellow")
        else:
            why = each.finding or each.why
            yield Text(f"{name}: {outcome.words} without any fault: {why}", "red")
    for each in (each for each in calm if each.again):
        yield Text(
            f"{each.scenario.name}: once more, without any fault, it is not done: {each.again}", "yellow"
        )


def unnoticed_lines(tally: ProofTally) -> Iterator[Text]:
    """Faults that nobody notices: the task is done, and not all is as it is without them; then the check that
    would notice each.
    """
    found = tally.unnoticed()
    if found:
        yield Text("What nobody notices: the task is done, and this is not so:", "bold yellow")
    for case, count in found[:MOST_UNNOTICED]:
        what = "; ".join(case.outcome.untrue)
        times = f"{counted(count, 'run')}, e.g. {case.instant.name}"
        yield Text(f"  {case.scenario.task}: {_befell(case)}: {what}; {times}", "yellow")
        if (tried := tried_checks(tally.proof, case)) is not None:
            yield Text(f"    {_check_words(tried)}", "dim")
    if len(found) > MOST_UNNOTICED:
        yield Text(f"  and {len(found) - MOST_UNNOTICED} more; --json has all", "yellow")
    untried = sum(tried_checks(tally.proof, case) is None for case, _ in found[:MOST_UNNOTICED])
    if untried:
        yield Text(f"  --budget was over before checks were tried for {untried:,} of these", "dim")


def _befell(case: Case) -> str:
    """Whom a fault befell, and its name: of the kind, as cases of all its forms are counted together."""
    return f"{case.fault.target}: {title(case.fault.kind)}"


def _check_words(found: Sequence[Check]) -> str:
    if not found:
        return "nothing that the cell has would notice it"
    sure = [step for each in found if each.is_sure and not each.behind for step in each.steps]
    between = [each for each in found if each.behind]
    may = [step for each in found if not each.is_sure for step in each.steps]
    words = [f"a step notices it: {', '.join(sure)}"] if sure else []
    words += [f"a step behind step {each.behind}, notices it: {', '.join(each.steps)}" for each in between]
    return "; ".join([*words, *([f"a question may: {', '.join(may)}"] if may else [])])


def unmended_lines(found: Sequence[tuple[Case, int]]) -> Iterator[Text]:
    """Faults after which what the plant advises does not get a cell ready in few acts."""
    if found:
        yield Text(f"What {MOST_ACTS} acts do not mend that the plant advises:", "bold yellow")
    for case, count in found[:MOST_UNNOTICED]:
        acts = "it is never ready" if case.outcome.acts is None else f"it takes {case.outcome.acts} acts"
        times = f"{counted(count, 'run')}, e.g. {case.instant.name}"
        yield Text(f"  {case.scenario.task}: {_befell(case)}: {acts}; {times}", "yellow")
    if len(found) > MOST_UNNOTICED:
        yield Text(f"  and {len(found) - MOST_UNNOTICED} more; --json has all", "yellow")


def story(console: Console, breach: Breach) -> None:
    """Print a breach: its rule, what was seen, the fault, the last seconds before it."""
    name, sentence = breach.run.outcome.broken or ("", "")
    more = f", and {counted(breach.count - 1, 'run')} like it" if breach.count > 1 else ""
    for line, style in (
        (f"{breach.scenario.name} breaks a rule{more}", "bold red"),
        (f"  must hold  {rules().get(name, '')}", ""),
        (f"  was seen   {sentence}", ""),
        (f"  the fault  {breach.befell}", "yellow"),
        (f"  begins     {breach.instant.name}", "yellow"),
    ):
        console.print(Text(line, style=style), soft_wrap=True)
    breach_text.timeline(console, breach.result)


def tables(tally: ProofTally, end: Callable[[str], str], say: Callable[[str], str]) -> Iterator[Table]:
    """A table for each recipe; `end` says a cause, `say` the name of a fault."""
    for (cell, recipe), rows in tally.table().items():
        table = Table(title=f"{cell}: {recipe}", title_justify="left")
        table.add_column("fault", no_wrap=True)
        for head in ("runs", *(end.value for end in SHOWN), "other", "unnoticed", "broken", "alone"):
            table.add_column(head, justify="right")
        table.add_column("causes")
        for kind, row in rows.items():
            table.add_row(say(title(kind)), *_cells(row, end))
        yield table


def _cells(row: Row, end: Callable[[str], str]) -> Iterator[str]:
    shown = [row.ends[end.value] for end in SHOWN]
    yield f"{row.runs:,}"
    for number in (*shown, row.runs - sum(shown), row.unnoticed, row.broken):
        yield f"{number:,}" if number else ""
    yield f"{row.alone / row.runs:.0%}"
    causes = ", ".join(end(cause) for cause, _ in row.causes.most_common())
    yield f"{causes}{f' {MOVED}' if row.changes else ''}".strip()


def pairs_line(pairs: PairTally, breaches: int) -> Text:
    """The line on pairs of faults: how many of all were tried, which is never more than a sample."""
    runs, total = pairs.runs, pairs.pairs.total
    share = f"{runs:,} of {total:,} (a share of {runs / max(total, 1):.2g})"
    of = (
        f"all {total:,}, the most likely first"
        if runs == total
        else f"{share}, the most likely first: a sample"
    )
    found = f"{breaches or 'no'} {'breach' if breaches == 1 else 'breaches'} beyond those of single faults"
    return Text(f"pairs: {of}; {found}", "bold red" if breaches else "yellow")


def verdict(tally: ProofTally, total: int, *, bad_calm: int) -> Text:
    """The last line: what held, of how much."""
    runs, breaches = tally.runs, len(tally.breaches())
    untried = "no fault was tried, as no task comes to its end without one"
    of = f"{runs:,} of {counted(total, 'run')}" if total else untried
    if breaches or bad_calm:
        what = [f"{breaches:,} {'breach' if breaches == 1 else 'breaches'}"] if breaches else []
        what += [f"{counted(bad_calm, 'task')} without any fault"] if bad_calm else []
        return Text(f"BROKEN: {' and '.join(what)}; {of}", "bold red")
    if not runs:
        is_over = total or tally.is_cut
        over = ": --budget was over before the first run with a fault; give more" if is_over else ""
        return Text(f"nothing was run{over}", "bold yellow")
    if not tally.is_whole(total):
        share = f"{runs / total:.0%}"
        sentence = f"HELD in {of} ({share}): a sample, beginnings of steps first; nothing is proven"
        return Text(sentence, "bold yellow")
    kinds = f" of {counted(len(tally.proof.kinds), 'kind')}" if tally.proof.kinds else ""
    held = f"HELD: all {counted(total, 'run')}, every single fault{kinds} at every instant"
    if not tally.proof.is_at_every_instant:
        every = f"{tally.proof.represented:,}"
        held = (
            f"HELD: all {counted(total, 'run')}, every single fault{kinds} at one instant of each class; "
            f"--all-instants tries {every}"
        )
    return Text(held, "bold green")
