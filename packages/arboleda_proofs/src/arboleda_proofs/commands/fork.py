"""The forks of `arboleda record replay` (`--fork-at`, `--set`, `--recipe`): run, and what differs printed."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from arboleda.cli.record import changes
from arboleda.drivers import plain
from arboleda.extension import ConfigError, Phrase, say
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import user_file
from arboleda.plant_file.own_recipes import LARGEST
from arboleda.recorder.preamble import Beginning
from arboleda.recorder.reader import Record
from arboleda.recorder.record_text import moment
from arboleda_proofs.playback.fork.builders import builders_of
from arboleda_proofs.playback.fork.plant_events import TASK, Pair, beside
from arboleda_proofs.playback.fork.run import ForkRequest, ForkResult
from arboleda_proofs.playback.fork.settings import with_settings
from arboleda_proofs.playback.recorded_plant import as_it_ran, loaded, model_of, versions_of, with_content

ROWS = 60  # from the first difference on
TIME = 23  # characters
NOTICED_S = 0.5
NO_INSTANT = Phrase(
    "cli.fork.no_instant", "a fork needs --fork-at TIME, or --task ID: from when that task begins"
)
PLANT_AND_SET = Phrase("cli.fork.plant_and_set", "--plant and --set: set the key in that file")
OTHER_NAME = Phrase(
    "cli.fork.other_name", "--recipe {recipe}: name it like the file it stands for; the record has {known}"
)
NO_RECIPES = Phrase(
    "cli.fork.no_recipes",
    "--recipe {recipe}: name it like the file it stands for; the record has none: "
    "its recipes are those that come with Arboleda",
)
NEVER_RAN = Phrase("cli.fork.never_ran", "--task {task}: there is no such task in this record that ran")
AS_THEY_WERE = Phrase(
    "cli.fork.as_they_were",
    "{steps} steps are executed as they were; from {time} on its devices are virtual",
)
EARLY = Phrase("cli.fork.early", "there the changed plant does otherwise for the first time")
TROUBLE_UNTIL = Phrase(
    "cli.fork.trouble_until", "as in the record: {robot}: {kind} from {begins} until {ends}"
)
TROUBLE_TO_END = Phrase(
    "cli.fork.trouble_to_end", "as in the record: {robot}: {kind} from {begins} to the end"
)
ALIKE = Phrase("cli.fork.alike", "{count} things happened as in the record")
ALL_ALIKE = Phrase("cli.fork.all_alike", "{count} things happened as in the record, and no other ones")
LATER = Phrase("cli.fork.later", "up to {seconds:.1f} s later than there")
EARLIER = Phrase("cli.fork.earlier", "up to {seconds:.1f} s earlier than there")
FIRST_DIFFERENCE = Phrase("cli.fork.first_difference", "the first difference:")
RECORDED, FORK = Phrase("cli.fork.recorded", "recorded"), Phrase("cli.fork.fork", "fork")
MORE = Phrase("cli.fork.more", "and {count} more; --task ID shows those of one task")
NOT_THERE = Phrase("cli.fork.not_there", "not there")


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
        raise ConfigError((say(NO_INSTANT()),))
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
        raise ConfigError((say(PLANT_AND_SET()),))
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
        wrong = OTHER_NAME(recipe=str(other), known=tuple(own)) if own else NO_RECIPES(recipe=str(other))
        raise ConfigError((say(wrong),))
    return with_content(files, same[0], user_file.read_bytes(other, LARGEST))


def _began_ns(record: Record, task: str) -> int:
    """The time before the step in which a task began to run."""
    for unix_ns, data in record.raw():
        if b'"running"' in data:
            for row in changes(json.loads(data)):
                if row["task"] == task and row["state"] == "running":
                    return unix_ns - 1
    raise ConfigError((say(NEVER_RAN(task=plain(task, 80))),))


def lines(found: ForkResult, options: Options) -> Iterator[str]:
    """The result of a fork, as lines for people; `differs` says whether anything was otherwise."""
    at = _clock(found)
    yield say(AS_THEY_WERE(steps=found.steps, time=at(found.at)))
    if found.early:
        yield f"  {say(EARLY())}"
    for trouble in () if options.healthy else found.troubles:
        robot, kind, begins = trouble.robot, trouble.kind, at(trouble.at)
        if trouble.ends < found.until:
            ends = at(trouble.ends)
            yield f"  {say(TROUBLE_UNTIL(robot=robot, kind=kind, begins=begins, ends=ends))}"
        else:
            yield f"  {say(TROUBLE_TO_END(robot=robot, kind=kind, begins=begins))}"
    pairs = compared(found, options.task)
    first = next((n for n, pair in enumerate(pairs) if not pair.same), len(pairs))
    yield say((ALIKE if first < len(pairs) else ALL_ALIKE)(count=first))
    yield from _times(pairs)
    if first < len(pairs):
        yield say(FIRST_DIFFERENCE())
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
        yield f"  {say((LATER if most_s > 0 else EARLIER)(seconds=abs(most_s)))}"


def _table(pairs: list[Pair], at: Callable[[float], str]) -> Iterator[str]:
    yield f"  {say(RECORDED()):<{TIME}}  {say(FORK()):<{TIME}}"
    for pair in pairs[:ROWS]:
        times = [at(each.at) if each else "-" for each in (pair.recorded, pair.fork)]
        yield f"  {times[0]:<{TIME}}  {times[1]:<{TIME}}  {pair.either.text}"
    if len(pairs) > ROWS:
        yield f"  {say(MORE(count=len(pairs) - ROWS))}"


def _ends(pairs: list[Pair], at: Callable[[float], str]) -> Iterator[str]:
    """The end of each task in either run."""
    ends: dict[str, list[str]] = {}
    none, names = say(NOT_THERE()), (say(RECORDED()), say(FORK()))
    width = max(map(len, names)) + 2
    for pair in pairs:
        for side, each in enumerate((pair.recorded, pair.fork)):
            if each is not None and each.stream.startswith(TASK):
                ends.setdefault(each.stream, [none, none])[side] = f"{at(each.at)} {each.text}"
    for stream, (recorded, fork) in ends.items():
        yield stream
        yield f"  {names[0]:<{width}}{recorded}"
        yield f"  {names[1]:<{width}}{fork}"
