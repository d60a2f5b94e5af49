"""How the open files that a process may have are divided among its servers."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.adapters import descriptors
from arboleda.adapters.descriptors import divided
from arboleda.host import limits
from arboleda.model.errors import StartError


@given(limit=st.integers(0, 5000), boards=st.integers(2, 300))
def test_both_servers_at_their_limit_leave_the_plant_what_it_needs(limit: int, boards: int) -> None:
    try:
        shares = divided(limit, boards)
    except StartError as error:
        assert str(limit) in str(error) and "ulimit -n" in str(error)
        return
    strangers = shares.mqtt - (boards + 1)
    used = descriptors.PER_HTTP * shares.http + strangers
    assert used + descriptors.OWN + descriptors.PER_BOARD * (boards + 1) + descriptors.ON_THE_WAY <= limit
    assert shares.http >= descriptors.LEAST_HTTP and strangers >= descriptors.LEAST_MQTT


@pytest.mark.parametrize("limit", [128, 1024])
def test_the_shipped_plant_of_six_boards_starts_under_usual_limits(limit: int) -> None:
    assert divided(limit, 6).http >= descriptors.LEAST_HTTP


def test_no_descriptor_gets_a_number_that_select_cannot_see() -> None:
    assert divided(1_000_000, 6) == divided(descriptors.SELECT_SEES, 6)


def test_a_plant_of_very_many_boards_has_its_least_share_and_still_starts() -> None:
    assert divided(20_000, 600).http == descriptors.LEAST_HTTP


@pytest.mark.parametrize(("soft", "hard", "raised"), [(128, 128, None), (256, 1024, 1024), (1024, -1, 4096)])
def test_a_soft_limit_is_raised_as_far_as_it_serves_anybody(
    monkeypatch: pytest.MonkeyPatch, soft: int, hard: int, raised: int | None
) -> None:
    asked: list[tuple[int, int]] = []
    monkeypatch.setattr(limits.resource, "getrlimit", lambda _what: (soft, hard))
    monkeypatch.setattr(limits.resource, "setrlimit", lambda _what, pair: asked.append(pair))
    descriptors.raise_limit()
    assert asked == ([] if raised is None else [(raised, hard)])
