"""A `load` of one place of one of two cells is booked there, and nowhere else."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import pytest

from arboleda.model.messages import Verb
from arboleda.testing import shipped
from arboleda.trees.part_places import Places
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld

Books = Mapping[str, Places]
Set = Callable[[Books, Places, Mapping[str, int]], None]
SET = Places.set


def forgets(books: Books, places: Places, parts: Mapping[str, int]) -> None:
    """Nothing is booked."""


def mistakes_the_place(books: Books, places: Places, parts: Mapping[str, int]) -> None:
    SET(places, {"station_0": 1})


def mistakes_the_cell(books: Books, places: Places, parts: Mapping[str, int]) -> None:
    SET(books["sis_b"], parts)


def books_in_both(books: Books, places: Places, parts: Mapping[str, int]) -> None:
    for each in books.values():
        SET(each, parts)


def loaded(monkeypatch: pytest.MonkeyPatch, bug: Set | None) -> JudgedWorld:
    """Two cells, and a part that a person has put into a station of one."""
    watched = JudgedWorld(shipped("sis_a", "sis_b"))
    watched.world.advance(2.0)
    books = {name: cell.context.places for name, cell in watched.world.plant.cells.items()}
    if bug is not None:
        monkeypatch.setattr(Places, "set", lambda places, parts: bug(books, places, parts))
    watched.world.request_verb(Verb.LOAD, "sis_a", arguments=(("place", "station_4"),))
    watched.world.advance(1.0)
    return watched


def test_a_load_that_is_booked_as_it_was_said_is_right(monkeypatch: pytest.MonkeyPatch) -> None:
    cells = loaded(monkeypatch, None).world.plant.cells
    assert cells["sis_a"].context.places.full == {"station_4"}
    assert not cells["sis_b"].context.places.full


@pytest.mark.parametrize("bug", [forgets, mistakes_the_place, mistakes_the_cell, books_in_both])
def test_a_load_that_is_booked_elsewhere_is_found(monkeypatch: pytest.MonkeyPatch, bug: Set) -> None:
    with pytest.raises(BrokenInvariant, match="had to have") as found:
        loaded(monkeypatch, bug)
    assert found.value.invariant == "verbs_do_what_they_say"
