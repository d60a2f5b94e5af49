"""A plant believes only what it can have written."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from arboleda.adapters.store import Store
from arboleda.app.memory import remembered
from arboleda.core.errors import StartError
from arboleda.core.messages import Fact, Remember


@pytest.fixture
def store() -> Iterator[Store]:
    with Store(Path(":memory:")) as made:
        yield made


def test_what_was_kept_is_remembered(store: Store) -> None:
    kept = {
        Fact.LATCH: {"ra1": "cleared", "ra2": "on"},
        Fact.EFFECTOR: {"ra1": "on"},
        Fact.QUARANTINE: {"mesa": "gone"},
        Fact.STORED: {"sis_a": "0 7"},
    }
    for fact, values in kept.items():
        for name, value in values.items():
            store.keep(Remember(fact=fact, name=name, value=value))
    assert remembered(store) == kept


@pytest.mark.parametrize("fact", [Fact.LATCH, Fact.EFFECTOR])
@pytest.mark.parametrize("value", ["", "Latched", "\x1b[2J"])
def test_a_value_that_means_nothing_is_refused_for_it_may_have_been_a_latch(
    store: Store, fact: Fact, value: str
) -> None:
    store.keep(Remember(fact=fact, name="ra1", value=value))
    with pytest.raises(StartError, match="which means nothing: put a copy") as refused:
        remembered(store)
    assert str(refused.value).isprintable()
