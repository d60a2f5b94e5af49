"""Catalogues have every phrase, also those of mishaps."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

import pytest
from tests.unit.dashboard.test_catalogue import modules, slots

import arboleda
import arboleda.dashboard.toolkit  # its library starts a process as it is imported, and no test here may
from arboleda.dashboard.wording import LANGUAGES, tree_of
from arboleda.model.sentence import Phrase, Sentence
from arboleda_proofs.simulator.mishaps import Mishap

OTHERS = LANGUAGES[1:]


def phrases_in(value: Any) -> Iterator[Phrase]:
    if isinstance(value, Phrase):
        yield value
    elif isinstance(value, Sentence | Mishap):
        yield value.phrase
    elif isinstance(value, dict | tuple):
        for each in value.values() if isinstance(value, dict) else value:
            yield from phrases_in(each)


def phrases() -> dict[str, Phrase]:
    """Every phrase that a module of ours names, by its key."""
    found = {id(phrase): phrase for module in modules() for phrase in phrases_in(vars(module))}
    twice = [key for key, count in Counter(each.key for each in found.values()).items() if count > 1]
    assert twice == [], "one key, one phrase"
    return {phrase.key: phrase for phrase in found.values()}


def test_there_are_phrases() -> None:
    assert arboleda.__name__ and len(phrases()) > 150


@pytest.mark.parametrize("language", OTHERS)
def test_a_catalogue_has_every_phrase_and_no_other(language: str) -> None:
    assert tree_of(language)["sentences"].keys() == phrases().keys()


@pytest.mark.parametrize("language", OTHERS)
def test_a_catalogue_fills_the_slots_of_its_phrases(language: str) -> None:
    said = tree_of(language)["sentences"]
    english = {key: slots(phrase.english) for key, phrase in phrases().items()}
    assert {key: slots(said[key]) for key in said} == english
