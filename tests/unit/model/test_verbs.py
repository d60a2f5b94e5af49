"""What a person writes behind a verb, as its scope and arguments and back."""

from __future__ import annotations

import pytest

from arboleda.model.verbs import Arguments, Verb, as_text, from_text, lasting

TEXTS: list[tuple[Verb, str, str, Arguments]] = [
    (Verb.UNLOAD, "sis_a 7", "sis_a", (("station", 7),)),
    (Verb.UNLOAD, "sis_a", "sis_a", ()),
    (Verb.UNLOAD, "", "", ()),
    (Verb.UNLOAD, "sis_a 07", "sis_a", (("station", "07"),)),
    (Verb.UNLOAD, "sis_a 7 8", "sis_a", (("station", "7 8"),)),
    (Verb.ANSWER, "ana not yet", "ana", (("answer", "not yet"),)),
    (Verb.ANSWER, "ana #7-1 yes", "ana", (("question", "7-1"), ("answer", "yes"))),
    (Verb.ANSWER, "ana #7-1 #1-2 x", "ana", (("question", "7-1"), ("answer", "#1-2 x"))),
    (Verb.ANSWER, "ana #7", "ana", (("answer", "#7"),)),
    (Verb.ANSWER, "ana", "ana", ()),
    (Verb.STOP, "sis_a 7", "sis_a 7", ()),
]


@pytest.mark.parametrize(("verb", "text", "scope", "arguments"), TEXTS)
def test_words_are_a_scope_and_arguments_and_back(
    verb: Verb, text: str, scope: str, arguments: Arguments
) -> None:
    assert from_text(verb, text) == (scope, arguments)
    assert as_text(verb, scope, arguments) == text


def test_blanks_between_words_do_not_count() -> None:
    assert from_text(Verb.ANSWER, "  ana  #7-1   yes ") == from_text(Verb.ANSWER, "ana #7-1 yes")


def test_what_only_one_start_of_the_plant_knows_does_not_last() -> None:
    assert lasting(Verb.ANSWER, (("question", "7-1"), ("answer", "yes"))) == (("answer", "yes"),)
