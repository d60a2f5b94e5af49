"""Every verb has its row, its procedure and its words, and stands on the page that is made of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.core.operator import TABLE
from arboleda.model.verbs import Verb
from arboleda.views.verb_words import ABOUT

from ..scripts import printed

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/reference/verbs.md"


def test_the_page_is_what_the_script_prints() -> None:
    assert PAGE.read_text(encoding="utf-8") == printed("verb-reference"), "run `make reference`"


def test_every_verb_has_a_procedure_and_words() -> None:
    assert list(TABLE) == list(ABOUT) == list(Verb)


@pytest.mark.parametrize("verb", Verb)
def test_every_verb_has_words_for_each_of_its_arguments(verb: Verb) -> None:
    words = ABOUT[verb]
    assert {each.name for each in verb.arguments} == words.arguments.keys()
    assert (words.by_hand is not None) is verb.row.by_hand
    assert (TABLE[verb].declared is not None) is verb.row.by_hand
