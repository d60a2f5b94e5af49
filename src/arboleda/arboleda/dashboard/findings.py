"""Findings in another language: by their own templates, and by the plant's phrases that stand in them."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator
from functools import cache
from typing import Any

from arboleda.model.sentence import Phrase, Sentence
from arboleda.web.languages import FIRST, contents
from arboleda.web.languages.templates import FEW, Template, Templates

from .wording import REASONS as DRIVERS
from .wording import SENTENCES, words

# Rooms whose phrases are reasons.
GIVING = ("core", "departures", "dispatch", "model", "recipes", "resume", "trees", "wire")
REASONS = frozenset(
    {
        "advice",
        "command",
        "device",
        "effector",
        "need",
        "next",
        "part",
        "path",
        "place",
        "plant",
        "recipe",
        "recovery",
        "rejection",
        "robot",
        "script",
        "task",
        "text",
        "tool",
        "why",
        "xml",
        "zone",
    }
)
STEPS = frozenset({"step", "pose"})  # whose phrases are names of steps, and of where they lead
POSES = "arboleda.plant_file.poses"
DOING = "doing"  # of one word, too, as "homing", for they stand behind others


@cache
def findings(language: str) -> Templates:
    """The templates of what is found wrong in files and runs; in English there are none."""
    if language == FIRST:
        return Templates({})
    other: dict[str, str] = contents(language, "page").get(SENTENCES, {})
    reasons = {each.english: other[each.key] for each in plant_reasons() if each.key in other}
    drivers = contents(language, DRIVERS)
    own = contents(language, "findings").get("sentences", {}) | drivers
    rows = {**own, **reasons, **own}  # first, for of those that fit alike the first is taken
    return Templates(rows, ends=words(language).ends, of_devices=drivers)


@cache
def step_names(language: str) -> Templates:
    """The templates of the names that steps have of themselves; in English there are none."""
    if language == FIRST:
        return Templates({})
    other: dict[str, str] = contents(language, "page").get(SENTENCES, {})
    told = (*_told(), *_of_module(POSES))
    named = (each for each in told if each.key.partition(".")[0] in STEPS)
    return Templates({each.english: other[each.key] for each in named if each.key in other})


def plant_reasons() -> list[Phrase]:
    """The phrases with which a plant says why something is not done, or what it was about to do."""
    return list({each.key: each for each in _told() if _is_reason(each)}.values())


def _told() -> Iterator[Phrase]:
    for name in GIVING:
        package = importlib.import_module(f"arboleda.{name}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            yield from _of_module(module.name)


def _of_module(name: str) -> Iterator[Phrase]:
    for value in vars(importlib.import_module(name)).values():
        yield from _phrases(value)


def _is_reason(phrase: Phrase) -> bool:
    group = phrase.key.partition(".")[0]
    letters = Template(phrase.english, "").letters  # of few, what is Spanish already may be one
    return group == DOING or (group in REASONS and " " in phrase.english and letters >= FEW)


def _phrases(value: Any) -> Iterator[Phrase]:
    if isinstance(value, Phrase):
        yield value
    elif isinstance(value, Sentence):
        yield value.phrase
    elif isinstance(value, dict | tuple):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _phrases(each)
