"""Answers of drafts are found at their former place."""

from __future__ import annotations

import pytest

from arboleda import client
from arboleda.client import answers


def test_the_draft_is_found_in_its_package() -> None:
    with pytest.warns(DeprecationWarning, match=r"use `from arboleda_make\.client import Draft`") as told:
        assert client.Draft.__module__ == "arboleda_make.client.draft"
    assert told[0].filename == __file__


def test_a_type_is_found_in_its_package() -> None:
    with pytest.warns(
        DeprecationWarning, match=r"use `from arboleda_make\.answers\.drafts import DraftState`"
    ):
        assert answers.DraftState.__name__ == "DraftState"
