"""Exercises as data: a task in several languages, the files to start from, hints, and what the judge asks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import yaml

from arboleda.drivers import among, quoted
from arboleda.extension import ConfigError
from arboleda_proofs.simulator.faults import Fault

if TYPE_CHECKING:
    from importlib.abc import Traversable  # where Python 3.10 has it, and 3.14 no more

FOLDER, SAID, START, PLANT = "catalog", "exercise.yaml", "start", "plant.yaml"
LANGUAGES = ("en", "es")
Text = Mapping[str, str]  # by language


@dataclass(frozen=True, kw_only=True)
class TimedFault:
    """Fault with the moment of its beginning: at its time after the request, or with an act of the plant."""

    fault: Fault
    act: str = ""


@dataclass(frozen=True, kw_only=True)
class Trial:
    """Trial: tasks in a plant that something befalls, and what is to be so then; None: it does not matter.

    `answers` are those of devices and people who are asked, always; `replies` those of one verb of a device,
    one after the other; with `silent` people do not answer. `ends` has for each task how it may end; `acts`
    how often something is done, at least and at most; `order` what is done before what; `apart` robots with
    targets at which they are never at the same time; `during` facts that are so while something is done.
    `in_s`: the tasks have ended by then. `faults_in`: the file of the student with the faults, which have to
    lead to what the record of the exercise shows.
    """

    says: Text
    tasks: tuple[str, ...]
    answers: Mapping[str, Any]
    replies: Mapping[str, tuple[Any, ...]]
    silent: bool
    faults: tuple[TimedFault, ...]
    faults_in: str
    ends: tuple[tuple[str, ...], ...]
    reason: str | None
    facts: Mapping[str, Any]
    parts: Mapping[str, int]
    acts: Mapping[str, tuple[int, int]]
    order: tuple[str, ...]
    apart: tuple[tuple[str, str], ...]
    during: Mapping[str, Mapping[str, Any]]
    in_s: float | None
    at_most_s: float


@dataclass(frozen=True, kw_only=True)
class Proving:
    """Proof of a recipe: single faults of these kinds, `runs` of them or a few more; no invariant may break.

    `ends` has by kind how tasks may end then; `noticed` are the kinds after which a task that is called done
    has to be as without them.
    """

    recipe: str
    kinds: tuple[str, ...]
    runs: int
    ends: Mapping[str, tuple[str, ...]]
    noticed: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Exercise:
    """Exercise: `minutes` and `difficulty` (easy, medium, hard) are for somebody who knows the lessons before
    it; `start` are its files by name, of which `yours` are the student's; `keeps` has the keys of
    the plant file, where it is theirs, that stay as they are. `declares` has by recipe what it has to say of
    its end. `record` is the trial of which the student gets a record.
    """

    name: str
    number: int
    minutes: int
    difficulty: str
    title: Text
    task: Text
    hints: tuple[Text, ...]
    start: Mapping[str, bytes]
    yours: tuple[str, ...]
    keeps: tuple[str, ...]
    declares: Mapping[str, Mapping[str, Any]]
    trials: tuple[Trial, ...]
    proving: tuple[Proving, ...]
    record: Trial | None

    @property
    def runs(self) -> int:
        """About how many runs the judge simulates for a work that is right."""
        compared = sum(bool(each.faults_in) for each in self.trials)  # with the record
        return len(self.trials) + compared + sum(each.runs for each in self.proving)


def exercise(name: str) -> Exercise:
    """The exercise of this name; ConfigError with those that there are."""
    known = catalog()
    if name not in known:
        raise ConfigError((f"there is no exercise {quoted(name)}; {among(name, known)}",))
    return known[name]


@cache
def catalog() -> Mapping[str, Exercise]:
    """All exercises by name, the easiest first."""
    folders = files(__package__).joinpath(FOLDER).iterdir()
    found = [_read(each) for each in folders if each.joinpath(SAID).is_file()]
    return {each.name: each for each in sorted(found, key=lambda each: each.number)}


def _read(folder: Traversable) -> Exercise:
    sheet = yaml.safe_load(folder.joinpath(SAID).read_text("utf-8"))
    judge = sheet["judge"]
    return Exercise(
        name=folder.name,
        number=sheet["number"],
        minutes=sheet["minutes"],
        difficulty=sheet["difficulty"],
        title=sheet["title"],
        task=sheet["task"],
        hints=tuple(sheet["hints"]),
        start={each.name: each.read_bytes() for each in folder.joinpath(START).iterdir() if each.is_file()},
        yours=tuple(sheet["yours"]),
        keeps=tuple(sheet.get("keeps", ())),
        declares=judge.get("declares", {}),
        trials=tuple(_trial(each) for each in judge.get("trials", ())),
        proving=tuple(_proving(each) for each in judge.get("prove", ())),
        record=_trial({"says": {}, **sheet["record"]}) if "record" in sheet else None,
    )


def _trial(row: Mapping[str, Any]) -> Trial:
    return Trial(
        says=row["says"],
        tasks=tuple(row["tasks"]),
        answers=row.get("answers", {}),
        replies={who: tuple(words) for who, words in row.get("replies", {}).items()},
        silent=row.get("silent", False),
        faults=tuple(_fault(each) for each in row.get("faults", ())),
        faults_in=row.get("faults_in", ""),
        ends=tuple(tuple(each.split(" or ")) for each in row.get("ends", ())),
        reason=row.get("reason"),
        facts=row.get("facts", {}),
        parts=row.get("parts", {}),
        acts={act: (times[0], times[-1]) for act, times in row.get("acts", {}).items()},
        order=tuple(row.get("order", ())),
        apart=tuple((robot, target) for robot, target in row.get("apart", ())),
        during=row.get("during", {}),
        in_s=row.get("in_s"),
        at_most_s=row.get("at_most_s", 240.0),
    )


def _fault(row: Mapping[str, Any]) -> TimedFault:
    fields = {key: value for key, value in row.items() if key != "with"}
    return TimedFault(fault=Fault(**{"at": 0.0, **fields}), act=row.get("with", ""))


def _proving(row: Mapping[str, Any]) -> Proving:
    return Proving(
        recipe=row["recipe"],
        kinds=tuple(row["kinds"]),
        runs=row["runs"],
        ends={kind: tuple(words) for kind, words in row.get("ends", {}).items()},
        noticed=tuple(row.get("noticed", ())),
    )
