"""Language of the terminal: of `ARBOLEDA_LANG`, else of the locale; what it lacks is in English."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any

from arboleda.model.errors import ArboledaError
from arboleda.model.sentence import OWN, Phrase, Sentence, retold
from arboleda.web.languages import FIRST, contents, spoken

VARIABLES = ("ARBOLEDA_LANG", "LC_ALL", "LC_MESSAGES", "LANG")  # the first that is set says it

THERE_ARE = Phrase("cli.there_are", "there are {known}")
THERE_ARE_NONE = Phrase("cli.there_are_none", "there are none")
NEAREST = Phrase("cli.nearest", "{there}; did you mean {near}?")


def language() -> str:
    """The language that this terminal wants, of those that there are."""
    return spoken([next((value for name in VARIABLES if (value := os.environ.get(name))), None)])


def help_words(group: str) -> Mapping[str, str]:
    """The words of a group of the overview, as `commands`; none in English, which is in the code."""
    found: Mapping[str, str] = contents(language(), "cli").get(group, {})
    return found


def say(sentence: Sentence | str) -> str:
    """A sentence of the plant in this language."""
    return say_in(language(), sentence)


def say_in(language: str, sentence: Sentence | str) -> str:
    """A sentence of the plant in a language."""
    if isinstance(sentence, str) or language == FIRST:
        return str(sentence)
    from arboleda.dashboard.wording import words  # reads a file that nobody needs in English

    return words(language).say(sentence)


def allowed(wrong: str, known: Iterable[str]) -> Sentence:
    """The words that are allowed instead of a wrong one, and the nearest of them."""
    names = tuple(known)
    if not names:
        return THERE_ARE_NONE()
    near = get_close_matches(wrong.lower(), names, n=1)
    return NEAREST(there=THERE_ARE(known=names), near=near[0]) if near else THERE_ARE(known=names)


def word(group: str, name: str) -> str:
    """A word of the plant, as the state of a task, in this language; in English it is its name."""
    if language() == FIRST:
        return name
    from arboleda.dashboard.wording import words

    return words(language()).of(group, name)


def question(verb: str, of: str) -> str:
    """The question before a verb, as on the page; "" in English, where the command has its own."""
    if language() == FIRST:
        return ""
    from arboleda.dashboard.wording import words

    return next((each.format(of=of) for each in words(language()).asks(verb)), "")


def say_row(row: Mapping[str, Any]) -> str:
    """The `sentence` of an answer over HTTP, whose `key` and `values` say it as data where it has them."""
    return say(_of_data(str(row["sentence"] or ""), row.get("key"), row.get("values")))


def say_error(error: ArboledaError) -> str:
    """The sentence of an error, whether it is of this process or of the plant that was asked."""
    key, values = getattr(error, "key", None), getattr(error, "values", None)
    return finding(say(_of_data(str(error), key, values) if key else error.sentence))


def finding(text: str) -> str:
    """A finding in a file or in a run, in this language."""
    return finding_in(language(), text)


def finding_in(language: str, text: str) -> str:
    """A finding in a file or in a run, in a language."""
    if language == FIRST:
        return text
    from arboleda.dashboard.findings import findings

    return findings(language)(text)


def step_name(text: str) -> str:
    """The name of a step, in this language."""
    if language() == FIRST:
        return text
    from arboleda.dashboard.findings import step_names

    return step_names(language())(text)


def _of_data(english: str, key: object, values: object) -> Sentence:
    if not isinstance(key, str) or not isinstance(values, Mapping):
        return OWN(text=english)
    try:
        return retold(english, {"key": key, "values": values})
    except ValueError:
        return OWN(text=english)
