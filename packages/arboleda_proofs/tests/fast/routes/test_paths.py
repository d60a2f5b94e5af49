"""All that this package is asked for over HTTP, and who may."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.client_methods import routes_of_package
from tests.unit.web.test_who_may import assert_for, of_package


def test_the_description_has_every_route() -> None:
    paths = {each.split()[1] for each in routes_of_package("proofs")}
    assert paths == {"/api/faults", "/api/faults/end", "/api/tasks/{task_id}/report"}


def test_each_route_is_asked_by_whom_it_is_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert_for(of_package("arboleda_proofs", tmp_path, monkeypatch))
