"""The command `arboleda prove`: its options and its exit status."""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path
from typing import Annotated

import typer

from arboleda.cli.language import language
from arboleda.cli.plant_options import folder
from arboleda.extension import Phrase, PlantFile, StateFolder, say
from arboleda.host.packages import extra
from arboleda.model.packages import MAKE
from arboleda.plant_file.user_file import check_writable

from .options import On

BUDGET = "10m"
HELP = f"""Try every single fault at every kind of moment of every recipe, and judge each run.

\b
arboleda prove                          the plant of this folder, for {BUDGET}
arboleda prove --plant my_plant.yaml    your plant; what is kept is not run again
arboleda prove --recipe weigh --budget all
arboleda prove --faults unlike.yaml     and what real devices did: arboleda record unlike --to unlike.yaml
arboleda prove --budget all --on tcp://laptop:8786  on as many hosts as there are
arboleda prove --html out.html --tests test_found.py

Each recipe runs once without faults, for each class of parameters and each answer that can lead elsewhere.
Then each kind of fault begins before and after each event of that run, and in the middle between two,
one run each. Of moments at which it would meet the same it begins at one. One fault of each kind at each
kind of step comes first, so that a short budget is spent well.

Exit status: 0 every invariant held, 1 one was broken, or a task failed where nothing had
gone wrong, 2 bad input or nothing was run, 130 Ctrl-C."""
BUDGETS = re.compile(r"(\d+(?:\.\d+)?)(s|m|h)")
SECONDS = {"s": 1.0, "m": 60.0, "h": 3600.0}
ALL = "all"

Recipes = Annotated[
    list[str] | None,
    typer.Option("--recipe", metavar="NAME", help="Only this recipe; may be given several times."),
]
Faults = Annotated[
    list[str] | None,
    typer.Option("--fault", metavar="KIND", help="Only this kind of fault; may be given several times."),
]
Seen = Annotated[
    Path | None,
    typer.Option(
        "--faults", metavar="FILE", help="Try also what devices did: arboleda record unlike --to FILE."
    ),
]
Budget = Annotated[
    str,
    typer.Option(
        metavar="TIME", help="Begin no more runs after so long: 30s, 10m, 2h; all: until everything is run."
    ),
]
Json = Annotated[
    Path | None,
    typer.Option(
        "--json",
        metavar="FILE",
        help="Write the whole answer; -: print progress, then the answer, as lines of JSON and nothing else.",
    ),
]
Html = Annotated[
    Path | None,
    typer.Option("--html", metavar="FILE", help="Write the answer as one page, in English and Spanish."),
]
JUnit = Annotated[
    Path | None, typer.Option("--junit", metavar="FILE", help="Write it as JUnit XML, for a CI server.")
]
Tests = Annotated[
    Path | None, typer.Option("--tests", metavar="FILE", help="Write a pytest for each invariant that broke.")
]
Badge = Annotated[
    Path | None, typer.Option("--badge", metavar="FILE", help="Write a badge as SVG, for one's own README.")
]
Anew = Annotated[bool, typer.Option("--anew", help="Run again also what was run before.")]
AllInstants = Annotated[
    bool,
    typer.Option(
        "--all-instants", help="Try each fault at every instant; else at one of those that are alike for it."
    ),
]
Pairs = Annotated[
    bool,
    typer.Option(
        "--pairs",
        help="Then try two faults in one run, the most likely ones first, for the rest of the budget.",
    ),
]
Mend = Annotated[
    bool,
    typer.Option(
        "--mend",
        help="Then look for a change of the files that mends what is found: each is tried, for some minutes.",
    ),
]
Jobs = Annotated[
    int | None,
    typer.Option(metavar="N", min=1, help="How many processes share the runs. [default: one per processor]"),
]
PAIRS_TAKE = Phrase(
    "cli.prove.pairs_take", "--pairs: all pairs take years; give a --budget that is a time, not {all}"
)
ON_OR_JOBS = Phrase("cli.prove.on_or_jobs", "--on has workers of other hosts do the runs: leave out --jobs")
NO_BUDGET = Phrase("cli.prove.no_budget", "--budget: {budget} is no time; write 30s, 10m, 2h or {all}")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command("prove", help=HELP, short_help=HELP.partition("\n")[0])(prove)


def prove(
    plant: PlantFile = None,
    recipe: Recipes = None,
    fault: Faults = None,
    faults: Seen = None,
    budget: Budget = BUDGET,
    json: Json = None,
    html: Html = None,
    junit: JUnit = None,
    tests: Tests = None,
    badge: Badge = None,
    all_instants: AllInstants = False,
    pairs: Pairs = False,
    mend: Mend = False,
    anew: Anew = False,
    jobs: Jobs = None,
    on: On = None,
    state: StateFolder = None,
) -> None:
    from arboleda_proofs.campaigns import screen  # the simulator takes a while to load
    from arboleda_proofs.campaigns.crews import crew
    from arboleda_proofs.campaigns.proof.proof_campaign import ProofCampaign
    from arboleda_proofs.campaigns.proof.proof_lines import STANDARD_OUTPUT, ProofLines
    from arboleda_proofs.campaigns.proof.proof_request import ProofRequest

    is_read_along = json is not None and str(json) == STANDARD_OUTPUT
    json = None if is_read_along else json
    for file in (json, html, junit, tests, badge):
        if file is not None:
            check_writable(file)
    if pairs and budget == ALL:
        raise typer.BadParameter(say(PAIRS_TAKE(all=ALL)))
    if on is not None and jobs is not None:
        raise typer.BadParameter(say(ON_OR_JOBS()))
    if mend:  # it is asked for at the end: a package that is missing is named before
        extra("mend", MAKE, "--mend")
    request = ProofRequest(
        plant=plant,
        recipes=tuple(recipe or ()),
        kinds=tuple(fault or ()),
        budget_s=seconds_of(budget),
        folder=folder(plant, state) / "prove",
        anew=anew,
        every=all_instants,
        faults=faults,
        pairs=pairs,
        mend=mend,
        json=json,
        html=html,
        junit=junit,
        tests=tests,
        badge=badge,
    )
    lines = ProofLines(sys.stdout if is_read_along else None)
    console = screen.console(language=language(), quiet=is_read_along)
    with crew(jobs, on, console) as those:
        raise typer.Exit(ProofCampaign(request, console, lines).run(those))


def seconds_of(budget: str) -> float:
    """The seconds of a budget as people write it."""
    if budget == ALL:
        return math.inf
    found = BUDGETS.fullmatch(budget)
    if found is None:
        raise typer.BadParameter(say(NO_BUDGET(budget=repr(budget), all=ALL)))
    return float(found[1]) * SECONDS[found[2]]
