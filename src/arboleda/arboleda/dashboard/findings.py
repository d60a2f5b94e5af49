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

from .wording import SENTENCES

GIVING = ("bt_xml", "core", "dispatch", "recipes", "trees", "wire")  # packages whose phrases are reasons
REASONS = frozenset(
    {
        "command",
        "device",
        "effector",
        "need",
        "part",
        "path",
        "place",
        "plant",
        "recipe",
        "recovery",
        "rejection",
        "robot",
        "script",
        "text",
        "tool",
        "why",
        "xml",
        "zone",
    }
)
DOING = "doing"  # of one word, too, as "homing", for they stand behind others


@cache
def findings(language: str) -> Templates:
    """The templates of what is found wrong in files and runs; in English there are none."""
    if language == FIRST:
        return Templates({})
    other: dict[str, str] = contents(language, "page").get(SENTENCES, {})
    reasons = {each.english: other[each.key] for each in plant_reasons() if each.key in other}
    own: dict[str, str] = contents(language, "findings").get("sentences", {})
    return Templates({**own, **reasons, **own})  # first, for of those that fit alike the first is taken


def plant_reasons() -> list[Phrase]:
    """The phrases with which a plant says why something is not done, or what it was about to do."""
    return list({each.key: each for each in _told() if _is_reason(each)}.values())


def _told() -> Iterator[Phrase]:
    for name in GIVING:
        package = importlib.import_module(f"arboleda.{name}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            for value in vars(importlib.import_module(module.name)).values():
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
