"""Text from outside before anybody is shown it, and what a person writes behind a verb."""

from __future__ import annotations

import doctest

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.model import outside
from arboleda.model.outside import LINE, plain, quoted
from arboleda.model.verbs import Arguments, Verb, as_text, from_text, lasting

ANY = st.text(st.characters(exclude_categories=()), max_size=400)  # surrogates and controls, too
EVIL = [
    "\x1b[2J",
    "\x9b31m",
    "a\rb",
    "a\nb",
    "\u202eabc",
    "\u2066",
    "\u200b",
    "\u2028",
    "\ud800",
    "\x00",
    "\x7f",
]


@given(text=ANY, most=st.integers(4, 300))
def test_whatever_comes_in_one_printable_line_of_bounded_length_goes_out(text: str, most: int) -> None:
    shown = plain(text, most)
    assert len(shown) <= most and shown.isprintable() and len(shown.splitlines()) <= 1
    shown.encode("utf-8")


@given(text=ANY)
def test_what_was_made_plain_stays_so(text: str) -> None:
    assert plain(plain(text)) == plain(text)


@given(text=st.text(st.characters(exclude_categories=("C", "Zl", "Zp", "Zs")), max_size=LINE))
def test_short_text_of_any_language_stays_as_it_is(text: str) -> None:
    assert plain(text) == text


@given(value=st.one_of(ANY, st.binary(max_size=400), st.integers(), st.floats(), st.lists(ANY, max_size=5)))
def test_a_quoted_value_is_short_and_printable(value: object) -> None:
    shown = quoted(value)
    assert shown.isprintable() and len(shown) <= 10 * 40 + 3
    shown.encode("utf-8")


@pytest.mark.parametrize("word", ["sí", "leña", "двери", "閉じる"])
def test_a_quoted_word_of_any_language_can_be_read(word: str) -> None:
    assert quoted(word) == f"'{word}'"
    assert quoted([word]) == f"['{word}']"


@pytest.mark.parametrize("evil", EVIL)
def test_what_a_terminal_or_a_reader_would_obey_is_escaped(evil: str) -> None:
    assert evil not in plain(evil) and "\\" in plain(evil)
    assert evil not in quoted(evil)


def test_a_hundred_thousand_letters_are_clipped() -> None:
    assert plain("a" * 100_000) == "a" * (LINE - 3) + "..."
    assert quoted("a" * 100_000) == "'" + "a" * 37 + "...'"


def test_the_examples_hold() -> None:
    assert doctest.testmod(outside).failed == 0


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
