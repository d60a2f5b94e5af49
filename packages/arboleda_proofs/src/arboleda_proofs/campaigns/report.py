"""Report on a campaign for a person: tables, the amount simulated, and a verdict."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from arboleda.model.counting import counted
from arboleda_proofs.simulator.faults.titles import title
from arboleda_proofs.simulator.findings import Finding
from arboleda_proofs.simulator.people import IN_VAIN

from .screen import WIDEST, ends_of, say_of
from .tally import Tally
from .words import seeds, short

Rows = Sequence[tuple[str, int]]

ONE_COLUMN = 8  # kinds of faults; more are drawn in two, where there is room


def tables(tally: Tally, console: Console) -> Table:
    """The tables of faults by name and outcomes of tasks, side by side, in this console's language."""
    say, end = say_of(console), ends_of(console)
    faults = sorted((say(title(kind)), count) for kind, count in tally.faults.items())
    by_count = sorted(tally.outcomes.items(), key=lambda item: (-item[1], item[0]))
    outcomes = [(end(name), count) for name, count in by_count]
    half = (len(faults) + 1) // 2
    in_two = _beside(faults[:half], faults[half:], outcomes)
    as_wide_as_it_is = console.options.update(max_width=WIDEST)
    if (
        len(faults) > ONE_COLUMN
        and console.measure(in_two, options=as_wide_as_it_is).maximum <= console.width
    ):
        return in_two
    return _beside(faults, [], outcomes)


def _beside(first: Rows, second: Rows, outcomes: Rows) -> Table:
    parts = (("fault", first), ("fault", second), ("task outcome", outcomes))
    beside = Table.grid(padding=(0, 2, 0, 0))
    beside.add_row(*(_counts(heading, counts) for heading, counts in parts if counts))
    return beside


def _counts(heading: str, counts: Rows) -> Table:
    drawn = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    drawn.add_column(heading, no_wrap=True)
    drawn.add_column("count", justify="right", no_wrap=True)
    for name, count in counts:
        drawn.add_row(Text(name), f"{count:,}")
    return drawn


def findings(tally: Tally) -> list[Text]:
    """A line for each finding of a recipe, the most frequent first; then what recipes themselves ask for."""
    lines = [
        Text(f"{each.kind.value} {_times(count)} without any fault: {_where(each)}: {each.sentence}", "red")
        for each, count in _by_count(tally.findings)
    ]
    as_written = [
        Text(f"failed {_times(count)} as the recipe says: {_where(each)}: {each.sentence}", "dim")
        for each, count in _by_count(tally.as_written)
    ]
    return [*lines, *as_written]


def _by_count(counted: Counter[Finding]) -> list[tuple[Finding, int]]:
    return sorted(counted.items(), key=lambda item: (-item[1], item[0].recipe, item[0].step))


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count:,} times"


def _where(finding: Finding) -> str:
    step = f', step "{finding.step}"' if finding.step else ""
    seed = "" if finding.seed is None else f" of seed {finding.seed}"
    return f'recipe {finding.recipe}{step} ({finding.reason}), as in "{finding.task}"{seed}'


def amount(tally: Tally) -> str:
    """The amount simulated: seeds, cycles, faults, the plant's time and that of a seed."""
    done = [seeds(tally.rows), counted(tally.cycles, "cycle"), counted(tally.faults.total(), "fault")]
    each = f", {tally.seconds / len(tally.rows):,.0f} s a seed" if len(tally.rows) > 1 else ""
    return f"{', '.join(done)}, {tally.seconds:,.0f} s of plant time{each}"


def speed(tally: Tally, elapsed_s: float) -> str:
    """The duration of the campaign and its speed."""
    rate = f"{tally.cycles / elapsed_s:,.0f} cycles/s, {tally.seconds / elapsed_s:,.0f} times real time"
    return f"in {elapsed_s:.1f} s ({rate})"


def verdict(tally: Tally) -> Text:
    """The verdict: held, broken, or found."""
    if not tally.rows:
        return Text("no seed came to its end", style="yellow")
    if tally.broken:
        share = f"{counted(len(tally.broken), 'seed')} of {len(tally.rows):,}"
        return Text(f"BROKEN: an invariant did not hold in {share}", style="bold red")
    if tally.findings:
        share = counted(tally.findings.total(), "finding")
        return Text(f"FOUND: {share} in recipes, where nothing had gone wrong", style="bold red")
    if tally.in_vain:
        where = f"{counted(tally.in_vain, 'seed')} of {len(tally.rows):,}"
        why = f"{IN_VAIN} tasks of each cell in a row told no device to do anything in {where}"
        return Text(f"NOTHING TRIED: {why}; look at the outcomes of the tasks", style="bold red")
    checks = f" {short(tally.checks)} checks of" if tally.checks else ""
    return Text(f"HELD:{checks} {counted(len(tally.judged), 'invariant')}", style="bold green")
