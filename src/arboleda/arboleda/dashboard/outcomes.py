"""Sentences about what became of a request of the page."""

from __future__ import annotations

from typing import Any

from arboleda.model.advice import BY_HAND
from arboleda.model.messages import OperatorAnswer, Outcome, Verb
from arboleda.model.sentence import Sentence
from arboleda.model.verbs import Arguments, as_text, lasting

from .wording import Words

GOOD = {Outcome.UNDER_WAY: None, Outcome.UNCHECKED: None, Outcome.FAILED: False}
Said = tuple[str, bool | None]
"""A sentence, and whether it is good news; None while that is open."""


def of_task(words: Words, task: dict[str, Any]) -> Said:
    """The sentence on a task that was asked for, as `view.change` has it."""
    if task["state"] == "refused":
        return words.say(task["sentence"]), False
    return words("tasks.taken", text=task["text"], id=task["id"]), True


def act(words: Words, verb: Verb, scope: str, arguments: Arguments, *, by_hand: bool) -> dict[str, str]:
    """The act and its scope, as values for the sentences on it."""
    name = f"{verb.value}_by_hand" if by_hand and verb in BY_HAND else verb.value
    where = as_text(verb, scope, lasting(verb, arguments)) or words("panel.plant")
    return {"what": words.of("verb", name), "where": where}


def of_answer(words: Words, answer: OperatorAnswer, act: dict[str, str]) -> Said:
    """The sentence on an operator's verb, as the plant answers it."""
    if answer.refusal is not None:
        return words.say(answer.refusal), False
    if answer.outcome is Outcome.SENT and answer.why is not None:  # a stop that left but could not be kept
        return words.say(answer.why), False
    return of_outcome(words, answer.outcome or Outcome.DONE, answer.why, act)


def of_outcome(words: Words, outcome: Outcome, why: Sentence | None, act: dict[str, str]) -> Said:
    """The sentence on the outcome of an act."""
    reason = {} if why is None else {"why": words.say(why)}
    return words(f"panel.{outcome.value}", **act, **reason), GOOD.get(outcome, True)


def arguments_of(verb: Verb, more: object) -> Arguments:
    """The arguments of a verb in what a page sends."""
    values = more if isinstance(more, dict) else {}
    takes = [each for each in verb.arguments if type(values.get(each.name)) is each.type]
    return tuple((each.name, values[each.name]) for each in takes)
