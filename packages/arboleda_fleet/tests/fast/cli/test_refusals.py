"""Refusals of commands of several hosts before anything starts."""

from __future__ import annotations

import pytest
from tests.unit.cli.test_refusals import Typed
from tests.unit.cli.test_refusals import typed as typed


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("up", "--no-ros", "--standby"), "--standby needs a memory that both hosts reach"),
        (("handover",), "give it a database"),
    ],
    ids=["standby", "handover"],
)
def test_a_plant_without_a_database_is_refused(typed: Typed, words: tuple[str, ...], sentence: str) -> None:
    status, said = typed(*words)
    assert status == 1 and sentence in said
