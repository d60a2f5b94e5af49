"""Labels of commands on ROS 2 carry ids and tokens; what is broken is refused."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from tests.unit.wire.test_told import ANY, plain

from arboleda.model.errors import PayloadError
from arboleda_ros.labels import from_label, from_token_labels, to_label, to_token_label


def test_a_label_carries_a_command_id() -> None:
    assert to_label("7-1") == "id=7-1"
    assert from_label("id=7-1") == "7-1"


@pytest.mark.parametrize("label", ["", "rows", "ID=7-1"])
def test_a_label_of_somebody_else_is_no_id(label: str) -> None:
    assert from_label(label) == ""


@pytest.mark.parametrize("label", ["id=", "id=7 1", "id=" + "7" * 65])
def test_a_broken_label_is_refused(label: str) -> None:
    with pytest.raises(PayloadError, match="label"):
        from_label(label)


def test_a_token_is_one_of_the_further_labels_of_a_command() -> None:
    assert from_token_labels(["copied", "heard=7", to_token_label("0a3f9x001a01")]) == "0a3f9x001a01"
    assert from_token_labels(["heard=7"]) is None
    with pytest.raises(PayloadError, match="token"):
        from_token_labels(["token=of thirteen"])


@given(word=ANY)
@example(word="a" * 100_000)
def test_what_is_said_of_a_label_is_printable_and_short(word: str) -> None:
    for label in (word, f"id={word}"):
        try:
            assert plain(from_label(label))
        except PayloadError as error:
            assert plain(str(error))
