"""What is done to text from outside before anybody is shown it."""

from __future__ import annotations

import doctest

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.model import outside
from arboleda.model.outside import LINE, plain, quoted

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
