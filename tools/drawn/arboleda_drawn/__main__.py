"""Draws a plant from each seed, runs it under virtual time with faults, and judges every step.

tools/drawn-plants --seeds 500 --json drawn.json
tools/drawn-plants --seed 4711 --trace             one seed, line by line, the same every time
tools/drawn-plants --faults drawn.json --trace     what broke in there: the plant and the faults it takes

Exit status as of `arboleda simulate`.
"""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.text import Text

from arboleda.cli.complaint import complain, status_of
from arboleda.extension import ArboledaError, ConfigError
from arboleda.plant_file.user_file import check_new, check_writable
from arboleda_proofs.campaigns import screen, single_seed
from arboleda_proofs.campaigns.crews import crew
from arboleda_proofs.campaigns.flight import SUFFIX
from arboleda_proofs.campaigns.options import CYCLES, LEVEL, SEED, SEEDS
from arboleda_proofs.campaigns.plants import Plant, PlantRotation, Plants
from arboleda_proofs.campaigns.request import Request
from arboleda_proofs.campaigns.seed_campaign import SeedCampaign
from arboleda_proofs.simulator.levels import LEVELS
from frame.words import parser

from .plants import DrawnPlants, keep, loaded

COMMAND = "tools/drawn-plants"
Ended = tuple[int, Plant | None]  # the exit status, and the plant that is worth keeping
NOTE = "drawn plants: whatever link a robot declares, it is simulated with a virtual board on MQTT"


def main(typed: Sequence[str] | None = None) -> int:
    """Run what is typed and return the exit status."""
    options = _options(typed)
    console = screen.console()
    try:
        return _run(options, console)
    except ArboledaError as error:
        complain(error)
        return status_of(error)


def _run(options: Namespace, console: Console) -> int:
    request = _request(options)
    if request.exclusion is not None:
        raise ConfigError((str(request.exclusion()),))
    if options.json is not None:
        check_writable(options.json)
    console.print(Text(NOTE, style="dim"), soft_wrap=True)
    run = _one_seed if _is_of_one_seed(options) else _many_seeds
    status, plant = run(options, request, console)
    if options.keep_plant is not None and plant is not None:
        console.print(Text(f"plant {keep(plant, options.keep_plant)}"), soft_wrap=True)
    return status


def _many_seeds(options: Namespace, request: Request, console: Console) -> Ended:
    campaign = SeedCampaign(request, console, options.json)
    with crew(options.jobs, options.on, console) as those:
        status = campaign.run(those)
    return status, campaign.shrunk.plant if campaign.shrunk else None


def _one_seed(options: Namespace, request: Request, console: Console) -> Ended:
    trace, record = options.trace, options.record
    if record is not None:
        (check_new if record.suffix == SUFFIX else check_writable)(record)
    status = single_seed.run(request, console, trace=trace, record=record, file=options.json)
    return status, request.plants.of(request.first)


def _is_of_one_seed(options: Namespace) -> bool:
    return bool(options.trace or options.record is not None)


def _request(options: Namespace) -> Request:
    return Request(
        source=_plants(options),
        command=(COMMAND,),
        seed=options.seed,
        seeds=options.seeds,
        one_seed=_is_of_one_seed(options),
        cycles=options.cycles,
        faults=options.faults,
        until_failure=options.until_failure,
        any_of=options.any_of,
        standby=options.standby,
        revises=options.revisions,
    )


def _plants(options: Namespace) -> Plants:
    """A plant of its own for each seed; for a broken seed of a file the plant that is in there."""
    file = Request(faults=options.faults, seed=options.seed).faults_file
    if file is None or "plant_file" not in file.broken:
        return DrawnPlants()
    return PlantRotation(plants=(loaded(file.broken["plant_file"], file.broken.get("plant_files", {})),))


def _options(typed: Sequence[str] | None) -> Namespace:
    options = parser(__doc__, prog=COMMAND)
    options.add_argument("--seed", type=_seed, metavar="N", help=f"the first seed [{SEED}]")
    options.add_argument("--seeds", type=_count, metavar="N", help=f"how many [{SEEDS}]")
    cycles = f"tasks that are ended in each seed, at least [{CYCLES}]"
    options.add_argument("--cycles", type=_count, default=CYCLES, metavar="N", help=cycles)
    faults = f"{', '.join(LEVELS)}; or a file of faults, or one that --json wrote [{LEVEL}]"
    options.add_argument("--faults", default=LEVEL, metavar="LEVEL|FILE", help=faults)
    options.add_argument("--any-of", action="store_true", help="about half of the tasks name several cells")
    options.add_argument("--standby", action="store_true", help="each plant on two hosts and one store")
    options.add_argument("--revisions", action="store_true", help="engineers change its files meanwhile")
    options.add_argument("--until-failure", action="store_true", help="end at the first broken invariant")
    options.add_argument("--json", type=Path, metavar="FILE", help="write what came of every seed there")
    options.add_argument("--trace", action="store_true", help="print all that happens in one seed")
    record = "write one seed there: to FILE.mcap as a flight record, else an object per line"
    options.add_argument("--record", type=Path, metavar="FILE", help=record)
    keeping = "write a plant there: of the one seed, or of the broken one that is shrunk"
    options.add_argument("--keep-plant", type=Path, metavar="DIR", help=keeping)
    options.add_argument("--jobs", type=_count, metavar="N", help="processes [one per processor]")
    options.add_argument("--on", metavar="ADDRESS", help="the workers of a scheduler do it: tcp://HOST:8786")
    return options.parse_args(typed)


def _seed(word: str) -> int:
    if (seed := int(word)) < 0:
        raise ValueError(word)
    return seed


def _count(word: str) -> int:
    if (count := int(word)) < 1:
        raise ValueError(word)
    return count


if __name__ == "__main__":
    sys.exit(main())
