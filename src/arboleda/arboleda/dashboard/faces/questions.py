"""Questions of tasks and of packages to people: the text, the time left, and a button for each answer."""

from __future__ import annotations

from typing import Any

from arboleda.model.messages import Verb
from arboleda.views.view import devices_once

from ..wording import Words
from . import Face, packages
from .moment import Moment, seconds

Row = dict[str, Any]
ASKED = "asked"


def face(moment: Moment) -> Face:
    found: Face = {}
    robots = {robot["name"]: robot for robot in moment.snapshot["robots"]}
    for _, device in devices_once(moment.snapshot["cells"]):
        if device["asked"]:
            found.update(_of(moment.words, device["name"], robots[device["name"]]["question"]))
    return found | _of_packages(moment)


def _of_packages(moment: Moment) -> Face:
    asked = packages.questions_of(moment)
    found: Face = {"rows/asks": [each["id"] for each in asked]}
    for each in asked:
        offers = [_offer(moment.words, each["package"], each, answer) for answer in each["answers"]]
        texts = [each["package"], each["text"]]
        found[f"row/asks/{each['id']}"] = {"state": ASKED, "texts": texts, "acts": offers}
    return found


def _of(words: Words, person: str, question: Row | None) -> Face:
    if question is None:
        return {
            f"text/asked_who.{person}": ["", ""],
            f"text/asked.{person}": ["", ""],
            f"text/asked_left.{person}": ["", ""],
            f"rows/answers.{person}": [],
        }
    offers = [_offer(words, person, question, answer) for answer in question["answers"]]
    return {
        f"text/asked_who.{person}": [words("asked.who", person=person), ASKED],
        f"text/asked.{person}": [question["text"], ASKED],
        f"text/asked_left.{person}": [words("asked.left", time=seconds(question["left_s"])), ASKED],
        f"rows/answers.{person}": [question["id"]],
        f"row/answers.{person}/{question['id']}": {"state": ASKED, "texts": [], "acts": offers},
    }


def _offer(words: Words, person: str, question: Row, answer: str) -> Row:
    """The act of an answer's button; it names its question, so that a late click answers no later one."""
    does = words("asked.does", answer=answer, question=question["text"])
    arguments = {"question": question["id"], "answer": answer}
    return {"act": Verb.ANSWER.value, "of": person, "label": answer, "does": does, "arguments": arguments}
