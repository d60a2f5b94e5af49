"""Every verb has its row, its procedure and its words, and stands on the page that is made of them."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

from arboleda.core.intake import Intake
from arboleda.core.news import News
from arboleda.core.operator import BY_HAND, Operator
from arboleda.core.plant_state import PlantState
from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.zones import Zones
from arboleda.model.plant_model import PlantModel
from arboleda.model.verbs import Verb
from arboleda.views.verb_words import ABOUT

from ..scripts import printed

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/reference/verbs.md"


def test_the_page_is_what_the_script_prints() -> None:
    assert PAGE.read_text(encoding="utf-8") == printed("verb-reference"), "run `make reference`"


def test_every_verb_is_carried_out_by_something_and_has_words() -> None:
    model = PlantModel(name="empty", cells=())
    state = PlantState(
        clock=SimpleNamespace(now=0.0),
        dispatcher=Dispatcher(model, 1, {}),
        zones=Zones(()),
        intake=Intake(model, 1),
        news=News(()),
    )
    operator = Operator(state, lambda cell, error: None)
    assert list(operator.table) == list(ABOUT) == list(Verb)


@pytest.mark.parametrize("verb", Verb)
def test_every_verb_has_words_for_each_of_its_arguments(verb: Verb) -> None:
    words = ABOUT[verb]
    assert {each.name for each in verb.arguments} == words.arguments.keys()
    assert (words.by_hand is not None) is verb.row.by_hand
    assert (verb in BY_HAND) is verb.row.by_hand
