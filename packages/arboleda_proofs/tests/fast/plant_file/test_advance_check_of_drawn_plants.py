"""Drawn plants, whose recipes can be done: `check` finds nothing wrong, in both forms."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.lengths import sample

from arboleda.plant_check import advance_check
from arboleda_drawn import devices
from arboleda_drawn.devices import DrawnDevices, Form, can_be_xml
from arboleda_drawn.plants import loaded

REFUSED = (24, 41, 56)  # plants that `arboleda check` refuses, as the simulator passes over them
XML = (1, 4, 11, 15, 23, 26, 27, 28, 29, 30, 34, 35, 37, 41, 43, 44, 47, 50)  # can be trees
OF_TASTE = ("by which way it goes", "at home")  # how sentences end on what a drawn recipe leaves on purpose


def found(drawn: DrawnDevices, form: Form, *, plainly: bool = True) -> tuple[list[str], list[str]]:
    """The sentences, each once, as a tree has more places for one than a recipe in Python; the ends.

    A tree that is written `plainly` has no conditions but those of the recipe.
    """
    plant = loaded(replace(drawn, form=form, spelling=None if plainly else drawn.spelling)).model
    sentences = dict.fromkeys(
        each.split(": ", 1)[1].partition("; write ")[0] for each in advance_check.warnings(plant)
    )
    return list(sentences), list(advance_check.ends(plant))


@pytest.mark.sampled(6)
@pytest.mark.parametrize("seed", sample([each for each in range(1, 61) if each not in REFUSED], 10))
def test_nothing_wrong_is_said_of_a_drawn_plant_and_the_same_in_both_forms(seed: int) -> None:
    drawn = devices.draw(seed)
    forms = list(Form) if all(map(can_be_xml, drawn.recipes)) else [Form.PYTHON]
    of_forms = [found(drawn, form) for form in forms]
    assert all(each == of_forms[0] for each in of_forms)
    meant = [f" {verb}, which needs " for _, verb in drawn.refused]  # to be refused
    meant += [f" has {role} " for role, _ in drawn.refused if role.endswith("_tool")]
    wrong = [each for each in of_forms[0][0] if not any(named in each for named in meant)]
    assert [each for each in wrong if not each.endswith(OF_TASTE)] == []


@pytest.mark.long
@pytest.mark.parametrize("seed", sample([each for each in XML if each not in REFUSED], 6))
def test_nothing_more_is_said_of_a_tree_with_conditions(seed: int) -> None:
    drawn = devices.draw(seed)
    said, plainly = (found(drawn, Form.XML, plainly=each)[0] for each in (False, True))
    assert [each for each in said if each not in plainly and not each.endswith(OF_TASTE)] == []
