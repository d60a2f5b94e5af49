"""The command `arboleda simulate`: its options and its exit status."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.text import Text

from arboleda.cli.language import language
from arboleda.cli.plant_options import IN_FOLDER, plant_here
from arboleda.extension import Phrase, say
from arboleda.plant_file.user_file import check_new, check_writable
from arboleda_proofs.campaigns.options import CYCLES, LEVEL, SEED, SEEDS
from arboleda_proofs.simulator.levels import LEVELS

from .options import On

if TYPE_CHECKING:
    from arboleda_proofs.campaigns.request import Request
    from arboleda_proofs.campaigns.screen import SpeakingConsole

HELP = f"""Run whole plants under virtual time, with faults drawn from a seed, and judge every step.

\b
arboleda simulate                            {SEEDS} seeds on the plant of this folder, else on two
arboleda simulate --plant my_plant.yaml      your plant
arboleda simulate --standby                  on two hosts, of which one stands by
arboleda simulate --revisions                whose files are changed while they run
arboleda simulate --until-failure            seed after seed until something breaks
arboleda simulate --seed 4711 --trace        one seed, line by line, the same every time
arboleda simulate --seed 4711 --record seed.mcap  and look at it: arboleda record replay seed.mcap --page
arboleda simulate --seeds 500 --json out.json
arboleda simulate --seeds 9999 --on tcp://laptop:8786  on as many hosts as there are
arboleda simulate --faults out.json --trace  what broke in there, with the faults it takes
arboleda simulate --faults night.yaml        what a plant did: arboleda record export night.yaml
arboleda simulate --faults unlike.yaml       what its devices did: arboleda record unlike --to unlike.yaml

Exit status: 0 every invariant held, 1 one was broken, a task failed where nothing had gone
wrong, or no task did anything, 2 bad input, 130 Ctrl-C; 1 where Ctrl-C ends the search for
fewer faults in a broken seed."""

Plant = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help=f"Plant file. [default: {IN_FOLDER} of this folder, else odd seeds the shipped plant and even"
        " seeds one with shared zones]",
    ),
]
Seed = Annotated[int | None, typer.Option(metavar="N", min=0, help=f"The first seed. [default: {SEED}]")]
Seeds = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        min=1,
        help=f"How many seeds. [default: {SEEDS}; 1 with --trace or --record; no end with --until-failure]",
    ),
]
Cycles = Annotated[
    int,
    typer.Option(metavar="N", min=1, help="How many tasks are ended in each seed, at least."),
]
Faults = Annotated[
    str,
    typer.Option(
        metavar="LEVEL|FILE",
        help=f"How much goes wrong: {', '.join(LEVELS)}; or a file of faults, or one that --json wrote.",
    ),
]
AnyOf = Annotated[
    bool,
    typer.Option(
        "--any-of", help="Have about half of the tasks name several cells, of which the plant chooses one."
    ),
]
Standby = Annotated[
    bool,
    typer.Option(
        "--standby",
        help="Simulate each plant on two hosts and one store, with what befalls those: leaders that are"
        " killed, frozen or cut off, clocks that drift, planned changes.",
    ),
]
Revised = Annotated[
    bool,
    typer.Option(
        "--revisions",
        help="Have engineers change the plant's files while it runs: targets, times, retries, recipes.",
    ),
]
UntilFailure = Annotated[bool, typer.Option("--until-failure", help="End at the first broken invariant.")]
Json = Annotated[
    Path | None, typer.Option("--json", metavar="FILE", help="Write what came of every seed to this file.")
]
Record = Annotated[
    Path | None,
    typer.Option(
        "--record",
        metavar="FILE",
        help="Write one seed: to FILE.mcap as a flight record, else all that happens, an object per line.",
    ),
]
Trace = Annotated[bool, typer.Option("--trace", help="Print all that happens in one seed.")]
Jobs = Annotated[
    int | None,
    typer.Option(metavar="N", min=1, help="How many processes share the seeds. [default: one per processor]"),
]

Worker = Annotated[bool, typer.Option("--worker", hidden=True)]  # and --store, for one minor version
Store = Annotated[str, typer.Option("--store", hidden=True)]
DrawnPlants = Annotated[bool, typer.Option("--drawn-plants", hidden=True)]
KeepPlant = Annotated[Path | None, typer.Option("--keep-plant", hidden=True)]
FOR_DEVELOPERS = Phrase(
    "cli.simulate.for_developers",
    "drawn plants, --drawn-plants and --keep-plant are for developers of Arboleda, in a clone of its"
    " repository: type tools/drawn-plants instead of arboleda simulate, or make drawn-campaign",
)
WORKERS_GONE = Phrase(
    "cli.simulate.workers_gone",
    "--worker and --store are gone: start `dask scheduler`, and `dask worker` on each host, then type"
    " arboleda simulate --on tcp://HOST:8786; see docs/how-to/several-hosts.md",
)
ON_ALONE = Phrase(
    "cli.simulate.on_alone",
    "--on has the workers of other hosts run many seeds: not with --jobs, --trace, --record",
)


@dataclass(frozen=True, kw_only=True)
class Output:
    """Output of a simulation: the console, and the files that are written."""

    console: SpeakingConsole
    json: Path | None
    record: Path | None
    trace: bool

    @property
    def is_of_one_seed(self) -> bool:
        """True if all that happens in one seed is shown."""
        return self.trace or self.record is not None

    def begin(self, request: Request) -> None:
        """Print the notes on a request; raises an error if it is refused, or a file cannot be written."""
        from arboleda_proofs.campaigns.flight import SUFFIX

        _refuse(request)
        if self.json is not None:
            check_writable(self.json)
        if self.record is not None:
            (check_new if self.record.suffix == SUFFIX else check_writable)(self.record)
        for note in request.notes:
            self.console.print(Text(note, style="dim"), soft_wrap=True)


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command("simulate", help=HELP, short_help=HELP.partition("\n")[0])(simulate)


def simulate(
    plant: Plant = None,
    seed: Seed = None,
    seeds: Seeds = None,
    cycles: Cycles = CYCLES,
    faults: Faults = LEVEL,
    any_of: AnyOf = False,
    standby: Standby = False,
    revisions: Revised = False,
    until_failure: UntilFailure = False,
    json: Json = None,
    record: Record = None,
    trace: Trace = False,
    jobs: Jobs = None,
    on: On = None,
    worker: Worker = False,
    store: Store = "",
    drawn_plants: DrawnPlants = False,
    keep_plant: KeepPlant = None,
) -> None:
    if drawn_plants or keep_plant is not None:
        raise typer.BadParameter(say(FOR_DEVELOPERS()))
    if worker or store:
        raise typer.BadParameter(say(WORKERS_GONE()))
    output = Output(console=_loaded(), json=json, record=record, trace=trace)
    from arboleda_proofs.campaigns.request import Request

    request = Request(
        plant=plant,
        plant_here=plant_here(None),
        seed=seed,
        seeds=seeds,
        one_seed=output.is_of_one_seed,
        cycles=cycles,
        faults=faults,
        until_failure=until_failure,
        any_of=any_of,
        standby=standby,
        revises=revisions,
    )
    raise typer.Exit(_run(request, output, jobs, on))


def _loaded() -> SpeakingConsole:
    """The console, with the simulator loaded: that takes a second or two, and only this command needs it."""
    from arboleda_proofs.campaigns import screen

    console = screen.console(language=language())
    with screen.waiting(console, "loading the simulator"):
        import_module("arboleda_proofs.campaigns.seed_campaign")
    return console


def _refuse(request: Request) -> None:
    """Raises BadParameter for options that exclude each other, and for a file of a drawn plant."""
    if request.exclusion is not None:
        raise typer.BadParameter(say(request.exclusion()))
    if request.faults_file is not None and "plant_file" in request.faults_file.broken:
        raise typer.BadParameter(say(FOR_DEVELOPERS()))


def _run(request: Request, output: Output, jobs: int | None, on: str | None) -> int:
    """Run the seeds, here or on the workers of a scheduler; the exit status."""
    from arboleda_proofs.campaigns import single_seed
    from arboleda_proofs.campaigns.crews import crew
    from arboleda_proofs.campaigns.seed_campaign import SeedCampaign

    if on is not None and (request.one_seed or jobs is not None):
        raise typer.BadParameter(say(ON_ALONE()))
    output.begin(request)
    console, json = output.console, output.json
    if request.one_seed:
        return single_seed.run(request, console, trace=output.trace, record=output.record, file=json)
    with crew(jobs, on, console) as those:
        return SeedCampaign(request, console, json).run(those)
