"""Ends of trees: facts and numbers of parts once a task is done, by the metadata of the tree's model."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import chain, product

from arboleda.drivers import UseError, Value, quoted
from arboleda.model.plant_model import Cell
from arboleda.recipes import RecipeError
from arboleda.recipes.authoring import check_end
from arboleda.recipes.of_files import Place

from . import listed_values, target_groups
from .findings import Findings
from .forest import Forest, Metadata
from .values import number, objection

KEY = "ends_with"
KEYS = (KEY, target_groups.KEY, listed_values.KEY)  # of all metadata with a meaning
HOW = (
    "a place or a fact with its value, `nest: 1; reader.lid: open`, and `|` between the ends of several ways"
)
PAIR = re.compile(r"\s*([^\s:][^:]*?)\s*:\s*('[^']*'|[^\s':][^':]*?)\s*")
BOOLS = {"true": True, "false": False}


@dataclass(frozen=True, kw_only=True)
class End:
    """Value of a fact, or number of parts at a place, at the end of a task; `place` is in the file."""

    what: str
    value: Value
    place: Place


def of_tree(forest: Forest, tree: str) -> tuple[tuple[End, ...], ...]:
    """The ends of which a tree states that one is so; a part that cannot be read is left out, `check` reports
    it.
    """
    ways = product(*map(_read, forest.metadata_of(tree, KEY)))
    read = (tuple(end for end in chain(*way) if isinstance(end, End)) for way in ways)
    return tuple(way for way in read if way)


def check(forest: Forest, findings: Findings) -> None:
    """Keep a finding for each part of an end that cannot be read, or that is there twice."""
    for tree, metadata in forest.metadata.items():
        for each in metadata:
            near = get_close_matches(each.key, KEYS, n=1, cutoff=0.8)
            if each.key not in KEYS and near:
                sentence = f"nobody here knows {quoted(each.key)} of {tree}; did you mean {near[0]}?"
                findings.warning(each.place, sentence, kind="key-of-metadata")
        for end in (end for each in forest.metadata_of(tree, KEY) for end in chain(*_read(each))):
            if isinstance(end, _Unread):
                findings.mistake(end.place, f"{KEY} of {tree}: {quoted(end.text)} is not read; write {HOW}")
        twice = {end: None for way in of_tree(forest, tree) for end in _twice(way)}
        for end in twice:
            findings.mistake(end.place, f"{KEY} of {tree} has {quoted(end.what)} twice")


def check_in_cell(
    name: str, ends: Iterable[End], values: Mapping[str, object], cell: Cell, findings: Findings
) -> None:
    """Keep a finding for each part of a recipe's end that no device and no place of a cell can report."""
    for end in ends:
        try:
            check_end(name, [(str(values.get(end.what, end.what)), end.value)], cell)
        except (RecipeError, UseError) as error:
            findings.mistake(end.place, str(error))


@dataclass(frozen=True)
class _Unread:
    text: str
    place: Place


def _twice(way: Sequence[End]) -> Iterator[End]:
    """The parts of an end whose place or fact stands there before."""
    stated: set[str] = set()
    for end in way:
        if end.what in stated:
            yield end
        stated.add(end.what)


def _read(metadata: Metadata) -> list[list[End | _Unread]]:
    """The parts of each end, of which one is so."""
    return [[*_parts(text, metadata.place)] for text in metadata.text.split("|")]


def _parts(way: str, place: Place) -> Iterator[End | _Unread]:
    for text in way.split(";"):
        pair = PAIR.fullmatch(text)
        if pair is not None:
            yield End(what=pair[1], value=_value(pair[2]), place=place)
        elif text.strip():
            yield _Unread(text.strip(), place)


def _value(text: str) -> Value:
    """The value of a text: true or false, a number, or a word, which may stand in quotes."""
    if text.startswith("'"):
        return text[1:-1]
    if text in BOOLS:
        return BOOLS[text]
    if objection("int", text) is None:
        return int(number(text))
    return number(text) if objection("double", text) is None else text
