"""The forks of `arboleda replay` (`--fork-at`, `--set`, `--recipe`): runs one and prints the differences."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from arboleda.model.errors import ConfigError
from arboleda.model.outside import plain
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import user_file
from arboleda.plant_file.own_recipes import LARGEST
from arboleda.playback.fork.builders import builders_of
from arboleda.playback.fork.plant_events import TASK, Pair, beside
from arboleda.playback.fork.run import ForkRequest, ForkResult
from arboleda.playback.fork.settings import with_settings
from arboleda.playback.record_text import moment
from arboleda.playback.recorded_plant import (
    as_it_ran,
    loaded,
    model_of,
    versions_of,
    with_content,
)
from arboleda.recorder.preamble import Beginning, PlantFiles
from arboleda.recorder.reader import Record

from .record import changes

ROWS = 60  # from the first difference on
TIME = 23  # characters
NOTICED_S = 0.5


@dataclass(frozen=True, kw_only=True)
class Options:
    """The options of a fork as a person gave them; None and () stand for those not given."""

    at_ns: int | None = None
    task: str | None = None
    settings: tuple[str, ...] = ()
    plant: Path | None = None
    recipe: Path | None = None
    healthy: bool = False
    until_ns: int | None = None


def request_of(record: Record, options: Options) -> ForkRequest:
    """The fork that these options mean; ConfigError says what is missing or wrong."""
    beginning = record.first.beginning
    changed = bool(options.settings or options.plant)
    at_ns = options.at_ns
    if at_ns is None and options.task is not None:
        at_ns = _began_ns(record, options.task)
    if at_ns is None:
        raise ConfigError(("a fork needs --fork-at TIME, or --task ID: from when that task begins",))
    recipe = _with_recipe(beginning.files, options.recipe) if options.recipe else None
    recorded, versions = model_of(beginning), versions_of(record)
    model = _changed(beginning, options) if changed else recorded
    if changed:  # what was put to work later must not undo what is tried
        versions = dict.fromkeys(versions, model)
    return ForkRequest(
        at_ns=at_ns,
        model=model,
        recorded=recorded,
        builders=None if recipe is None else builders_of(as_it_ran(beginning, loaded(recipe))),
        healthy=options.healthy,
        until_ns=options.until_ns,
        versions=versions,
    )


def _changed(beginning: Beginning, options: Options) -> PlantModel:
    if options.plant is not None and options.settings:
        raise ConfigError(("--plant and --set: set the key in that file",))
    if not options.settings:
        return model_of(beginning, options.plant)
    files = beginning.files
    content = with_settings(files.contents[files.plant], options.settings)
    return as_it_ran(beginning, loaded(with_content(files, files.plant, content)))


def _with_recipe(files: PlantFiles, other: Path) -> PlantFiles:
    """The plant's files with this recipe file in place of the one of the same name, or of the only one."""
    own = [name for name in files.contents if name.endswith(".py")]
    same = [name for name in own if PurePosixPath(name).name == other.name] or own
    if len(same) != 1:
        there = ", ".join(own) or "none: its recipes are those that come with Arboleda"
        raise ConfigError((f"--recipe {other}: name it like the file it stands for; the record has {there}",))
    return with_content(files, same[0], user_file.read_bytes(other, LARGEST))


def _began_ns(record: Record, task: str) -> int:
    """The time before the step in which a task began to run."""
    for unix_ns, data in record.raw():
        if b'"running"' in data:
            for row in changes(json.loads(data)):
                if row["task"] == task and row["state"] == "running":
                    return unix_ns - 1
    raise ConfigError((f"--task {plain(task, 80)}: there is no such task in this record that ran",))


def lines(found: ForkResult, options: Options) -> Iterator[str]:
    """The result of a fork, as lines for people; `differs` says whether anything was otherwise."""
    at = _clock(found)
    yield f"{found.steps} steps are executed as they were; from {at(found.at)} on its devices are virtual"
    if found.early:
        yield "  there the changed plant does otherwise for the first time"
    for trouble in () if options.healthy else found.troubles:
        until = f"until {at(trouble.ends)}" if trouble.ends < found.until else "to the end"
        yield f"  as in the record: {trouble.robot}: {trouble.kind} from {at(trouble.at)} {until}"
    pairs = compared(found, options.task)
    first = next((n for n, pair in enumerate(pairs) if not pair.same), len(pairs))
    yield f"{first} things happened as in the record" + ("" if first < len(pairs) else ", and no other ones")
    yield from _times(pairs)
    if first < len(pairs):
        yield "the first difference:"
        yield from _table(pairs[first:], at)
    yield from _ends(pairs, at)


def compared(found: ForkResult, task: str | None) -> list[Pair]:
    """Both runs beside each other; only those of a task and the robots of its cell if one is named."""
    pairs = beside(found.recorded, found.fork, found.until)
    if task is None or found.world is None:
        return pairs
    mine = TASK + task
    cells = {pair.either.cell for pair in pairs if pair.either.stream == mine}
    robots = {each.name for cell in found.world.model.cells if cell.name in cells for each in cell.robots}
    return [pair for pair in pairs if pair.either.stream in {mine, *robots}]


def _clock(found: ForkResult) -> Callable[[float], str]:
    """The function that formats times of the plant's clock as times of day."""
    return lambda at: moment(found.unix_ns + round((at - found.at) * 1e9), "milliseconds")


def _times(pairs: list[Pair]) -> Iterator[str]:
    """The shifts in time of happenings that both runs have, if they are noticeable."""
    apart = [pair.fork.at - pair.recorded.at for pair in pairs if pair.recorded and pair.fork]
    most_s = max(apart, key=abs, default=0.0)
    if abs(most_s) >= NOTICED_S:
        yield f"  up to {abs(most_s):.1f} s {'later' if most_s > 0 else 'earlier'} than there"


def _table(pairs: list[Pair], at: Callable[[float], str]) -> Iterator[str]:
    yield f"  {'recorded':<{TIME}}  {'fork':<{TIME}}"
    for pair in pairs[:ROWS]:
        times = [at(each.at) if each else "-" for each in (pair.recorded, pair.fork)]
        yield f"  {times[0]:<{TIME}}  {times[1]:<{TIME}}  {pair.either.text}"
    if len(pairs) > ROWS:
        yield f"  and {len(pairs) - ROWS} more; --task ID shows those of one task"


def _ends(pairs: list[Pair], at: Callable[[float], str]) -> Iterator[str]:
    """The end of each task in either run."""
    ends: dict[str, list[str]] = {}
    for pair in pairs:
        for side, each in enumerate((pair.recorded, pair.fork)):
            if each is not None and each.stream.startswith(TASK):
                ends.setdefault(each.stream, ["not there", "not there"])[side] = f"{at(each.at)} {each.text}"
    for stream, (recorded, fork) in ends.items():
        yield stream
        yield f"  recorded  {recorded}"
        yield f"  fork      {fork}"
