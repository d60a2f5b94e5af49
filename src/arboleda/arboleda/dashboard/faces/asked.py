"""What people are asked: the question, how long it waits, and a button for each answer."""

from __future__ import annotations

from typing import Any

from arboleda.core.messages import Verb

from ..wording import Words
from . import Face
from .moment import Moment, seconds

Row = dict[str, Any]
PERSON = "person"
ASKED = "asked"


def face(moment: Moment) -> Face:
    found: Face = {}
    for robot in moment.snapshot["robots"]:
        if robot["kind"] == PERSON:
            found.update(_of(moment.words, robot["name"], robot["question"]))
    return found


def waited_for(snapshot: Row) -> dict[str, list[str]]:
    """By its name each cell that waits for people, and for whom."""
    asked = {robot["name"] for robot in snapshot["robots"] if robot["question"] is not None}
    cells = {cell["name"]: [device["name"] for device in cell["devices"]] for cell in snapshot["cells"]}
    waits = {cell: [name for name in names if name in asked] for cell, names in cells.items()}
    return {cell: names for cell, names in waits.items() if names}


def _of(words: Words, person: str, question: Row | None) -> Face:
    if question is None:
        return {
            f"text/asked_who.{person}": ["", ""],
            f"text/asked.{person}": ["", ""],
            f"text/asked_left.{person}": ["", ""],
            f"rows/answers.{person}": [],
        }
    offers = [_offer(words, person, question["text"], answer) for answer in question["answers"]]
    return {
        f"text/asked_who.{person}": [words("asked.who", person=person), ASKED],
        f"text/asked.{person}": [question["text"], ASKED],
        f"text/asked_left.{person}": [words("asked.left", time=seconds(question["left_s"])), ASKED],
        f"rows/answers.{person}": [question["id"]],
        f"row/answers.{person}/{question['id']}": {"state": ASKED, "texts": [], "acts": offers},
    }


def _offer(words: Words, person: str, question: str, answer: str) -> Row:
    does = words("asked.does", answer=answer, question=question)
    return {"act": Verb.ANSWER.value, "of": f"{person} {answer}", "label": answer, "does": does}
