from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.cells import with_robot

from arboleda.model.errors import TextError
from arboleda.model.plant_model import Link
from arboleda.model.task import Order
from arboleda.model.text import parse
from arboleda.testing import shipped

SHIPPED = shipped()


@pytest.mark.parametrize(
    "text", ["sis_a 0B 7", "  SIS_A   0b\t7 ", "Sis_A 0B 7\n"], ids=["plain", "spaces and case", "newline"]
)
def test_case_and_spaces_do_not_matter(text: str) -> None:
    order = parse(text, SHIPPED)
    assert order.text == "sis_a 0B 7"
    assert order.values == {"path": "0B", "station": "station_7"}


def test_an_id_after_the_hash_keeps_its_case() -> None:
    assert parse("sis_a 0B 7 #Lot_42.b-1", SHIPPED).id == "Lot_42.b-1"


@pytest.mark.parametrize("name", ["sis_b", "ra2", "RA2"])
def test_palletizing_is_asked_for_by_cell_or_arm(name: str) -> None:
    order = parse(f"{name} palletizing", SHIPPED)
    assert (order.cell, order.recipe) == ("sis_b", "palletizing")


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("", ["empty", "sis_a 0A 8"]),
        ("sis_d 0B 7", ["'sis_d'", "sis_a, sis_b, sis_c"]),
        ("siz_b 0B 7", ["did you mean sis_b?"]),
        ("sis_a 0D 7", ["'0D'", "0A, 0B, 0C"]),
        ("sis_a 0B 9", ["'9'", "0, 1, 2"]),
        ("sis_a 0B ٧", ["station"]),
        ("sis_a 0B 07", ["'07'"]),
        ("sis_a", ["the task has 1 word; "]),
        ("sis_a 0B", ["2 words"]),
        ("sis_a 0B 7 8", ["4 words"]),
        ("sis_a paletizing", ["'paletizing'", "palletizing"]),
        ("sis_a 0B 7 #", ["task id", "letters"]),
        ("sis_a 0B 7 #t-1", ["made by the plant"]),
        ("ra1 0B 7", ["'ra1'", "cell"]),
        ("x" * 201, ["201 characters"]),
        ("sis_a \x1b[31m 7", ["\\x1b[31m"]),
    ],
)
def test_a_wrong_text_is_refused_naming_word_and_choice(text: str, names: list[str]) -> None:
    with pytest.raises(TextError) as refusal:
        parse(text, SHIPPED)
    for name in names:
        assert name in str(refusal.value)


DRAWN = with_robot(SHIPPED.cell("sis_a"), "mobile", link=Link.NONE)


def test_a_task_that_needs_a_robot_which_is_only_drawn_is_refused() -> None:
    with pytest.raises(TextError, match=r"^rm_sis_a is only drawn \(link: none\), so sis_a cannot do this"):
        parse("sis_a 0B 7", replace(SHIPPED, cells=(DRAWN,)))


def test_palletizing_needs_no_mobile_robot_that_is_more_than_drawn() -> None:
    assert parse("sis_a palletizing", replace(SHIPPED, cells=(DRAWN,))).recipe == "palletizing"
    with pytest.raises(TextError, match=r"^ra1 is only drawn"):
        parse("sis_a palletizing", shipped(link=Link.NONE))


WORDS = st.one_of(
    st.text(max_size=12), st.sampled_from(["sis_a", "RA1", "0B", "2c", "7", "palletizing", "#x"])
)


@given(st.one_of(st.text(max_size=250), st.lists(WORDS, max_size=5).map(" ".join)))
def test_any_text_is_an_order_or_a_text_error(text: str) -> None:
    try:
        order = parse(text, SHIPPED)
    except TextError as refusal:
        assert str(refusal) and "\n" not in str(refusal)
    else:
        assert isinstance(order, Order)
        assert parse(order.text, SHIPPED).text == order.text
