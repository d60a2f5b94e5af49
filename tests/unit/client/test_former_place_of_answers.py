"""`arboleda.client.answers` has the types of its modules for one minor version, with a warning."""

from __future__ import annotations

import pytest

from arboleda.client import answers
from arboleda.client.answers.plant import Cell


def test_a_type_is_found_with_a_warning_that_says_where_it_is() -> None:
    with pytest.warns(DeprecationWarning, match=r"use `from arboleda\.client\.answers\.plant import Cell`"):
        assert answers.Cell is Cell


def test_another_name_is_not_there() -> None:
    with pytest.raises(AttributeError, match="Nothing"):
        answers.Nothing  # noqa: B018 - asking for it is the test
