"""Advice that leads a cell out of its trouble: a row for each, with a button where it is a verb."""

from __future__ import annotations

from typing import Any

from arboleda.model.messages import Verb
from arboleda.views.readying import TOLD, told

from ..wording import Words
from . import Face

Row = dict[str, Any]


def face(words: Words, cell: Row) -> Face:
    """The list of the advice of a cell, in the order to follow it."""
    name, found = cell["name"], {}
    for number, advice in enumerate(cell["advice"]):
        before = _before(cell["advice"], number)
        said = text(words, advice) if advice["hand"] else ""
        found[f"row/ways.{name}/{number}"] = {
            "state": "hand" if advice["hand"] else "next" if number == 0 else "later",
            "texts": [said, _note(words, advice, before)],
            "acts": _acts(words, advice),
        }
    return {f"rows/ways.{name}": [str(number) for number in range(len(cell["advice"]))], **found}


def text(words: Words, advice: Row) -> str:
    """The act itself."""
    if advice["by_hand"]:
        return words(f"ways.{advice['do']}_by_hand", robot=advice["scope"])
    if not advice["scope"]:
        return words("ways.plant", verb=words.of("verb", advice["do"]))
    if advice["do"] == Verb.DO:
        said = words("ways.do", work=advice["arguments"]["work"], robot=advice["scope"])
    else:
        said = words.say(advice["said"])
    return said[:1].upper() + said[1:]


def effect(words: Words, advice: Row) -> str:
    """The sentence on the parts that fall, or the robots that move, by an act."""
    if advice["drops"]:
        return words("ways.drops", robots=", ".join(advice["drops"]))
    if advice["moves"]:
        return words("ways.moves", robots=", ".join(advice["moves"]))
    return words("ways.still")


def offer(words: Words, advice: Row) -> Row:
    """The button of a verb that is advised, with what it asks first: about motion, parts and zones always."""
    label, verb, asks = text(words, advice), Verb(advice["do"]), []
    if advice["by_hand"]:
        asks = words.asks(f"{verb.value}_by_hand")
    elif advice["drops"]:
        asks = [words("ways.asks_drops", said=label, robots=", ".join(advice["drops"]))]
    elif advice["moves"]:
        asks = [words("ways.asks_moves", said=label, robots=", ".join(advice["moves"]))]
    elif not verb.row.moves:
        asks = words.asks(verb.value)
    told_with = advice.get("arguments")  # older records have none
    arguments = {"arguments": told_with} if told_with else {}
    return {
        "act": verb.value,
        "of": advice["scope"],
        "label": label,
        "does": words.say(advice["why"]),
        "asks": asks,
        "by_hand": advice["by_hand"],
        "refused": bool(advice["refusal"]),
        **arguments,
    }


def _acts(words: Words, advice: Row) -> list[Row]:
    if not advice["hand"]:
        return [offer(words, advice)]
    if advice["do"] not in TOLD:
        return []
    saying = told(advice)
    return [offer(words, saying) | {"label": words.of("verb", saying["do"])}]


def _before(ways: list[Row], number: int) -> list[Row]:
    """The advice right before this one: a single one, or all of a group of alternatives."""
    first = number - 1
    while first > 0 and ways[first]["instead"]:
        first -= 1
    return ways[max(first, 0) : number]


def _note(words: Words, advice: Row, before: list[Row]) -> str:
    """The note on an advice: the advice to follow first, or the reason against it now, or else its effect."""
    if advice["refusal"] and before and not advice["instead"]:
        note = words("ways.after", first=words("ways.or").join(text(words, each) for each in before))
    elif advice["refusal"]:
        note = words("ways.not_yet", why=words.say(advice["refusal"]))
    else:
        note = words.say(advice["why"]) if advice["hand"] else effect(words, advice)
    return words("ways.instead", note=note) if advice["instead"] else note
