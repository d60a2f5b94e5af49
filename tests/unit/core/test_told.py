"""What the plant says about what strangers asked for: printable, and short."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.core.plant import Plant
from arboleda.model.messages import OperatorAnswer, OperatorRequest, TaskChanged, TaskRequest, Verb
from arboleda.testing import shipped

MODEL = shipped()
ANY = st.text(st.characters(exclude_categories=()), max_size=300)
NEAR = ANY.map(lambda word: f"sis_a {word}")
TASK = ANY.map(lambda word: f"sis_a 0B 7 #{word}")


def plain(text: str) -> bool:
    return text.isprintable() and len(text) <= 2000


@given(text=st.one_of(ANY, NEAR, TASK))
def test_of_a_task(text: str) -> None:
    plant = Plant(MODEL, epoch=1, now=0.0)
    said = [
        each for each in plant.step(0.0, [TaskRequest(at=0.0, text=text)]) if isinstance(each, TaskChanged)
    ]
    assert said and all(plain(each.text) and plain(str(each.sentence)) for each in said)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("verb", Verb)
@given(scope=ANY)
def test_of_an_operators_scope(verb: Verb, scope: str) -> None:
    plant = Plant(MODEL, epoch=1, now=0.0)
    out = plant.step(0.0, [OperatorRequest(at=0.0, verb=verb, scope=scope, by_hand=False)])
    assert all(plain(str(each.refusal or "")) for each in out if isinstance(each, OperatorAnswer))
